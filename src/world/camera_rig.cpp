#include "early_fusion/world/camera_rig.h"

#include <cassert>
#include <cmath>
#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/core/names.h"
#include "urdf_file.h"

namespace early_fusion::world {

namespace {

/// A step may exceed a limit by this share of a step, because a URDF's decimals are rounded.
constexpr double kLimitTolerance = 1e-3;

std::string text(double value) {
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

urdf::JointConstSharedPtr findJoint(const urdf::ModelInterface& model, const std::string& name,
                                    const std::string& file) {
  const auto found = model.joints_.find(name);
  if (found != model.joints_.end()) return found->second;
  const std::string known = core::joined(core::keys(model.joints_));
  throw core::Error(file + ": no joint '" + name + "'; its joints are: " + (known.empty() ? "none" : known));
}

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
  const std::string limits = "[" + text(lower) + ", " + text(upper) + "] rad";
  if (!(std::abs(lower) <= 2 * M_PI && std::abs(upper) <= 2 * M_PI)) {
    throw core::Error(where + " has limits " + limits + "; they must lie within [-6.28318, 6.28318]");
  }
  *lowest = static_cast<int>(std::ceil(lower / kStepRad - kLimitTolerance));
  *highest = static_cast<int>(std::floor(upper / kStepRad + kLimitTolerance));
  if (*lowest > *highest) {
    throw core::Error(where + " has no multiple of 2 degrees (0.0349066 rad) within its limits " + limits);
  }
}

/// Pose of `link` in `ancestor`, over fixed joints only. @param ends_at the name of `ancestor` in error texts.
Eigen::Isometry3d fixedChain(const urdf::ModelInterface& model, const std::string& ancestor, const std::string& link,
                             const std::string& ends_at, const std::string& file) {
  Eigen::Isometry3d ancestor_from_link = Eigen::Isometry3d::Identity();
  urdf::LinkConstSharedPtr current = model.getLink(link);
  while (current->name != ancestor) {
    const urdf::JointConstSharedPtr joint = current->parent_joint;
    if (!joint) throw core::Error(file + ": link '" + link + "' is not connected to " + ends_at);
    if (joint->type != urdf::Joint::FIXED) {
      throw core::Error(file + ": joint '" + joint->name + "', between " + ends_at + " and link '" + link +
                        "', must be fixed");
    }
    ancestor_from_link = toEigen(joint->parent_to_joint_origin_transform) * ancestor_from_link;
    current = model.getLink(joint->parent_link_name);
  }
  return ancestor_from_link;
}

/// Checks that positive angles turn the view in the documented direction. Otherwise PAN_LEFT would turn right. The
/// joint turns about `axis`, given in the same frame as the optical frame's axes.
void checkDirection(const Eigen::Vector3d& axis, const Eigen::Vector3d& forward, const Eigen::Vector3d& expected,
                    const std::string& joint, const char* direction, const std::string& file) {
  if (axis.cross(forward).dot(expected) > 1e-6) return;
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
  const urdf::JointConstSharedPtr pan = findJoint(*model, pan_joint, urdf_file);
  const urdf::JointConstSharedPtr tilt = findJoint(*model, tilt_joint, urdf_file);
  if (!model->getLink(optical_frame)) throw core::Error(urdf_file + ": no link '" + optical_frame + "'");

  CameraRig rig;
  rig.world_frame_ = model->getRoot()->name;
  rig.pan_joint_ = pan_joint;
  rig.tilt_joint_ = tilt_joint;
  rig.optical_frame_ = optical_frame;
  OrientationLattice& lattice = rig.lattice_;
  readSteps(*pan, urdf_file, &lattice.lowest.pan, &lattice.highest.pan);
  readSteps(*tilt, urdf_file, &lattice.lowest.tilt, &lattice.highest.tilt);
  const Eigen::Isometry3d world_from_pan =
      fixedChain(*model, model->getRoot()->name, pan->parent_link_name, "the root link", urdf_file) *
      toEigen(pan->parent_to_joint_origin_transform);
  const Eigen::Isometry3d pan_from_tilt =
      fixedChain(*model, pan->child_link_name, tilt->parent_link_name, "joint '" + pan_joint + "'", urdf_file) *
      toEigen(tilt->parent_to_joint_origin_transform);
  const Eigen::Isometry3d tilt_from_camera =
      fixedChain(*model, tilt->child_link_name, optical_frame, "joint '" + tilt_joint + "'", urdf_file);
  const Eigen::Vector3d pan_axis = toEigen(pan->axis).normalized();
  const Eigen::Vector3d tilt_axis = toEigen(tilt->axis).normalized();

  const int middle_tilt = (lattice.lowest.tilt + lattice.highest.tilt) / 2;
  const Eigen::Matrix3d tilt_camera = tilt_from_camera.linear();
  const Eigen::Matrix3d pan_camera = pan_from_tilt.linear() * turn(middle_tilt, tilt_axis) * tilt_camera;
  checkDirection(pan_axis, pan_camera.col(2), -pan_camera.col(0), pan_joint, "left", urdf_file);
  checkDirection(tilt_axis, tilt_camera.col(2), tilt_camera.col(1), tilt_joint, "down", urdf_file);
  for (int i = 0; i < lattice.size(); ++i) {
    const Orientation orientation = lattice.at(i);
    rig.world_from_camera_.push_back(world_from_pan * turn(orientation.pan, pan_axis) * pan_from_tilt *
                                     turn(orientation.tilt, tilt_axis) * tilt_from_camera);
  }
  return rig;
}

const Eigen::Isometry3d& CameraRig::worldFromCamera(Orientation orientation) const {
  assert(lattice_.contains(orientation));
  return world_from_camera_[lattice_.index(orientation)];
}

}  // namespace early_fusion::world
