#include "early_fusion/core/options.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <functional>

#include "early_fusion/core/error.h"

namespace early_fusion::core {
namespace {

struct Settings {
  int count = 4;
  int width = 32;
  double rate = 1e-4;
  std::uint64_t seed = 1;
  bool fast = false;
  std::string name = "none";
  std::string mode = "slow";

  OptionSet options() {
    OptionSet set("test");
    set.add("count", count, 1, 8, "objects", "how many");
    set.addMultiple("width", width, 16, 16, 64, "px", "how wide");
    set.add("rate", rate, 0, 1, "", "how fast");
    set.add("seed", seed, "where from");
    set.add("fast", fast, "whether");
    set.add("name", name, "which");
    set.addChoice("mode", mode, {"slow", "quick"}, "how");
    return set;
  }
};

std::string errorOf(const std::string& yaml) {
  Settings settings;
  try {
    settings.options().setFromYaml(YAML::Load(yaml), "file.yaml");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Options, YamlSetsEveryKind) {
  Settings settings;
  settings.options().setFromYaml(
      YAML::Load(
          "{count: 8, width: 48, rate: 2.5e-3, seed: 18446744073709551615, fast: true, name: 'a b', mode: quick}"),
      "f");
  EXPECT_EQ(settings.count, 8);
  EXPECT_EQ(settings.width, 48);
  EXPECT_EQ(settings.rate, 2.5e-3);
  EXPECT_EQ(settings.seed, UINT64_MAX);
  EXPECT_TRUE(settings.fast);
  EXPECT_EQ(settings.name, "a b");
  EXPECT_EQ(settings.mode, "quick");
}

TEST(Options, ErrorsNameFileLineKeyValueAndRange) {
  EXPECT_EQ(errorOf("rate: 1\ncount: 9"), "file.yaml:2: count: '9' is out of range; allowed: [1, 8] objects");
  EXPECT_EQ(errorOf("count: 2.5"), "file.yaml:1: count: '2.5' is not a whole number; allowed: [1, 8] objects");
  EXPECT_EQ(errorOf("width: 40"),
            "file.yaml:1: width: '40' is not a multiple of 16; allowed: a multiple of 16 in [16, 64] px");
  EXPECT_EQ(errorOf("width: 80"), "file.yaml:1: width: '80' is out of range; allowed: a multiple of 16 in [16, 64] px");
  EXPECT_EQ(errorOf("rate: nan"), "file.yaml:1: rate: 'nan' is out of range; allowed: [0, 1]");
  EXPECT_EQ(errorOf("fast: 1"), "file.yaml:1: fast: '1' is neither true nor false; allowed: true | false");
  EXPECT_EQ(errorOf("mode: x"), "file.yaml:1: mode: 'x' is not one of the choices; allowed: slow | quick");
  EXPECT_EQ(errorOf("seed: -1"),
            "file.yaml:1: seed: '-1' is not a whole number from 0 to 2^64 - 1; allowed: [0, 2^64 - 1]");
}

TEST(Options, UnknownAndRepeatedKeysAndNestedValuesAreErrors) {
  EXPECT_EQ(errorOf("cuont: 1"),
            "file.yaml:1: unknown test option 'cuont'; known are count, width, rate, seed, fast, name, mode");
  EXPECT_EQ(errorOf("count: 1\ncount: 2"), "file.yaml:2: count is given twice");
  EXPECT_EQ(errorOf("count: [1]"), "file.yaml:1: count: expected a single value");
  EXPECT_EQ(errorOf("[1]"), "file.yaml:1: expected a map of test options, 'name: value'");
}

TEST(Options, ABadValueChangesNothing) {
  Settings settings;
  EXPECT_THROW(settings.options().set("count", "0", "--count"), Error);
  EXPECT_EQ(settings.count, 4);
}

std::string errorOfStruct(const std::function<void(Settings&)>& change) {
  Settings settings;
  change(settings);
  try {
    settings.options().validate("program");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Options, AStructThatAProgramFilledIsHeldToTheSameRanges) {
  EXPECT_EQ(errorOfStruct([](Settings&) {}), "");
  EXPECT_EQ(errorOfStruct([](Settings& s) { s.rate = 0.1 + 0.2; }), "");
  EXPECT_EQ(errorOfStruct([](Settings& s) { s.count = 9; }),
            "program: count: '9' is out of range; allowed: [1, 8] objects");
  EXPECT_EQ(errorOfStruct([](Settings& s) { s.width = 8; }),
            "program: width: '8' is out of range; allowed: a multiple of 16 in [16, 64] px");
  EXPECT_EQ(errorOfStruct([](Settings& s) { s.rate = std::nan(""); }),
            "program: rate: 'nan' is out of range; allowed: [0, 1]");
  EXPECT_EQ(errorOfStruct([](Settings& s) { s.mode = "x"; }),
            "program: mode: 'x' is not one of the choices; allowed: slow | quick");
}

TEST(Options, WrittenYamlReadsBackTheSame) {
  Settings written;
  written.rate = 0.1 + 0.2;
  written.name = "yes: no # it's";
  Settings read;
  read.options().setFromYaml(YAML::Load(written.options().toYaml()), "f");
  EXPECT_EQ(read.rate, written.rate);
  EXPECT_EQ(read.name, written.name);
  EXPECT_EQ(read.options().toYaml(), written.options().toYaml());
}

TEST(OptionSet, ASeedIsAWholeNumberThatFits) {
  std::uint64_t seed = 5;
  OptionSet set("test");
  set.add("seed", seed, "a seed");
  for (const char* text : {"-1", "", " 1", "1.5", "123456789012345678901234567890", "18446744073709551616", "0x10"}) {
    EXPECT_THROW(set.set("seed", text, "test"), Error) << text;
  }
  EXPECT_EQ(seed, 5u);
  set.set("seed", "18446744073709551615", "test");
  EXPECT_EQ(seed, UINT64_MAX);
}

}  // namespace
}  // namespace early_fusion::core
