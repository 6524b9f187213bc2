#include "early_fusion/ros/correction/presses.h"

#include <gtest/gtest.h>

#include "early_fusion/core/error.h"

namespace early_fusion::nodes {
namespace {

using core::Action;

std::vector<std::string> pressesOf(const std::string& bytes) {
  KeyReader reader;
  std::vector<std::string> presses;
  for (const char byte : bytes) {
    if (const auto press = reader.add(byte)) presses.push_back(*press);
  }
  return presses;
}

TEST(KeyReader, ReadsEveryKeyOfTheMap) {
  EXPECT_EQ(pressesOf("\x1b[D\x1b[C\x1b[A\x1b[Bcri ye"),
            std::vector<std::string>({"PAN_LEFT", "PAN_RIGHT", "TILT_UP", "TILT_DOWN", "COLLECT", "REMOVE", "IDLE",
                                      "GO_ON", "CONFIRM", "EPISODE_DONE"}));
}

TEST(KeyReader, ReadsTheArrowKeysOfATerminalInApplicationMode) {
  EXPECT_EQ(pressesOf("\x1bOD\x1bOA"), std::vector<std::string>({"PAN_LEFT", "TILT_UP"}));
}

TEST(KeyReader, LeavesOutUnknownAndUnfinishedKeys) {
  EXPECT_EQ(pressesOf("xwz\x1b[5~\x1b[\x1b[C["), std::vector<std::string>({"PAN_RIGHT"}));
  EXPECT_EQ(pressesOf("\x1b"
                      "c"),
            std::vector<std::string>())
      << "Alt-c is no c";
  EXPECT_EQ(pressesOf("q\x1b"
                      "qc"),
            std::vector<std::string>({"COLLECT"}));
}

TEST(KeyMap, NamesAllKeys) {
  const std::string text = keyMapText();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10);
  for (const char* key : {"left ", "right ", "up ", "down ", "c ", "r ", "i ", "space ", "y ", "e "}) {
    EXPECT_NE(text.find(std::string("  ") + key), std::string::npos) << key;
  }
}

sensor_msgs::Joy joy(std::vector<float> axes, std::vector<std::int32_t> buttons) {
  sensor_msgs::Joy message;
  message.axes = std::move(axes);
  message.buttons = std::move(buttons);
  return message;
}

TEST(JoyReader, AButtonIsPressedOnceHoweverLongItIsHeld) {
  JoyReader reader({});
  EXPECT_EQ(reader.add(joy({0, 0}, {1, 0, 0, 0, 0, 0, 0, 0})), "COLLECT");
  EXPECT_FALSE(reader.add(joy({0, 0}, {1, 0, 0, 0, 0, 0, 0, 0})));
  EXPECT_EQ(reader.add(joy({0, 0}, {1, 1, 0, 0, 0, 0, 0, 0})), "REMOVE");
  EXPECT_FALSE(reader.add(joy({0, 0}, {0, 0, 0, 0, 0, 0, 0, 0})));
  EXPECT_EQ(reader.add(joy({0, 0}, {1, 0, 0, 0, 0, 0, 0, 0})), "COLLECT");
  EXPECT_EQ(reader.add(joy({0, 0}, {0, 0, 1, 0, 0, 0, 0, 0})), "IDLE");
  EXPECT_EQ(reader.add(joy({0, 0}, {0, 0, 0, 1, 0, 0, 0, 0})), "GO_ON");
  EXPECT_EQ(reader.add(joy({0, 0}, {0, 0, 0, 0, 0, 0, 0, 1})), "EPISODE_DONE");
}

TEST(JoyReader, AStickIsHeldTowardsAMove) {
  JoyReader reader({});
  const std::vector<std::int32_t> up(8, 0);
  const std::pair<std::vector<float>, std::optional<Action>> cases[] = {
      {{0.4f, -0.4f}, std::nullopt},   {{0.9f, 0}, Action::kPanLeft},   {{-0.9f, 0.2f}, Action::kPanRight},
      {{0.1f, 0.8f}, Action::kTiltUp}, {{0.6f, -1}, Action::kTiltDown}, {{0, 0}, std::nullopt}};
  for (const auto& [axes, held] : cases) {
    reader.add(joy(axes, up));
    EXPECT_EQ(reader.held(), held) << axes[0] << " " << axes[1];
  }
}

TEST(JoyReader, WhatTheJoystickDoesNotHaveIsNamedWithItsParameter) {
  const auto error = [](const JoyReader::Options& options, const sensor_msgs::Joy& message) -> std::string {
    try {
      JoyReader(options).add(message);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(error({}, joy({0}, std::vector<std::int32_t>(8))),
            "the joystick has 1 axes, but ~tilt_axis is 1; set ~tilt_axis to one of them, or to -1 for none");
  EXPECT_EQ(error({}, joy({0, 0}, std::vector<std::int32_t>(4))),
            "the joystick has 4 buttons, but ~done_button is 7; set ~done_button to one of them, or to -1 for none");
  JoyReader::Options without;
  without.done_button = -1;
  EXPECT_EQ(error(without, joy({0, 0}, std::vector<std::int32_t>(4))), "");
}

TEST(CheckPress, AnUnknownNameIsAnErrorThatListsTheKnown) {
  EXPECT_NO_THROW(checkPress("TILT_UP"));
  EXPECT_NO_THROW(checkPress(kGoOn));
  try {
    checkPress("JUMP");
    FAIL();
  } catch (const core::Error& error) {
    for (const char* word : {"JUMP", "PAN_LEFT", "GO_ON", "EPISODE_DONE"}) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace early_fusion::nodes
