#include "early_fusion/ros/robot/joint_stepper.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace early_fusion::nodes {

namespace {

constexpr double kTurnRad = 2 * M_PI;
/// An encoder that counts on may be this many turns away from the limits. A larger value is no angle in radians.
constexpr double kMaxTurns = 2.5;
/// A step may exceed a limit by this much, because a URDF's decimals are rounded.
constexpr double kLimitToleranceRad = 1e-3 * world::kStepRad;

template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[512];
  std::snprintf(buffer, sizeof(buffer), format, values...);
  return buffer;
}

}  // namespace

void JointStepper::assume(double angle_rad) {
  feedback_ = false;
  position_ = angle_rad;
}

bool JointStepper::observe(double angle_rad, const std::string& publisher, double at_sec) {
  if (!std::isfinite(angle_rad)) return false;
  const auto known = states_.find(publisher);
  if (known == states_.end()) {  // nodes that are restarted may have new names
    for (auto state = states_.begin(); state != states_.end();) {
      state = at_sec - state->second.at_sec > timeout_sec_ ? states_.erase(state) : std::next(state);
    }
  } else if (at_sec < known->second.at_sec) {
    return true;
  }
  states_[publisher] = {angle_rad, at_sec};
  return true;
}

/// How far an angle is outside the limits.
double JointStepper::outside(double angle_rad) const {
  if (joint_.continuous) return 0;
  return std::max({joint_.lower_rad - angle_rad, angle_rad - joint_.upper_rad, 0.0});
}

/// An angle outside the limits, plus whole turns: on this side of the limits, and one turn further.
std::pair<double, double> JointStepper::candidates(double angle_rad) const {
  const bool low = angle_rad < joint_.lower_rad;
  const double turns = std::ceil(outside(angle_rad) / kTurnRad) * (low ? 1 : -1);
  const double further_rad = angle_rad + turns * kTurnRad;
  return {further_rad - (low ? kTurnRad : -kTurnRad), further_rad};
}

/// The angle plus the whole turns that bring it into the limits or close to them. An angle within the limits stays.
double JointStepper::unwrapped(double angle_rad) const {
  if (outside(angle_rad) == 0) return angle_rad;
  const auto [here, further] = candidates(angle_rad);
  return outside(further) < outside(here) ? further : here;
}

JointStepper::States::const_iterator JointStepper::newest() const {
  return std::max_element(states_.begin(), states_.end(),
                          [](const auto& a, const auto& b) { return a.second.at_sec < b.second.at_sec; });
}

bool JointStepper::followsCommand(double angle_rad) const {
  return position_ && std::abs(std::remainder(angle_rad - *position_, kTurnRad)) <= kToleranceRad;
}

std::string JointStepper::obstacle(double now_sec) const {
  if (!feedback_) return "";
  if (states_.empty()) return "there are no joint states of '" + joint_.name + "' yet";
  const double age_sec = now_sec - newest()->second.at_sec;
  if (age_sec > timeout_sec_) {
    return text("the newest joint state of '%s' is %.1f s old; see ~joint_state_timeout", joint_.name.c_str(), age_sec);
  }
  const std::string disagreement = this->disagreement(now_sec);
  return disagreement.empty() ? misplacement() : disagreement;
}

/// Names two nodes that say different things, such as a driver and a joint_state_publisher beside it.
std::string JointStepper::disagreement(double now_sec) const {
  const auto& [newest_publisher, newest_state] = *newest();
  for (const auto& [publisher, state] : states_) {
    if (now_sec - state.at_sec > timeout_sec_) continue;
    if (std::abs(std::remainder(state.angle_rad - newest_state.angle_rad, kTurnRad)) <= kToleranceRad) continue;
    return text("%s and %s publish different joint states of '%s', %.3f and %.3f rad; stop one of them",
                publisher.c_str(), newest_publisher.c_str(), joint_.name.c_str(), state.angle_rad,
                newest_state.angle_rad);
  }
  return "";
}

/// Says why the joint cannot be where its joint state says.
std::string JointStepper::misplacement() const {
  const double angle_rad = newest()->second.angle_rad;
  if (outside(angle_rad) == 0 || followsCommand(angle_rad)) return "";
  const char* name = joint_.name.c_str();
  if (std::abs(angle_rad - unwrapped(angle_rad)) > kMaxTurns * kTurnRad) {
    return text("the joint state of '%s' is %g, too far from its limits [%.3f, %.3f] rad; joint states must be in rad",
                name, angle_rad, joint_.lower_rad, joint_.upper_rad);
  }
  // The encoder's noise must not decide on which side of the limits the joint is.
  const auto [here, further] = candidates(angle_rad);
  if (std::abs(outside(here) - outside(further)) < 2 * kToleranceRad) {
    return text(
        "'%s' stands at %.3f rad, which is as far from one of its limits [%.3f, %.3f] rad as from the other; "
        "check that URDF and driver agree on the angle 0",
        name, angle_rad, joint_.lower_rad, joint_.upper_rad);
  }
  return "";
}

std::string JointStepper::begin() {
  if (!feedback_) return "";
  const double angle_rad = newest()->second.angle_rad;
  if (followsCommand(angle_rad)) {
    // A continuous joint's encoder may begin anew after a turn. Commands follow it.
    if (joint_.continuous) position_ = angle_rad + std::remainder(*position_ - angle_rad, kTurnRad);
    return "";
  }
  const std::optional<double> command = position_;
  position_ = unwrapped(angle_rad);
  if (!command) return "";
  return text(
      "'%s' stands at %.3f rad and not at its last command, %.3f rad: it was moved by hand, or does not follow "
      "its commands; going on from where it stands",
      joint_.name.c_str(), *position_, *command);
}

bool JointStepper::step(int direction) {
  const double target_rad = *position_ + direction * joint_.sign * world::kStepRad;
  if (outside(target_rad) > kLimitToleranceRad && outside(target_rad) >= outside(*position_)) return false;
  position_ = target_rad;
  return true;
}

}  // namespace early_fusion::nodes
