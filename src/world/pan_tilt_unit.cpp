#include "early_fusion/world/pan_tilt_unit.h"

#include <algorithm>
#include <cmath>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "pan_tilt_chain.h"
#include "urdf_file.h"

namespace early_fusion::world {

namespace {

/// A joint whose axis is closer to the line of sight, as a sine, turns the image rather than the view.
constexpr double kMinTurn = 0.5;
constexpr double kAlong = 0.866;  // the cosine for this sine
/// A larger limit is no angle of a unit in radians.
constexpr double kMaxLimitRad = 4 * M_PI;

UnitJoint readJoint(const urdf::Joint& joint, const std::string& file) {
  const std::string where = file + ": joint '" + core::excerpt(joint.name) + "'";
  UnitJoint result;
  result.name = joint.name;
  result.continuous = joint.type == urdf::Joint::CONTINUOUS;
  if (result.continuous) return result;
  if (joint.type != urdf::Joint::REVOLUTE) throw core::Error(where + " must be revolute or continuous");
  if (!joint.limits) throw core::Error(where + " has no limits; give it some, or make it continuous");
  result.lower_rad = joint.limits->lower;
  result.upper_rad = joint.limits->upper;
  refuseSwappedLimits(result.lower_rad, result.upper_rad, where);
  const auto safety = joint.safety;
  if (safety && safety->soft_lower_limit < safety->soft_upper_limit) {
    result.lower_rad = std::max(result.lower_rad, safety->soft_lower_limit);
    result.upper_rad = std::min(result.upper_rad, safety->soft_upper_limit);
  }
  const double range_rad = result.upper_rad - result.lower_rad;
  if (!(range_rad > 0) || !std::isfinite(range_rad)) {
    throw core::Error(where + " cannot turn within its limits " + limitsText(result.lower_rad, result.upper_rad));
  }
  if (std::max(-result.lower_rad, result.upper_rad) > kMaxLimitRad) {
    throw core::Error(where + " has the limits " + limitsText(result.lower_rad, result.upper_rad) +
                      ", more than two turns; if they are degrees, convert them to rad (150 degrees are 2.618 rad); if "
                      "the joint has no limits, make it continuous");
  }
  return result;
}

double middle(const UnitJoint& joint) { return joint.continuous ? 0 : (joint.lower_rad + joint.upper_rad) / 2; }

/// The sign of how a joint turns the view. @throws Error if it turns it hardly or not at all in this direction.
/// @param along the cosine of the angle between the joint's axis and the line of sight.
int signOf(double turn, double along, const UnitJoint& joint, const char* directions, const std::string& file) {
  if (std::abs(turn) > kMinTurn) return turn > 0 ? 1 : -1;
  if (std::abs(along) > kAlong) {
    const int angle_deg = static_cast<int>(std::lround(std::acos(std::min(1.0, std::abs(along))) * 180 / M_PI));
    throw core::Error(file + ": the axis of joint '" + core::excerpt(joint.name) + "' lies along the line of sight (" +
                      std::to_string(angle_deg) +
                      " degrees from it), so the joint turns the image and not the camera " + directions +
                      "; check the joint's axis and the optical frame (z forward, x right, y down)");
  }
  throw core::Error(file + ": joint '" + core::excerpt(joint.name) + "' does not turn the camera " + directions +
                    " in its image; check the joint's axis, whether pan and tilt are swapped, and the optical frame "
                    "(z forward, x right, y down)");
}

}  // namespace

PanTiltUnit PanTiltUnit::parse(const std::string& xml, const std::string& source, const std::string& pan_joint,
                               const std::string& tilt_joint, const std::string& optical_frame) {
  const urdf::ModelInterfaceSharedPtr model = parseUrdf(xml, source);
  const PanTiltChain chain = readPanTiltChain(*model, pan_joint, tilt_joint, optical_frame, source);
  PanTiltUnit unit{readJoint(*chain.pan, source), readJoint(*chain.tilt, source)};
  const double tilt_rad = middle(unit.tilt);
  unit.pan.sign = signOf(chain.turnsLeft(tilt_rad), chain.panAlongView(tilt_rad), unit.pan, "left or right", source);
  unit.tilt.sign = signOf(chain.turnsDown(), chain.tiltAlongView(), unit.tilt, "up or down", source);
  return unit;
}

}  // namespace early_fusion::world
