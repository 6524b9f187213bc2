#pragma once

#include <Eigen/Geometry>
#include <string>
#include <utility>
#include <vector>

#include "early_fusion/core/vocabulary.h"
#include "early_fusion/world/textured_mesh.h"

namespace early_fusion::world {

/// One item. The mesh stands upright on z = 0, with the centre of its bounding box above the origin [m].
struct Object {
  std::string name;
  TexturedMesh mesh;
  std::string mesh_file;
  /// Coordinates of `mesh` = mesh_rotation * (mesh_scale * coordinates in the file) - mesh_origin.
  /// The axes of a glTF file are turned first, so that z is up.
  Eigen::Vector3d mesh_scale;
  Eigen::Quaterniond mesh_rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d mesh_origin;        ///< [m]
  std::vector<Eigen::Vector3d> hull;  ///< corners of the convex hull for placement and the cone [m]
};

/// The items that can stand on the counter, by index.
class ObjectSet {
 public:
  ObjectSet() = default;

  /// A set of the given objects. @throws Error if a name is empty or is listed twice.
  explicit ObjectSet(std::vector<Object> objects) : objects_(std::move(objects)), vocabulary_(namesOf(objects_)) {}

  /// Reads `objects: [{name, mesh, scale, rotation}, ...]`; mesh paths are relative to the YAML file, or package://,
  /// model:// and file:// URLs.
  /// @throws Error naming file, line, key and value.
  static ObjectSet load(const std::string& yaml_file, int max_triangles);

  int size() const { return static_cast<int>(objects_.size()); }
  const Object& operator[](int item) const { return objects_[item]; }
  const core::Vocabulary& vocabulary() const { return vocabulary_; }

 private:
  static core::Vocabulary namesOf(const std::vector<Object>& objects) {
    std::vector<std::string> names;
    names.reserve(objects.size());
    for (const Object& object : objects) names.push_back(object.name);
    return core::Vocabulary(names);
  }

  std::vector<Object> objects_;
  core::Vocabulary vocabulary_;
};

}  // namespace early_fusion::world
