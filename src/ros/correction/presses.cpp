#include "early_fusion/ros/correction/presses.h"

#include <array>
#include <cmath>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"

namespace early_fusion::nodes {

namespace {

using core::Action;

struct Key {
  std::string bytes, shown, press, meaning;
};

const std::vector<Key>& keys() {
  static const std::vector<Key> table = {
      {"\x1b[D", "left", core::actionName(Action::kPanLeft), "turn the camera to the left"},
      {"\x1b[C", "right", core::actionName(Action::kPanRight), "turn the camera to the right"},
      {"\x1b[A", "up", core::actionName(Action::kTiltUp), "turn the camera upwards"},
      {"\x1b[B", "down", core::actionName(Action::kTiltDown), "turn the camera downwards"},
      {"c", "c", core::actionName(Action::kCollect), "collect the object in the middle"},
      {"r", "r", core::actionName(Action::kRemove), "remove the object in the middle"},
      {"i", "i", core::actionName(Action::kIdle), "do nothing"},
      {" ", "space", kGoOn, "let the policy act"},
      {"y", "y", kConfirm, "let the policy act, and learn that it is right"},
      {"e", "e", kEpisodeDone, "end the episode"}};
  return table;
}

/// Arrow keys as terminals in application mode send them, "\x1bOD", count as "\x1b[D".
std::string inNormalMode(std::string key) {
  if (key.size() == 3 && key[1] == 'O') key[1] = '[';
  return key;
}

template <class Values>
double valueAt(const Values& values, int index, const char* parameter, const char* what) {
  if (index < 0) return 0;
  if (static_cast<std::size_t>(index) < values.size()) return values[index];
  throw core::Error("the joystick has " + std::to_string(values.size()) + " " + what + ", but ~" + parameter + " is " +
                    std::to_string(index) + "; set ~" + parameter + " to one of them, or to -1 for none");
}

}  // namespace

void checkPress(const std::string& name) {
  if (name == kGoOn || name == kConfirm || name == kEpisodeDone) return;
  try {
    core::actionFromName(name);
  } catch (const core::Error& error) {
    throw core::Error(std::string(error.what()) + ", or the presses " + kGoOn + ", " + kConfirm + " and " +
                      kEpisodeDone);
  }
}

std::optional<std::string> KeyReader::add(char byte) {
  if (byte == '\x1b') key_.clear();
  key_ += byte;
  const std::string key = inNormalMode(key_);
  bool begun = key_ == "\x1bO";
  for (const Key& known : keys()) {
    if (known.bytes == key) {
      key_.clear();
      return known.press;
    }
    begun |= known.bytes.compare(0, key.size(), key) == 0;
  }
  if (!begun) key_.clear();
  return std::nullopt;
}

std::string keyMapText() {
  std::string text;
  for (const Key& key : keys()) text += "  " + key.shown + std::string(8 - key.shown.size(), ' ') + key.meaning + "\n";
  return text;
}

core::OptionSet JoyReader::Options::options() {
  core::OptionSet set("joystick");
  const auto add = [&set](const char* name, int& field, const std::string& help) {
    set.add(name, field, -1, 100, "", help + "; -1: none");
  };
  add("pan_axis", pan_axis, "index of the joystick's axis that turns the camera; positive: to the left");
  add("tilt_axis", tilt_axis, "index of the axis that tilts the camera; positive: upwards");
  set.add("axis_threshold", axis_threshold, 0.01, 1, "", "an axis counts as held from this value on");
  add("collect_button", collect_button, "index of the button for COLLECT");
  add("remove_button", remove_button, "index of the button for REMOVE");
  add("idle_button", idle_button, "index of the button for IDLE");
  add("go_on_button", go_on_button, "index of the button that lets the policy act at once");
  add("confirm_button", confirm_button, "index of the button that says that the policy is right");
  add("done_button", done_button, "index of the button that ends the episode");
  return set;
}

std::optional<std::string> JoyReader::add(const sensor_msgs::Joy& joy) {
  const double pan = valueAt(joy.axes, options_.pan_axis, "pan_axis", "axes");
  const double tilt = valueAt(joy.axes, options_.tilt_axis, "tilt_axis", "axes");
  const std::array<std::tuple<int, const char*, std::string>, 6> known = {
      {{options_.collect_button, "collect_button", core::actionName(Action::kCollect)},
       {options_.remove_button, "remove_button", core::actionName(Action::kRemove)},
       {options_.idle_button, "idle_button", core::actionName(Action::kIdle)},
       {options_.go_on_button, "go_on_button", kGoOn},
       {options_.confirm_button, "confirm_button", kConfirm},
       {options_.done_button, "done_button", kEpisodeDone}}};
  std::optional<std::string> pressed;
  for (const auto& [index, parameter, press] : known) {
    const bool down = valueAt(joy.buttons, index, parameter, "buttons") != 0;
    const bool was_down = down && static_cast<std::size_t>(index) < buttons_.size() && buttons_[index] != 0;
    if (down && !was_down && !pressed) pressed = press;
  }
  buttons_ = joy.buttons;
  held_.reset();
  if (std::max(std::abs(pan), std::abs(tilt)) < options_.axis_threshold) return pressed;
  if (std::abs(pan) >= std::abs(tilt)) {
    held_ = pan > 0 ? Action::kPanLeft : Action::kPanRight;
  } else {
    held_ = tilt > 0 ? Action::kTiltUp : Action::kTiltDown;
  }
  return pressed;
}

}  // namespace early_fusion::nodes
