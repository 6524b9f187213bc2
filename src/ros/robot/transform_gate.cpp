#include "early_fusion/ros/robot/transform_gate.h"

#include <sstream>

#include "early_fusion/core/excerpt.h"

namespace early_fusion::nodes {

namespace {

constexpr double kGoesOnSec = 1;  // a publisher that was heard later than this ago goes on

}  // namespace

TransformGate::Verdict TransformGate::judge(const std::string& child_frame, const std::string& publisher,
                                            double stamp_sec, double now_sec) {
  rivals_.clear();
  const auto known = newest_.find(child_frame);
  if (known == newest_.end()) {
    newest_[child_frame] = {stamp_sec, now_sec, publisher};
    return Verdict::kTake;
  }
  Newest& newest = known->second;
  const double back_sec = newest.stamp_sec - stamp_sec;
  if (back_sec == 0) return Verdict::kLeaveOut;
  if (back_sec > 0 && back_sec <= cache_sec_) return Verdict::kTake;
  if (back_sec < 0) {
    newest = {stamp_sec, now_sec, publisher};
    return Verdict::kTake;
  }
  if (now_sec - newest.came_at_sec >= kGoesOnSec) {
    forget();
    newest_[child_frame] = {stamp_sec, now_sec, publisher};
    return Verdict::kBeginAnew;
  }
  if (publisher != newest.publisher) {
    std::ostringstream text;
    text << newest.publisher << " and " << publisher << " publish the transform of '" << core::excerpt(child_frame)
         << "' with stamps " << back_sec << " s apart; stop one of them; those of " << publisher << " are left out";
    rivals_ = text.str();
  }
  return Verdict::kLeaveOut;
}

}  // namespace early_fusion::nodes
