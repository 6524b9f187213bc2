#include "early_fusion/world/camera_rig.h"

#include <cassert>
#include <cmath>

#include "early_fusion/core/error.h"
#include "pan_tilt_chain.h"
#include "urdf_file.h"

namespace early_fusion::world {

namespace {

/// A step may exceed a limit by this share of a step, because a URDF's decimals are rounded.
constexpr double kLimitTolerance = 1e-3;

/// The whole steps within a joint's limits. @throws Error if the joint is not revolute.
void readSteps(const urdf::Joint& joint, const std::string& file, int* lowest, int* highest) {
  const std::string where = file + ": joint '" + joint.name + "'";
  if (joint.type == urdf::Joint::CONTINUOUS) {
    throw core::Error(where + " is continuous; make it revolute, with limits");
  }
  if (joint.type != urdf::Joint::REVOLUTE) throw core::Error(where + " must be revolute");
  if (!joint.limits) throw core::Error(where + " has no limits");
  const double lower = joint.limits->lower;
  const double upper = joint.limits->upper;
  refuseSwappedLimits(lower, upper, where);
  const std::string limits = limitsText(lower, upper);
  if (!(std::abs(lower) <= 2 * M_PI && std::abs(upper) <= 2 * M_PI)) {
    throw core::Error(where + " has limits " + limits + "; they must lie within [-6.28318, 6.28318]");
  }
  *lowest = static_cast<int>(std::ceil(lower / kStepRad - kLimitTolerance));
  *highest = static_cast<int>(std::floor(upper / kStepRad + kLimitTolerance));
  if (*lowest > *highest) {
    throw core::Error(where + " has no multiple of 2 degrees (0.0349066 rad) within its limits " + limits);
  }
}

/// Checks that positive angles turn the view in the documented direction. Otherwise PAN_LEFT would turn right.
/// @param turn of PanTiltChain.
void checkDirection(double turn, const std::string& joint, const char* direction, const std::string& file) {
  if (turn > 1e-6) return;
  throw core::Error(
      file + ": positive angles of joint '" + joint + "' must turn the camera " + direction +
      " in its image, but they do not; check the joint's axis and the optical frame (z forward, x right, y "
      "down)");
}

Eigen::AngleAxisd turn(int steps, const Eigen::Vector3d& axis) { return Eigen::AngleAxisd(steps * kStepRad, axis); }

}  // namespace

Orientation turned(Orientation from, core::Action action) {
  switch (action) {
    case core::Action::kPanLeft:
      return {from.pan + 1, from.tilt};
    case core::Action::kPanRight:
      return {from.pan - 1, from.tilt};
    case core::Action::kTiltUp:
      return {from.pan, from.tilt - 1};
    case core::Action::kTiltDown:
      return {from.pan, from.tilt + 1};
    default:
      return from;
  }
}

bool OrientationLattice::contains(Orientation o) const {
  return o.pan >= lowest.pan && o.pan <= highest.pan && o.tilt >= lowest.tilt && o.tilt <= highest.tilt;
}

Orientation OrientationLattice::at(int index) const {
  return {lowest.pan + index % panCount(), lowest.tilt + index / panCount()};
}

CameraRig CameraRig::load(const std::string& urdf_file, const std::string& pan_joint, const std::string& tilt_joint,
                          const std::string& optical_frame) {
  const urdf::ModelInterfaceSharedPtr model = loadUrdf(urdf_file);
  const PanTiltChain chain = readPanTiltChain(*model, pan_joint, tilt_joint, optical_frame, urdf_file);

  CameraRig rig;
  rig.world_frame_ = model->getRoot()->name;
  rig.pan_joint_ = pan_joint;
  rig.tilt_joint_ = tilt_joint;
  rig.optical_frame_ = optical_frame;
  OrientationLattice& lattice = rig.lattice_;
  readSteps(*chain.pan, urdf_file, &lattice.lowest.pan, &lattice.highest.pan);
  readSteps(*chain.tilt, urdf_file, &lattice.lowest.tilt, &lattice.highest.tilt);
  const Eigen::Isometry3d world_from_pan =
      fixedChain(*model, model->getRoot()->name, chain.pan->parent_link_name, "the root link", urdf_file) *
      toEigen(chain.pan->parent_to_joint_origin_transform);
  const int middle_tilt = (lattice.lowest.tilt + lattice.highest.tilt) / 2;
  checkDirection(chain.turnsLeft(middle_tilt * kStepRad), pan_joint, "left", urdf_file);
  checkDirection(chain.turnsDown(), tilt_joint, "down", urdf_file);
  for (int i = 0; i < lattice.size(); ++i) {
    const Orientation orientation = lattice.at(i);
    rig.world_from_camera_.push_back(world_from_pan * turn(orientation.pan, chain.pan_axis) * chain.pan_from_tilt *
                                     turn(orientation.tilt, chain.tilt_axis) * chain.tilt_from_camera);
  }
  return rig;
}

const Eigen::Isometry3d& CameraRig::worldFromCamera(Orientation orientation) const {
  assert(lattice_.contains(orientation));
  return world_from_camera_[lattice_.index(orientation)];
}

}  // namespace early_fusion::world
