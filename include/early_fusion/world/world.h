#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/core/options.h"
#include "early_fusion/world/camera_rig.h"
#include "early_fusion/world/object_set.h"
#include "early_fusion/world/placed_hull.h"

namespace early_fusion::world {

/// The contents of a world file: the object set, the URDFs, the placement and the camera's image. The defaults are
/// those of config/world.yaml.
struct WorldOptions {
  std::string objects = "objects.yaml";
  std::string kitchen_urdf = "../urdf/kitchen.urdf";
  std::string camera_urdf = "../urdf/pan_tilt_camera.urdf";
  std::string pan_joint = "pan_joint";
  std::string tilt_joint = "tilt_joint";
  std::string optical_frame = "camera_optical_frame";
  std::string counter_link = "counter";  ///< objects stand on its collision box
  double placement_width = 1.1;          ///< [m] along y; the objects' centres lie in this area, centred on the counter
  double placement_depth = 0.58;         ///< [m] along x; as placement_width
  double clearance = 0.005;              ///< [m] between two objects, and between an object and the kitchen
  double max_overhang = 0.03;            ///< [m] by which an object may overhang an edge of the counter's top
  int image_size = 128;                  ///< [px]
  double horizontal_fov_deg = 60.0;
  int max_triangles = 2000;

  core::OptionSet options();
};

/// A mesh that never moves, in the world frame.
struct FixedMesh {
  std::string link;
  TexturedMesh mesh;
  Eigen::Isometry3d world_from_mesh;
};

/// In the world frame [m].
struct HorizontalRectangle {
  double min_x, max_x, min_y, max_y, z;

  /// The length by which a box reaches beyond an edge [m]; negative if it does not.
  double overhang(const Eigen::AlignedBox3d& box) const;
};

/// Everything that is the same in all episodes. Immutable and shared between threads.
struct World {
  WorldOptions options;
  ObjectSet objects;
  CameraRig rig;
  std::vector<FixedMesh> kitchen;
  /// The kitchen's collision shapes that rise above the counter's top.
  std::vector<std::shared_ptr<const PlacedHull>> obstacles;
  HorizontalRectangle counter_top;
  HorizontalRectangle placement;  ///< the area for the objects' centres, on the counter's top
};

/// @param world_file a WorldOptions file; empty: the package's config/world.yaml. Paths in it are relative to it.
/// @throws Error naming file, key and value.
std::shared_ptr<const World> loadWorld(const std::string& world_file);

/// Paths of URDF files.
struct WorldUrdfs {
  std::string camera;
  std::string kitchen;
};

/// The paths of the URDFs that a world file names. The URDFs are not read. @param world_file as in loadWorld().
/// @throws Error as loadWorld() for the world file itself.
WorldUrdfs findUrdfs(const std::string& world_file);

}  // namespace early_fusion::world
