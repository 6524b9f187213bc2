#pragma once

#include <Eigen/Geometry>
#include <string>
#include <utility>
#include <vector>

#include "early_fusion/core/vocabulary.h"
#include "early_fusion/world/textured_mesh.h"

namespace early_fusion::world {

/// One type of item. The mesh stands upright on z = 0, the centre of its bounding box above the origin [m].
struct Object {
  std::string name;
  TexturedMesh mesh;
  std::string mesh_file;
  Eigen::Vector3d mesh_scale;   ///< the file's coordinates times mesh_scale, less mesh_origin, are those of `mesh`
  Eigen::Vector3d mesh_origin;  ///< [m]
  std::vector<Eigen::Vector3d> hull;  ///< corners of the convex hull that placement and the cone use [m]
};

/// The items that can stand on the counter, in the order of their indices.
class ObjectSet {
 public:
  ObjectSet() = default;

  /// Objects made by a program. @throws Error when a name is empty or stands twice.
  explicit ObjectSet(std::vector<Object> objects) : objects_(std::move(objects)), vocabulary_(namesOf(objects_)) {}

  /// Reads `objects: [{name, mesh, scale}, ...]`; mesh paths are relative to the YAML file.
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
