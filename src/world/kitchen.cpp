#include "kitchen.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/file.h"
#include "early_fusion/core/names.h"
#include "early_fusion/world/convex_hull.h"
#include "primitive_mesh.h"
#include "resource_path.h"
#include "urdf_file.h"

namespace early_fusion::world {

namespace {

constexpr std::uint32_t kLightGrey = 0xffc8c8c8u;

Eigen::Isometry3d worldFromLink(const urdf::ModelInterface& model, const std::string& name, const std::string& file) {
  Eigen::Isometry3d world_from_link = Eigen::Isometry3d::Identity();
  urdf::LinkConstSharedPtr link = model.getLink(name);
  while (const urdf::JointConstSharedPtr joint = link->parent_joint) {
    if (joint->type != urdf::Joint::FIXED) {
      throw core::Error(file + ": joint '" + core::excerpt(joint->name) +
                        "' must be fixed: nothing in the kitchen moves");
    }
    world_from_link = toEigen(joint->parent_to_joint_origin_transform) * world_from_link;
    link = model.getLink(joint->parent_link_name);
  }
  return world_from_link;
}

std::uint32_t colourOf(const urdf::Visual& visual) {
  if (!visual.material) return kLightGrey;
  const urdf::Color& colour = visual.material->color;
  const auto byte = [](float value) {
    return static_cast<std::uint32_t>(std::lround(255 * std::clamp(std::isnan(value) ? 0.f : value, 0.f, 1.f)));
  };
  return 0xff000000u | byte(colour.b) << 16 | byte(colour.g) << 8 | byte(colour.r);
}

void requirePositive(std::initializer_list<double> sizes) {
  for (const double size : sizes) {
    if (size > 0 && std::isfinite(size)) continue;
    throw core::Error("a visual or collision has a shape of size " + std::to_string(size) +
                      " m; every size must be a positive number");
  }
}

/// @param shape null where the URDF's parser knows none of the shapes or refuses its size.
TexturedMesh meshOf(const urdf::GeometrySharedPtr& shape, std::uint32_t colour, const std::string& urdf_file,
                    int max_triangles) {
  if (!shape) {
    throw core::Error(
        "a visual or collision has no valid geometry; use a box, cylinder, sphere or mesh of positive size");
  }
  const urdf::Geometry& geometry = *shape;
  switch (geometry.type) {
    case urdf::Geometry::BOX: {
      const Eigen::Vector3d size = toEigen(static_cast<const urdf::Box&>(geometry).dim);
      requirePositive({size.x(), size.y(), size.z()});
      return boxMesh(size, colour);
    }
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
      requirePositive({cylinder.radius, cylinder.length});
      return cylinderMesh(cylinder.radius, cylinder.length, colour);
    }
    case urdf::Geometry::SPHERE: {
      const double radius = static_cast<const urdf::Sphere&>(geometry).radius;
      requirePositive({radius});
      return sphereMesh(radius, colour);
    }
    case urdf::Geometry::MESH:
      break;
  }
  const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
  return loadTexturedMesh(resourcePath(urdf_file, mesh.filename), Eigen::Affine3d(Eigen::Scaling(toEigen(mesh.scale))),
                          max_triangles, MeshPurpose::kSurroundings);
}

HorizontalRectangle topOf(const urdf::Link& link, const Eigen::Isometry3d& world_from_link, const std::string& where) {
  if (!link.collision || !link.collision->geometry || link.collision->geometry->type != urdf::Geometry::BOX) {
    throw core::Error(where + " needs a collision box: its top carries the objects");
  }
  const Eigen::Isometry3d world_from_box = world_from_link * toEigen(link.collision->origin);
  const Eigen::Matrix3d turned = world_from_box.linear().cwiseAbs();
  if ((turned - turned.array().round().matrix()).cwiseAbs().maxCoeff() > 1e-4) {
    throw core::Error(where + ": its collision box must be parallel to the world's axes");
  }
  const Eigen::Vector3d half = 0.5 * turned * toEigen(static_cast<const urdf::Box&>(*link.collision->geometry).dim);
  const Eigen::Vector3d center = world_from_box.translation();
  return {center.x() - half.x(), center.x() + half.x(), center.y() - half.y(), center.y() + half.y(),
          center.z() + half.z()};
}

/// Adds a link's collision shapes that rise above `counter_top` [m]. The others are below the objects.
void addObstacles(const urdf::Link& link, const Eigen::Isometry3d& world_from_link, double counter_top,
                  const std::string& urdf_file, int max_triangles,
                  std::vector<std::shared_ptr<const PlacedHull>>& obstacles) {
  constexpr double kLevel = 0.001;  // [m]
  for (const urdf::CollisionSharedPtr& collision : link.collision_array) {
    const TexturedMesh mesh = meshOf(collision->geometry, kLightGrey, urdf_file, max_triangles);
    auto hull = std::make_shared<const PlacedHull>(collisionHull(mesh), world_from_link * toEigen(collision->origin));
    if (hull->bounds().max().z() > counter_top + kLevel) obstacles.push_back(std::move(hull));
  }
}

}  // namespace

Kitchen loadKitchen(const std::string& urdf_file, const std::string& counter_link, int max_triangles) {
  const urdf::ModelInterfaceSharedPtr model = loadWholeUrdf(urdf_file);
  const urdf::LinkConstSharedPtr counter = model->getLink(counter_link);
  if (!counter) {
    throw core::Error(urdf_file + ": no link '" + counter_link +
                      "'; its links are: " + core::listed(core::keys(model->links_)));
  }
  Kitchen kitchen;
  kitchen.counter_top =
      topOf(*counter, worldFromLink(*model, counter_link, urdf_file), urdf_file + ": link '" + counter_link + "'");
  for (const auto& [name, link] : model->links_) {
    const Eigen::Isometry3d world_from_link = worldFromLink(*model, name, urdf_file);
    try {
      for (const urdf::VisualSharedPtr& visual : link->visual_array) {
        kitchen.meshes.push_back({name, meshOf(visual->geometry, colourOf(*visual), urdf_file, max_triangles),
                                  world_from_link * toEigen(visual->origin)});
      }
      addObstacles(*link, world_from_link, kitchen.counter_top.z, urdf_file, max_triangles, kitchen.obstacles);
    } catch (const core::Error& error) {
      throw core::Error(urdf_file + ": link '" + core::excerpt(name) + "': " + error.what());
    }
  }
  return kitchen;
}

}  // namespace early_fusion::world
