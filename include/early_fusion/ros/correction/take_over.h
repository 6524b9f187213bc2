#pragma once

#include <early_fusion/Action.h>
#include <early_fusion/Correction.h>
#include <early_fusion/Request.h>
#include <sensor_msgs/Image.h>

#include <optional>
#include <string>

#include "early_fusion/core/options.h"

namespace early_fusion::nodes {

/// Decides at each step who acts: the policy, or a person who pressed. Keeps the record of the session. Without ROS's
/// clock: times are seconds of a clock that does not jump.
///
/// A step is open from the policy's answer until a person pressed or the time for it is over.
class TakeOver {
 public:
  struct Options {
    double patience_sec = 0.5;
    double hold_sec = 2;
    double episode_timeout_sec = 10;
    bool wait_for_weights = true;

    core::OptionSet options();
  };

  /// What has to be published, in this order.
  struct Output {
    std::optional<Correction> end;     ///< of the episode before
    std::optional<Action> proposal;    ///< the policy's action of a step that has been opened, or of the open one again
    std::optional<Correction> record;  ///< of the step that is answered
    std::optional<Action> action;      ///< what is done
  };

  explicit TakeOver(const Options& options) : options_(options) {}

  /// The policy has answered an image. @param held what the person holds down (a joystick's move); empty: nothing.
  Output onStep(const Action& policy, const Request& request, const sensor_msgs::Image& frame, const std::string& held,
                double now_sec);

  /// A person has pressed: an action, GO_ON, CONFIRM or EPISODE_DONE. @param stamp of the image that is meant; zero: of
  /// the open step, or of the next one if it opens soon.
  /// @throws core::Error naming the stamp if another step is open, or an unknown name and the known ones.
  Output onPress(const std::string& name, const ::ros::Time& stamp, double now_sec);

  /// To be called often: time passes.
  Output onTime(double now_sec);

  /// What it waits for, for diagnostics: "a press for step 3", "new weights", "the policy".
  std::string waitsFor() const;

 private:
  struct Open {
    Action policy;
    Correction record;
    double deadline_sec;
  };

  bool begins(const Action& policy) const;
  Output endEpisode();
  Output answer(const std::string& press);

  Options options_;
  std::optional<Open> open_;
  bool recording_ = false;     // whether steps of the current episode have been recorded, and no end
  bool known_ = false;         // whether there was an episode
  bool done_ = false;          // the person has ended it: IDLE until the next one begins
  bool holds_ = false;         // an episode waits for new weights
  std::uint64_t episode_ = 0;  // the current or the last one
  std::string weights_;        // that answered it last
  Action answered_;            // the last answer
  std::string next_press_;     // that came before its step
  double next_press_sec_ = 0;  // when
  double hold_until_sec_ = 0;  // until then the person is at work
  double last_event_sec_ = 0;
};

}  // namespace early_fusion::nodes
