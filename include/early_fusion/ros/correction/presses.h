#pragma once

#include <sensor_msgs/Joy.h>

#include <optional>
#include <string>
#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/core/options.h"

namespace early_fusion::nodes {

// Names of presses that are no actions.
inline constexpr char kGoOn[] = "GO_ON";                ///< the policy acts: do not wait for a press
inline constexpr char kConfirm[] = "CONFIRM";           ///< the same, and the policy is right: its action is a label
inline constexpr char kEpisodeDone[] = "EPISODE_DONE";  ///< the episode ends

/// @throws core::Error listing the known ones unless `name` is an action or one of these.
void checkPress(const std::string& name);

/// Turns the keys of a terminal into presses, byte by byte: arrow keys come as three bytes.
class KeyReader {
 public:
  /// @return the name of a press that ends with this byte; none in the middle of a key, or for an unknown key.
  std::optional<std::string> add(char byte);

 private:
  std::string key_;  // the bytes of an unfinished key
};

/// The keys, one a line, for a person to read.
std::string keyMapText();

/// Turns the states of a joystick (sensor_msgs/Joy) into presses.
class JoyReader {
 public:
  /// Indices into Joy.axes and Joy.buttons; -1: not used.
  struct Options {
    int pan_axis = 0;   ///< positive: left
    int tilt_axis = 1;  ///< positive: up
    double axis_threshold = 0.5;
    int collect_button = 0;
    int remove_button = 1;
    int idle_button = 2;
    int go_on_button = 3;
    int confirm_button = -1;
    int done_button = 7;

    core::OptionSet options();
  };

  explicit JoyReader(const Options& options) : options_(options) {}

  /// The press of the first button that is down and was not in the message before. A message without one is no press.
  /// @throws core::Error naming the parameter whose axis or button the joystick does not have.
  std::optional<std::string> add(const sensor_msgs::Joy& joy);

  /// The move towards which the stick is held; none: it rests. If both axes are, the one that is further.
  std::optional<core::Action> held() const { return held_; }

 private:
  Options options_;
  std::vector<std::int32_t> buttons_;  // of the message before
  std::optional<core::Action> held_;
};

}  // namespace early_fusion::nodes
