#pragma once

#include <urdf_model/model.h>

#include <Eigen/Geometry>
#include <string>

namespace early_fusion::world {

/// The part of a URDF from the pan joint over the tilt joint to the optical frame.
struct PanTiltChain {
  urdf::JointConstSharedPtr pan;
  urdf::JointConstSharedPtr tilt;
  Eigen::Vector3d pan_axis;            ///< in the pan joint's frame
  Eigen::Vector3d tilt_axis;           ///< in the tilt joint's frame
  Eigen::Isometry3d pan_from_tilt;     ///< from the tilt joint's frame at angle 0 to the pan joint's frame
  Eigen::Isometry3d tilt_from_camera;  ///< from the optical frame to the tilt joint's frame

  /// The sine of the angle between view and axis, positive where positive angles turn the view left in the image.
  double turnsLeft(double tilt_rad) const;
  /// The same for the tilt joint: positive where positive angles turn the view down in the image.
  double turnsDown() const;
  /// The cosine of the angle between view and pan axis.
  double panAlongView(double tilt_rad) const;
  /// The same for the tilt axis.
  double tiltAlongView() const;
};

/// @param file names the URDF in errors. @throws Error naming what is missing, or a joint in between that moves.
PanTiltChain readPanTiltChain(const urdf::ModelInterface& model, const std::string& pan_joint,
                              const std::string& tilt_joint, const std::string& optical_frame, const std::string& file);

/// Pose of `link` in `ancestor`, over fixed joints only. @param ends_at the name of `ancestor` in error texts.
/// @throws Error naming a joint in between that moves.
Eigen::Isometry3d fixedChain(const urdf::ModelInterface& model, const std::string& ancestor, const std::string& link,
                             const std::string& ends_at, const std::string& file);

/// @throws Error if the lower limit exceeds the upper one. @param where names the joint.
void refuseSwappedLimits(double lower_rad, double upper_rad, const std::string& where);

/// "[-0.9, 0.9] rad", for error texts.
std::string limitsText(double lower_rad, double upper_rad);

}  // namespace early_fusion::world
