#pragma once

#include <string>

namespace early_fusion::world {

/// One joint of a real pan-tilt unit, as its URDF describes it.
struct UnitJoint {
  std::string name;
  int sign = 1;  ///< 1: positive angles turn the camera left (pan) or down (tilt) in its image; -1: right or up
  bool continuous = false;  ///< it has no limits
  double lower_rad = 0;     ///< the narrower ones of the joint's limits and its safety controller's
  double upper_rad = 0;
};

/// A real pan-tilt unit: any chain with a pan joint, then a tilt joint, then the optical frame. Only joints between
/// these three must be fixed. Unlike CameraRig, the joints may turn in any direction and need no whole steps.
struct PanTiltUnit {
  UnitJoint pan;
  UnitJoint tilt;

  /// @param xml the URDF's text. @param source names it in errors.
  /// @param pan_joint, tilt_joint, optical_frame names in the URDF (optical: z forward, x right, y down).
  /// @throws Error naming the source and the joint or link that is missing, does not turn or has no usable limits.
  static PanTiltUnit parse(const std::string& xml, const std::string& source, const std::string& pan_joint,
                           const std::string& tilt_joint, const std::string& optical_frame);
};

}  // namespace early_fusion::world
