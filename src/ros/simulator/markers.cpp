#include "early_fusion/ros/simulator/markers.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "early_fusion/core/file.h"
#include "early_fusion/ros/shared/conversions.h"

namespace early_fusion::nodes {

namespace {

constexpr double kNameHeight = 0.03;  // [m], of a capital letter
constexpr double kNameGap = 0.02;     // [m], between an object and its name

/// Whether rviz draws the object's file as the simulator does.
bool isDrawnByRviz(const world::Object& object) {
  if (object.mesh.adapted) return false;
  const std::string extension = core::lowerCaseExtension(object.mesh_file);
  return extension == ".obj" || extension == ".stl" || extension == ".dae";
}

std_msgs::ColorRGBA colorAt(const world::Texture& texture, const Eigen::Vector2f& uv) {
  const auto texel = [&](float coordinate) {
    const auto at = static_cast<int>((coordinate - std::floor(coordinate)) * static_cast<float>(texture.size));
    return std::min(at, texture.size - 1);
  };
  const std::uint32_t color = texture.texels[static_cast<std::size_t>(texel(uv.y())) * texture.size + texel(uv.x())];
  std_msgs::ColorRGBA message;
  message.r = static_cast<float>(color & 255u) / 255.f;
  message.g = static_cast<float>(color >> 8 & 255u) / 255.f;
  message.b = static_cast<float>(color >> 16 & 255u) / 255.f;
  message.a = 1.f;
  return message;
}

/// The simulator's own triangles, each corner in the colour of its texture there.
visualization_msgs::Marker triangleMarker(const world::Object& object, const Eigen::Isometry3d& world_from_object) {
  visualization_msgs::Marker marker;
  marker.ns = "objects";
  marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
  marker.pose = poseMessage(world_from_object);
  marker.scale.x = marker.scale.y = marker.scale.z = 1;
  marker.color.a = 1.f;
  for (const world::MeshPart& part : object.mesh.parts) {
    for (const std::uint32_t index : part.indices) {
      const world::Vertex& vertex = part.vertices[index];
      marker.points.emplace_back();
      marker.points.back().x = vertex.position.x();
      marker.points.back().y = vertex.position.y();
      marker.points.back().z = vertex.position.z();
      marker.colors.push_back(colorAt(part.texture, vertex.uv));
    }
  }
  return marker;
}

visualization_msgs::Marker meshMarker(const world::Object& object, const Eigen::Isometry3d& world_from_object) {
  if (!isDrawnByRviz(object)) return triangleMarker(object, world_from_object);
  visualization_msgs::Marker marker;
  marker.ns = "objects";
  marker.type = visualization_msgs::Marker::MESH_RESOURCE;
  marker.mesh_resource = meshUrl(object.mesh_file);
  marker.mesh_use_embedded_materials = true;
  // rviz scales the file's coordinates and then applies the pose. The object set turns its scaled mesh and moves it to
  // the origin.
  marker.pose = poseMessage(world_from_object * Eigen::Translation3d(-object.mesh_origin) * object.mesh_rotation);
  marker.scale.x = object.mesh_scale.x();
  marker.scale.y = object.mesh_scale.y();
  marker.scale.z = object.mesh_scale.z();
  return marker;
}

visualization_msgs::Marker nameMarker(const world::Object& object, const Eigen::Isometry3d& world_from_object) {
  const double top = object.mesh.bounds().max().z();
  visualization_msgs::Marker marker;
  marker.ns = "requested";
  marker.type = visualization_msgs::Marker::TEXT_VIEW_FACING;
  marker.text = object.name;
  marker.pose = poseMessage(world_from_object * Eigen::Translation3d(0, 0, top + kNameGap));
  marker.scale.z = kNameHeight;
  marker.color.r = 1.f;
  marker.color.g = 0.8f;
  marker.color.b = 0.1f;
  marker.color.a = 1.f;
  return marker;
}

}  // namespace

std::string meshUrl(const std::string& mesh_file) {
  namespace fs = std::filesystem;
  const fs::path path = fs::absolute(mesh_file).lexically_normal();
  const fs::path inside = path.lexically_relative(fs::absolute(core::shareFolder()).lexically_normal());
  if (!inside.empty() && *inside.begin() != "..") return "package://early_fusion/" + inside.string();
  return "file://" + path.string();
}

visualization_msgs::MarkerArray objectMarkers(const world::World& world, const sim::Episode& episode,
                                              const std_msgs::Header& header) {
  visualization_msgs::MarkerArray array;
  array.markers.emplace_back();
  array.markers.back().action = visualization_msgs::Marker::DELETEALL;
  const core::Request& request = episode.state().request;
  const std::vector<sim::Instance>& instances = episode.setup().instances;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (((episode.state().present >> i) & 1) == 0) continue;
    const world::Object& object = world.objects[instances[i].item];
    const Eigen::Isometry3d world_from_object = sim::worldFromObject(world, instances[i]);
    array.markers.push_back(meshMarker(object, world_from_object));
    array.markers.back().id = static_cast<int>(i);
    if (core::countOf(request, instances[i].item) == 0) continue;
    array.markers.push_back(nameMarker(object, world_from_object));
    array.markers.back().id = static_cast<int>(i);
  }
  for (visualization_msgs::Marker& marker : array.markers) marker.header = header;
  return array;
}

}  // namespace early_fusion::nodes
