#include "early_fusion/ros/correction/take_over.h"

#include <algorithm>

#include "early_fusion/core/action.h"
#include "early_fusion/core/error.h"
#include "early_fusion/ros/correction/presses.h"

namespace early_fusion::nodes {

namespace {

constexpr double kPressKeptSec = 1;  // a press that came before its step

bool picks(const std::string& action) {
  return action == core::actionName(core::Action::kCollect) || action == core::actionName(core::Action::kRemove);
}

/// The answer to the policy's image if a person pressed. A pick is for the item that the policy names, or for the only
/// one that is requested.
Action answerOf(const Action& policy, const std::string& person, const std::vector<std::string>& items) {
  Action action = policy;
  if (person.empty()) return action;
  action.name = person;
  const bool one_item = !items.empty() && std::count(items.begin(), items.end(), items.front()) ==
                                              static_cast<std::ptrdiff_t>(items.size());
  if (!picks(person)) action.item.clear();
  if (picks(person) && action.item.empty() && one_item) action.item = items.front();
  if (action.item.empty()) action.item_probability = 0;
  return action;
}

}  // namespace

core::OptionSet TakeOver::Options::options() {
  core::OptionSet set("take over");
  set.add("patience", patience_sec, 0, 3600, "s",
          "how long a step waits for a press before the policy's action is done");
  set.add("hold", hold_sec, 0, 3600, "s",
          "after a press, the next steps wait for another one until this long after it");
  set.add("episode_timeout", episode_timeout_sec, 0.1, 86400, "s",
          "an episode has ended if no step of it has come for this long");
  set.add("wait_for_weights", wait_for_weights,
          "an episode begins only with other weights than those of the episode before; false: if nobody trains");
  return set;
}

bool TakeOver::begins(const Action& policy) const {
  if (!known_ || policy.episode != episode_) return true;
  const bool again = policy.header.stamp == answered_.header.stamp;
  return policy.step == 0 && (recording_ || done_) && !again;
}

TakeOver::Output TakeOver::endEpisode() {
  Output output;
  open_.reset();
  if (recording_) {
    output.end.emplace();
    output.end->ends = true;
    output.end->episode = episode_;
    output.end->header = answered_.header;
    holds_ = options_.wait_for_weights;
  }
  recording_ = false;
  return output;
}

TakeOver::Output TakeOver::onStep(const Action& policy, const Request& request, const sensor_msgs::Image& frame,
                                  const std::string& held, double now_sec) {
  Output output;
  if (known_ && policy.header.stamp == answered_.header.stamp && policy.episode == answered_.episode &&
      policy.step == answered_.step) {
    output.action = answered_;  // the answer was lost
    return output;
  }
  if (begins(policy)) {
    output = endEpisode();
    known_ = true;
    done_ = false;
    episode_ = policy.episode;
    next_press_.clear();
    hold_until_sec_ = 0;
  }
  if (holds_ && policy.weights == weights_) return output;
  holds_ = false;
  last_event_sec_ = now_sec;
  weights_ = policy.weights;
  if (done_) {
    output.action = answered_ = answerOf(policy, core::actionName(core::Action::kIdle), request.items);
    return output;
  }
  const bool again = open_ && open_->policy.header.stamp == policy.header.stamp;
  if (!again) {
    Correction record;
    record.header = policy.header;
    record.episode = policy.episode;
    record.step = policy.step;
    record.items = request.items;
    record.policy = policy.name;
    record.frame = frame;
    open_ = Open{policy, record, std::max(now_sec + options_.patience_sec, hold_until_sec_)};
  }
  output.proposal = open_->policy;  // other weights may have answered again; the person has seen the first proposal
  const std::string early = now_sec - next_press_sec_ <= kPressKeptSec ? next_press_ : "";
  next_press_.clear();
  const std::string press = early.empty() ? held : early;
  if (press.empty()) return output;
  const Output answered = onPress(press, ::ros::Time(), now_sec);
  output.record = answered.record;
  output.action = answered.action;
  if (answered.end) output.end = answered.end;
  return output;
}

TakeOver::Output TakeOver::onPress(const std::string& name, const ::ros::Time& stamp, double now_sec) {
  checkPress(name);
  if (!stamp.isZero() && (!open_ || open_->policy.header.stamp != stamp)) {
    throw core::Error(name + " is for the image of " + std::to_string(stamp.toSec()) + ", but the open step is " +
                      (open_ ? "that of " + std::to_string(open_->policy.header.stamp.toSec()) : "none") +
                      "; give the stamp of 'proposal', or zero for the open step");
  }
  last_event_sec_ = now_sec;
  if (name == kEpisodeDone) {
    const std::optional<Open> unanswered = open_;
    Output output = endEpisode();
    done_ = true;
    hold_until_sec_ = 0;
    if (unanswered) {
      output.action = answered_ = answerOf(unanswered->policy, core::actionName(core::Action::kIdle), {});
    }
    return output;
  }
  const bool acts = name != kGoOn && name != kConfirm;
  hold_until_sec_ = acts ? now_sec + options_.hold_sec : 0;
  if (open_) return answer(name);
  if (acts) {
    next_press_ = name;
    next_press_sec_ = now_sec;
  }
  return {};
}

/// @param press empty: none.
TakeOver::Output TakeOver::answer(const std::string& press) {
  Output output;
  const std::string person = press == kGoOn || press == kConfirm ? "" : press;
  open_->record.person = person;
  open_->record.confirmed = press == kConfirm;
  output.record = open_->record;
  output.action = answered_ = answerOf(open_->policy, person, open_->record.items);
  open_.reset();
  recording_ = true;
  return output;
}

TakeOver::Output TakeOver::onTime(double now_sec) {
  if (open_ && now_sec >= open_->deadline_sec) {
    last_event_sec_ = now_sec;
    return answer("");
  }
  if (!open_ && recording_ && now_sec - last_event_sec_ > options_.episode_timeout_sec) return endEpisode();
  return {};
}

std::string TakeOver::waitsFor() const {
  if (open_) return "a press for step " + std::to_string(open_->policy.step);
  if (holds_) return "weights other than '" + weights_ + "'";
  return "the policy";
}

}  // namespace early_fusion::nodes
