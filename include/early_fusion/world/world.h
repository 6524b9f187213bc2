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

/// A world file: which files make the world, and how the camera sees it. The defaults are those of config/world.yaml.
struct WorldOptions {
  std::string objects = "objects.yaml";
  std::string kitchen_urdf = "../urdf/kitchen.urdf";
  std::string camera_urdf = "../urdf/pan_tilt_camera.urdf";
  std::string pan_joint = "pan_joint";
  std::string tilt_joint = "tilt_joint";
  std::string optical_frame = "camera_optical_frame";
  std::string counter_link = "counter";  ///< objects stand on its collision box
  double placement_width = 1.1;          ///< [m] along y: the extent of the objects' centres, centred on the counter
  double placement_depth = 0.58;         ///< [m] along x, likewise
  double clearance = 0.005;              ///< [m] between two objects, and between an object and the kitchen
  double max_overhang = 0.03;            ///< [m] of an object over an edge of the counter's top
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
};

/// Everything that is the same in all episodes. Immutable and shared between threads.
struct World {
  WorldOptions options;
  ObjectSet objects;
  CameraRig rig;
  std::vector<FixedMesh> kitchen;
  /// Of the kitchen's collision shapes, those that rise above the counter's top.
  std::vector<std::shared_ptr<const PlacedHull>> obstacles;
  HorizontalRectangle counter_top;
  HorizontalRectangle placement;  ///< on the counter's top: where the centres of objects may lie
};

/// @param world_file a WorldOptions file; empty: the package's config/world.yaml. Paths in it are relative to it.
/// @throws Error naming file, key and value.
std::shared_ptr<const World> loadWorld(const std::string& world_file);

/// Paths of URDF files.
struct WorldUrdfs {
  std::string camera;
  std::string kitchen;
};

/// What a world file names as its URDFs, without loading them. @param world_file as loadWorld() takes it.
/// @throws Error as loadWorld() does for the world file itself.
WorldUrdfs findUrdfs(const std::string& world_file);

}  // namespace early_fusion::world
