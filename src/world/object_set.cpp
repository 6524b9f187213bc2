#include "early_fusion/world/object_set.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/file.h"
#include "early_fusion/core/names.h"
#include "early_fusion/core/options.h"
#include "early_fusion/world/convex_hull.h"
#include "early_fusion/world/yaml_entries.h"
#include "resource_path.h"

namespace early_fusion::world {

namespace {

constexpr double kMinSize = 0.005;      // [m]
constexpr double kMinThickness = 1e-4;  // [m]
constexpr double kMaxSize = 2.0;        // [m]

/// One number, or one for each axis; 1 if absent.
Eigen::Vector3d readScale(const YAML::Node& value, const std::string& file) {
  if (!value) return Eigen::Vector3d::Ones();
  Eigen::Vector3d scale = Eigen::Vector3d::Constant(NAN);
  try {
    if (value.IsScalar()) scale.setConstant(value.as<double>());
    if (value.IsSequence() && value.size() == 3) {
      for (int axis = 0; axis < 3; ++axis) scale[axis] = value[axis].as<double>();
    }
  } catch (const YAML::Exception&) {
    scale.setConstant(NAN);
  }
  if (scale.minCoeff() > 0 && scale.allFinite()) return scale;
  std::ostringstream text;
  text << value;
  throw core::Error(place(file, value) + "scale is '" + core::excerpt(text.str()) +
                    "'; it must be a positive number or [x, y, z]");
}

/// Moves the mesh upright onto z = 0, centred above the origin. @return the point that became the origin.
Eigen::Vector3d normalise(TexturedMesh& mesh) {
  const Eigen::AlignedBox3f bounds = mesh.bounds();
  const Eigen::Vector3f base(bounds.center().x(), bounds.center().y(), bounds.min().z());
  for (MeshPart& part : mesh.parts) {
    for (Vertex& vertex : part.vertices) vertex.position -= base;
  }
  return base.cast<double>();
}

void checkSize(const TexturedMesh& mesh, const std::string& where) {
  const Eigen::Vector3f size = mesh.bounds().sizes();
  if (size.minCoeff() < kMinThickness) {
    throw core::Error(where + "the mesh is flat: it is thinner than 0.1 mm; give it a thickness");
  }
  if (size.maxCoeff() >= kMinSize && size.maxCoeff() <= kMaxSize) return;
  std::ostringstream text;
  text << size.x() << " x " << size.y() << " x " << size.z();
  throw core::Error(where + "the mesh is " + text.str() +
                    " m; its longest side must be within [0.005, 2] m: check the scale (metres a mesh unit)");
}

Object readObject(const YAML::Node& entry, const std::string& file, int max_triangles) {
  if (!entry.IsMap()) throw core::Error(place(file, entry) + "an object is a map of name, mesh and scale");
  checkKeys(entry, {"mesh", "name", "rotation", "scale"}, file);
  Object object;
  object.name = readText(entry, "name", file, "an object");
  object.mesh_scale = readScale(entry["scale"], file);
  object.mesh_rotation = readRotation(entry["rotation"], file);
  const std::string mesh = readText(entry, "mesh", file, "an object");
  const std::string where = place(file, entry) + "object '" + core::excerpt(object.name) + "': ";
  try {
    object.mesh_file = resourcePath(file, mesh);
    object.mesh = loadTexturedMesh(
        object.mesh_file, Eigen::Affine3d(object.mesh_rotation) * Eigen::Scaling(object.mesh_scale), max_triangles);
  } catch (const core::Error& error) {
    throw core::Error(where + error.what());
  }
  checkSize(object.mesh, where + object.mesh_file + ": ");
  object.mesh_origin = normalise(object.mesh);
  object.hull = collisionHull(object.mesh);
  return object;
}

}  // namespace

ObjectSet ObjectSet::load(const std::string& yaml_file, int max_triangles) {
  const YAML::Node root = core::loadYamlFile(yaml_file);
  if (!root.IsMap() || !root["objects"] || !root["objects"].IsSequence() || root["objects"].size() == 0) {
    throw core::Error(yaml_file + ": needs 'objects', a list of {name, mesh, scale}");
  }
  checkKeys(root, {"objects"}, yaml_file);
  ObjectSet set;
  std::vector<std::string> names;
  for (const YAML::Node& entry : root["objects"]) {
    set.objects_.push_back(readObject(entry, yaml_file, max_triangles));
    names.push_back(set.objects_.back().name);
  }
  try {
    set.vocabulary_ = core::Vocabulary(names);
  } catch (const core::Error& error) {
    throw core::Error(yaml_file + ": " + error.what());
  }
  return set;
}

}  // namespace early_fusion::world
