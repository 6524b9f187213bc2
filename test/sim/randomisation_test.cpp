#include "early_fusion/sim/randomisation.h"

#include <gtest/gtest.h>

#include "model/error_of.h"

namespace early_fusion::sim {
namespace {

TEST(Randomisation, NoneChangesNothing) {
  EXPECT_TRUE(Randomisation().isNone());
  EXPECT_TRUE(loadRandomisation("none").isNone());
  EXPECT_EQ(randomisationText(Randomisation()), "");
  EXPECT_TRUE(parseRandomisation("").isNone());
  Randomisation only_looks;  // nothing departs from the world's files, however many looks there are
  only_looks.looks = 4;
  only_looks.texture_set = "held_out";
  EXPECT_TRUE(only_looks.isNone());
}

TEST(Randomisation, EveryShippedFileIsKnownAndAllButNoneChangeSomething) {
  for (const char* name : {"real_camera", "kitchen_1", "kitchen_2", "kitchen_3", "sensor"}) {
    EXPECT_FALSE(loadRandomisation(name).isNone()) << name;
  }
}

TEST(Randomisation, ItsTextIsReadAsTheSameOne) {
  Randomisation noisy;
  noisy.noise = 7.5;
  noisy.distractors = 3;
  noisy.texture_set = "held_out";
  noisy.looks = 2;
  noisy.look_seed = 18446744073709551615u;
  Randomisation read = parseRandomisation(randomisationText(noisy));
  EXPECT_EQ(read.options().toYamlLine(), noisy.options().toYamlLine());
  EXPECT_EQ(read.look_seed, 18446744073709551615u);
}

TEST(Randomisation, EachOptionButThoseOfTheChoiceChangesSomething) {
  Randomisation none;
  const core::OptionSet set = none.options();
  for (const core::Option& option : set.options()) {
    if (option.name == "texture_set" || option.name == "looks" || option.name == "look_seed") continue;
    Randomisation one;
    one.options().set(option.name, option.name == "distractors" ? "1" : "0.1", "test");
    EXPECT_FALSE(one.isNone()) << option.name;
  }
}

TEST(Randomisation, NamesWhatIsWrong) {
  const auto expectError = [](const std::string& text, const std::string& part) {
    model::expectError([&] { parseRandomisation(text); }, part);
  };
  expectError("{noise: -1}", "noise: '-1' is out of range");
  expectError("{nois: 1}", "nois");
  expectError("{texture_set: all}", "texture_set");
  model::expectError([] { loadRandomisation("kitchen"); }, "kitchen_1");
}

}  // namespace
}  // namespace early_fusion::sim
