#include "pan_tilt_chain.h"

#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/names.h"
#include "urdf_file.h"

namespace early_fusion::world {

namespace {

urdf::JointConstSharedPtr findJoint(const urdf::ModelInterface& model, const std::string& name,
                                    const std::string& file) {
  const auto found = model.joints_.find(name);
  if (found != model.joints_.end()) return found->second;
  const std::string known = core::listed(core::keys(model.joints_));
  throw core::Error(file + ": no joint '" + name + "'; its joints are: " + (known.empty() ? "none" : known));
}

bool hangsFrom(const urdf::ModelInterface& model, const urdf::Joint& joint, const std::string& ancestor) {
  for (auto parent = model.getLink(joint.parent_link_name)->parent_joint; parent;
       parent = model.getLink(parent->parent_link_name)->parent_joint) {
    if (parent->name == ancestor) return true;
  }
  return false;
}

/// The camera's axes as columns, in the pan joint's frame.
Eigen::Matrix3d panFromCamera(const PanTiltChain& chain, double tilt_rad) {
  return chain.pan_from_tilt.linear() * Eigen::AngleAxisd(tilt_rad, chain.tilt_axis) * chain.tilt_from_camera.linear();
}

}  // namespace

double PanTiltChain::turnsLeft(double tilt_rad) const {
  const Eigen::Matrix3d camera = panFromCamera(*this, tilt_rad);
  return pan_axis.cross(camera.col(2)).dot(-camera.col(0));
}

double PanTiltChain::panAlongView(double tilt_rad) const { return pan_axis.dot(panFromCamera(*this, tilt_rad).col(2)); }

double PanTiltChain::tiltAlongView() const { return tilt_axis.dot(tilt_from_camera.linear().col(2)); }

double PanTiltChain::turnsDown() const {
  const Eigen::Matrix3d camera = tilt_from_camera.linear();
  return tilt_axis.cross(camera.col(2)).dot(camera.col(1));
}

PanTiltChain readPanTiltChain(const urdf::ModelInterface& model, const std::string& pan_joint,
                              const std::string& tilt_joint, const std::string& optical_frame,
                              const std::string& file) {
  PanTiltChain chain;
  chain.pan = findJoint(model, pan_joint, file);
  chain.tilt = findJoint(model, tilt_joint, file);
  if (!model.getLink(optical_frame)) throw core::Error(file + ": no link '" + optical_frame + "'");
  if (hangsFrom(model, *chain.pan, tilt_joint)) {
    throw core::Error(file + ": the pan joint '" + pan_joint + "' hangs from the tilt joint '" + tilt_joint +
                      "'; exchange them");
  }
  chain.pan_from_tilt =
      fixedChain(model, chain.pan->child_link_name, chain.tilt->parent_link_name, "joint '" + pan_joint + "'", file) *
      toEigen(chain.tilt->parent_to_joint_origin_transform);
  chain.tilt_from_camera =
      fixedChain(model, chain.tilt->child_link_name, optical_frame, "joint '" + tilt_joint + "'", file);
  chain.pan_axis = toEigen(chain.pan->axis).normalized();
  chain.tilt_axis = toEigen(chain.tilt->axis).normalized();
  return chain;
}

Eigen::Isometry3d fixedChain(const urdf::ModelInterface& model, const std::string& ancestor, const std::string& link,
                             const std::string& ends_at, const std::string& file) {
  Eigen::Isometry3d ancestor_from_link = Eigen::Isometry3d::Identity();
  urdf::LinkConstSharedPtr current = model.getLink(link);
  while (current->name != ancestor) {
    const urdf::JointConstSharedPtr joint = current->parent_joint;
    if (!joint) throw core::Error(file + ": link '" + link + "' is not connected to " + ends_at);
    if (joint->type != urdf::Joint::FIXED) {
      throw core::Error(file + ": joint '" + core::excerpt(joint->name) + "', between " + ends_at + " and link '" +
                        link + "', must be fixed");
    }
    ancestor_from_link = toEigen(joint->parent_to_joint_origin_transform) * ancestor_from_link;
    current = model.getLink(joint->parent_link_name);
  }
  return ancestor_from_link;
}

void refuseSwappedLimits(double lower_rad, double upper_rad, const std::string& where) {
  if (lower_rad > upper_rad) {
    throw core::Error(where + " has swapped limits " + limitsText(lower_rad, upper_rad) + "; exchange lower and upper");
  }
}

std::string limitsText(double lower_rad, double upper_rad) {
  std::ostringstream stream;
  stream << "[" << lower_rad << ", " << upper_rad << "] rad";
  return stream.str();
}

}  // namespace early_fusion::world
