#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/core/eigen_alignment.h"

namespace early_fusion::world {

/// One move of a joint: 2 degrees (Walsman et al. 2019, sec. IV-A).
inline constexpr double kStepRad = 2.0 * 3.14159265358979323846 / 180.0;

/// A camera orientation on the lattice of 2-degree steps: joint angle = step count * kStepRad.
struct Orientation {
  int pan = 0;   ///< positive to the left
  int tilt = 0;  ///< positive downwards
};

inline bool operator==(Orientation a, Orientation b) { return a.pan == b.pan && a.tilt == b.tilt; }
inline bool operator!=(Orientation a, Orientation b) { return !(a == b); }

/// The orientation after an action, without regard to joint limits. COLLECT, REMOVE and IDLE do not change it.
Orientation turned(Orientation from, core::Action action);

/// All orientations of whole steps within the joint limits.
struct OrientationLattice {
  Orientation lowest;
  Orientation highest;

  int panCount() const { return highest.pan - lowest.pan + 1; }
  int tiltCount() const { return highest.tilt - lowest.tilt + 1; }
  int size() const { return panCount() * tiltCount(); }
  bool contains(Orientation o) const;
  /// Row-major in tilt, in [0, size()).
  int index(Orientation o) const { return (o.tilt - lowest.tilt) * panCount() + (o.pan - lowest.pan); }
  Orientation at(int index) const;
};

/// A pan-tilt camera read from a URDF: any chain with a pan joint, then a tilt joint, then the optical frame.
class CameraRig {
 public:
  /// @param pan_joint, tilt_joint, optical_frame names in the URDF. The URDF's root link is the world frame.
  /// @throws Error naming the file and the joint or link that is missing, is not revolute or has no limits.
  static CameraRig load(const std::string& urdf_file, const std::string& pan_joint, const std::string& tilt_joint,
                        const std::string& optical_frame);

  /// The URDF's root link: the frame of every pose [m] in the simulation.
  const std::string& worldFrame() const { return world_frame_; }
  const std::string& panJoint() const { return pan_joint_; }
  const std::string& tiltJoint() const { return tilt_joint_; }
  const std::string& opticalFrame() const { return optical_frame_; }
  const OrientationLattice& lattice() const { return lattice_; }

  /// Pose of the optical frame (REP-103: z forward, x right, y down) in the world [m].
  /// @param orientation within the lattice.
  const Eigen::Isometry3d& worldFromCamera(Orientation orientation) const;

 private:
  std::string world_frame_;
  std::string pan_joint_;
  std::string tilt_joint_;
  std::string optical_frame_;
  OrientationLattice lattice_;
  std::vector<Eigen::Isometry3d> world_from_camera_;  // by lattice index
};

}  // namespace early_fusion::world
