#include "early_fusion/world/world.h"

#include <algorithm>
#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"
#include "early_fusion/core/image_size.h"
#include "kitchen.h"

namespace early_fusion::world {

namespace {

/// Shrinks [low, high] to `size` about its middle.
void shrink(double& low, double& high, double size, const std::string& key, const std::string& file) {
  constexpr double kRounding = 1e-6;  // [m]
  if (size > high - low + kRounding) {
    std::ostringstream text;
    text << file << ": " << key << " is " << size << " m; the counter has only " << high - low << " m";
    throw core::Error(text.str());
  }
  const double middle = 0.5 * (low + high);
  low = middle - 0.5 * size;
  high = middle + 0.5 * size;
}

std::string orShipped(const std::string& world_file) {
  return world_file.empty() ? core::shareFolder() + "/config/world.yaml" : world_file;
}

}  // namespace

double HorizontalRectangle::overhang(const Eigen::AlignedBox3d& box) const {
  return std::max({min_x - box.min().x(), box.max().x() - max_x, min_y - box.min().y(), box.max().y() - max_y});
}

core::OptionSet WorldOptions::options() {
  core::OptionSet set("world");
  set.add("objects", objects, "the object set, a YAML file; paths are relative to the world file");
  set.add("kitchen_urdf", kitchen_urdf, "URDF of the kitchen, which never moves; its root link is the world frame");
  set.add("camera_urdf", camera_urdf, "URDF of the pan-tilt camera; its root link is the world frame");
  set.add("pan_joint", pan_joint, "revolute joint in camera_urdf, positive to the left");
  set.add("tilt_joint", tilt_joint, "revolute joint in camera_urdf, positive downwards");
  set.add("optical_frame", optical_frame, "link in camera_urdf: z forward, x right, y down");
  set.add("counter_link", counter_link, "link in kitchen_urdf whose collision box carries the objects");
  set.add("placement_width", placement_width, 0.0, 100.0, "m",
          "extent of the objects' centres along y, centred on the counter");
  set.add("placement_depth", placement_depth, 0.0, 100.0, "m",
          "extent of the objects' centres along x, centred on the counter");
  set.add("clearance", clearance, 0.0, 1.0, "m",
          "minimum distance between two objects, and between an object and the kitchen's collision shapes");
  set.add("max_overhang", max_overhang, 0.0, 1.0, "m",
          "maximum length by which an object overhangs an edge of the counter's top");
  core::addImageSize(set, "image_size", image_size, "edge of the square frame");
  set.add("horizontal_fov_deg", horizontal_fov_deg, 10.0, 120.0, "degrees", "horizontal field of view of the frame");
  set.add("max_triangles", max_triangles, 16, 1000000, "",
          "a mesh with more triangles is simplified to this number when it is loaded");
  return set;
}

WorldUrdfs findUrdfs(const std::string& world_file) {
  const std::string yaml_file = orShipped(world_file);
  WorldOptions options;
  options.options().setFromYamlFile(yaml_file);
  return {core::resolvePath(yaml_file, options.camera_urdf), core::resolvePath(yaml_file, options.kitchen_urdf)};
}

std::shared_ptr<const World> loadWorld(const std::string& world_file) {
  const std::string yaml_file = orShipped(world_file);
  auto world = std::make_shared<World>();
  WorldOptions& options = world->options;
  options.options().setFromYamlFile(yaml_file);
  const auto path = [&](const std::string& name) { return core::resolvePath(yaml_file, name); };
  world->rig = CameraRig::load(path(options.camera_urdf), options.pan_joint, options.tilt_joint, options.optical_frame);
  Kitchen kitchen = loadKitchen(path(options.kitchen_urdf), options.counter_link, options.max_triangles);
  world->kitchen = std::move(kitchen.meshes);
  world->obstacles = std::move(kitchen.obstacles);
  world->counter_top = kitchen.counter_top;
  world->placement = kitchen.counter_top;
  HorizontalRectangle& area = world->placement;
  shrink(area.min_y, area.max_y, options.placement_width, "placement_width", yaml_file);
  shrink(area.min_x, area.max_x, options.placement_depth, "placement_depth", yaml_file);
  world->objects = ObjectSet::load(path(options.objects), options.max_triangles);
  return world;
}

}  // namespace early_fusion::world
