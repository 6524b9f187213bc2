#include "early_fusion/learning/session_options.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"

namespace early_fusion::learning {
namespace {

namespace fs = std::filesystem;

TEST(SessionOptions, EveryShippedPresetLoads) {
  for (const auto& entry : fs::directory_iterator(fs::path(core::shareFolder()) / "config" / "presets")) {
    EXPECT_NO_THROW(resolveSessionOptions({{"preset", entry.path().stem().string()}}, "test")) << entry.path();
  }
  EXPECT_THROW(resolveSessionOptions({{"preset", "slow"}}, "test"), core::Error);
}

TEST(SessionOptions, EveryOneIsAnArgumentOfTrainLaunch) {
  SessionOptions options;
  const core::OptionSet set = options.options();
  const std::string launch = core::readFile(fs::path(core::shareFolder()) / "launch" / "train.launch");
  for (const core::Option& option : set.options()) {
    if (option.name == "kind") continue;  // there is but one
    EXPECT_NE(launch.find("<arg name=\"" + option.name + "\""), std::string::npos) << option.name;
    const std::string name = "name=\"" + option.name + "\" ", value = "value=\"$(arg " + option.name + ")\"";
    EXPECT_TRUE(launch.find(name + value) != std::string::npos ||
                launch.find(name + "type=\"str\" " + value) != std::string::npos)
        << option.name;
  }
}

TEST(SessionOptions, WhatIsGivenWinsOverThePreset) {
  const SessionOptions options = resolveSessionOptions({{"learning_rate", "0.25"}, {"preset", "paper"}}, "test");
  EXPECT_DOUBLE_EQ(options.training.learning_rate, 0.25);
  EXPECT_EQ(options.training.window, 150);
  EXPECT_DOUBLE_EQ(options.policy.dropout, 0.5);
}

TEST(SessionOptions, PresetOptionsTakeThePresetAloneOfWhatIsGiven) {
  const core::GivenOptions given{{"learning_rate", "0.25"}, {"preset", "paper"}, {"no_option_of_a_session", "1"}};
  const SessionOptions options = presetOptions(given);
  EXPECT_EQ(options.preset, "paper");
  EXPECT_EQ(options.training.window, 150);
  EXPECT_DOUBLE_EQ(options.training.learning_rate, 1e-4);
  EXPECT_THROW(resolveSessionOptions(given, "test"), core::Error);
}

}  // namespace
}  // namespace early_fusion::learning
