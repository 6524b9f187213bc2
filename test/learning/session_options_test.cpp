#include "early_fusion/learning/session_options.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"

namespace early_fusion::learning {
namespace {

namespace fs = std::filesystem;

TEST(SessionOptions, EveryShippedPresetSaysEveryOptionOfTraining) {
  TrainingOptions training;
  const core::OptionSet set = training.options();
  for (const auto& entry : fs::directory_iterator(fs::path(core::shareFolder()) / "config" / "presets")) {
    EXPECT_NO_THROW(resolveSessionOptions({{"preset", entry.path().stem().string()}}, "test")) << entry.path();
    const YAML::Node preset = core::loadYamlFile(entry.path());
    for (const core::Option& option : set.options()) EXPECT_TRUE(preset[option.name]) << entry.path() << option.name;
  }
  EXPECT_THROW(resolveSessionOptions({{"preset", "slow"}}, "test"), core::Error);
}

TEST(SessionOptions, TheDefaultsAreThoseOfThePaper) {
  SessionOptions paper = resolveSessionOptions({{"preset", "paper"}}, "test"), defaults;
  defaults.preset = paper.preset;
  EXPECT_EQ(paper.options().toYaml(), defaults.options().toYaml());
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
