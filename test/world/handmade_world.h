#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "early_fusion/core/random.h"
#include "early_fusion/world/object_pose.h"
#include "early_fusion/world/world.h"

/// Worlds made by the program, for tests and benchmarks of the rasterizer that are to depend on no file.
namespace early_fusion::world {

inline std::uint32_t rgb(int red, int green, int blue) { return red | green << 8 | blue << 16 | 0xff000000u; }

inline Texture plainTexture(std::uint32_t color) { return {4, std::vector<std::uint32_t>(16, color)}; }

/// Fields of a size a texel apart, in two colours with a little noise.
inline Texture checkerTexture(int size, int field, std::uint32_t first, std::uint32_t second, std::uint64_t seed = 0) {
  core::Random random(seed);
  Texture texture{size, std::vector<std::uint32_t>(static_cast<std::size_t>(size) * size)};
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const std::uint32_t color = (x / field + y / field) % 2 == 0 ? first : second;
      texture.texels[static_cast<std::size_t>(y) * size + x] = seed == 0 ? color : color ^ random.below(16) * 0x010101u;
    }
  }
  return texture;
}

/// Appends a parallelogram of columns x rows cells; its front is where right x down points away from.
inline void appendQuad(MeshPart& part, const Eigen::Vector3f& corner, const Eigen::Vector3f& right,
                       const Eigen::Vector3f& down, int columns = 1, int rows = 1, float repeats = 1.f) {
  const auto first = static_cast<std::uint32_t>(part.vertices.size());
  const Eigen::Vector3f normal = down.cross(right).normalized();
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      const float u = static_cast<float>(column) / columns, v = static_cast<float>(row) / rows;
      part.vertices.push_back({corner + u * right + v * down, normal, repeats * Eigen::Vector2f(u, v)});
    }
  }
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const std::uint32_t top = first + row * (columns + 1) + column, bottom = top + columns + 1;
      part.indices.insert(part.indices.end(), {top, bottom, bottom + 1, top, bottom + 1, top + 1});
    }
  }
}

inline void appendBox(MeshPart& part, const Eigen::Vector3f& low, const Eigen::Vector3f& high, int cells = 1,
                      float repeats = 1.f) {
  const Eigen::Vector3f size = high - low;
  const Eigen::Vector3f x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  appendQuad(part, low + y + z, -y, -z, cells, cells, repeats);  // -x
  appendQuad(part, low + x + z, y, -z, cells, cells, repeats);   // +x
  appendQuad(part, low + z, x, -z, cells, cells, repeats);       // -y
  appendQuad(part, high, -x, -z, cells, cells, repeats);         // +y
  appendQuad(part, low + y, x, -y, cells, cells, repeats);       // -z
  appendQuad(part, low + y + z, -y, x, cells, cells, repeats);   // +z
}

/// A sphere, or an egg, on z = 0.
inline void appendBall(MeshPart& part, float radius, float height, int segments, int rings) {
  constexpr float kPi = 3.14159265f;
  for (int ring = 0; ring <= rings; ++ring) {
    for (int segment = 0; segment <= segments; ++segment) {
      const float polar = kPi * ring / rings, azimuth = 2 * kPi * segment / segments;
      const Eigen::Vector3f unit(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                                 std::cos(polar));
      part.vertices.push_back({{radius * unit.x(), radius * unit.y(), 0.5f * height * (1 + unit.z())},
                               unit,
                               {2.f * segment / segments, static_cast<float>(ring) / rings}});
    }
  }
  for (int ring = 0; ring < rings; ++ring) {
    for (int segment = 0; segment < segments; ++segment) {
      const std::uint32_t top = ring * (segments + 1) + segment, bottom = top + segments + 1;
      if (ring > 0) part.indices.insert(part.indices.end(), {top, bottom, top + 1});
      if (ring < rings - 1) part.indices.insert(part.indices.end(), {top + 1, bottom, bottom + 1});
    }
  }
}

inline FixedMesh fixedMesh(MeshPart part) {
  TexturedMesh mesh;
  mesh.parts.push_back(std::move(part));
  return {"fixed", std::move(mesh), Eigen::Isometry3d::Identity()};
}

/// Camera at `eye`, looking along `forward`, its image upright.
inline Eigen::Isometry3d lookAlong(const Eigen::Vector3d& eye, const Eigen::Vector3d& forward) {
  const Eigen::Vector3d z = forward.normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << x, z.cross(x), z;
  pose.translation() = eye;
  return pose;
}

/// Item 0 is a box of 12 cells^2 triangles, item 1 a ball of about as many, and so on in turns.
inline ObjectSet handmadeObjects(int count, int cells) {
  std::vector<Object> objects;
  for (int item = 0; item < count; ++item) {
    MeshPart part;
    part.texture = checkerTexture(256, 32, rgb(255 - 12 * item, 40 + 10 * item, 60), rgb(230, 225, 210), item + 1);
    part.specular = 0.2f;
    if (item % 2 == 0) {
      appendBox(part, {-0.03f, -0.04f, 0.f}, {0.03f, 0.04f, 0.16f}, cells);
    } else {
      const int segments = static_cast<int>(std::lround(cells * 3.5));
      appendBall(part, 0.05f, 0.10f, segments, segments / 2 + 1);
    }
    Object object;
    object.name = "item_" + std::to_string(item);
    object.mesh.parts.push_back(std::move(part));
    objects.push_back(std::move(object));
  }
  return ObjectSet(std::move(objects));
}

/// A counter before a wall, with cabinets, of about 2,000 triangles, and `items` types of about 12 cells^2 triangles.
inline std::shared_ptr<World> handmadeKitchen(int items, int cells) {
  auto world = std::make_shared<World>();
  world->objects = handmadeObjects(items, cells);
  world->placement = {0.55, 1.05, -0.8, 0.8, 0.9};
  MeshPart counter, wall, cabinets, floor;
  counter.texture = checkerTexture(512, 128, rgb(120, 110, 100), rgb(150, 140, 125), 21);
  counter.specular = 0.15f;
  wall.texture = checkerTexture(512, 64, rgb(215, 220, 214), rgb(190, 200, 200), 22);
  cabinets.texture = checkerTexture(256, 64, rgb(150, 112, 80), rgb(140, 100, 70), 23);
  floor.texture = checkerTexture(512, 128, rgb(160, 150, 130), rgb(110, 100, 95), 24);
  appendBox(counter, {0.45f, -1.6f, 0.86f}, {1.2f, 1.6f, 0.9f}, 6, 3.f);
  appendQuad(wall, {1.22f, 2.5f, 2.6f}, {0, -5.f, 0}, {0, 0, -2.6f}, 16, 10, 4.f);
  appendQuad(floor, {1.22f, 2.5f, 0.f}, {0, -5.f, 0}, {-3.f, 0, 0}, 10, 8, 4.f);
  for (int i = 0; i < 5; ++i) {
    const float y = -1.55f + 0.62f * i;
    appendBox(cabinets, {0.5f, y, 0.1f}, {1.2f, y + 0.6f, 0.85f}, 3);
    appendBox(cabinets, {0.9f, y, 1.5f}, {1.2f, y + 0.6f, 2.2f}, 3);
  }
  for (MeshPart* part : {&counter, &wall, &cabinets, &floor}) world->kitchen.push_back(fixedMesh(std::move(*part)));
  return world;
}

/// An object upright on the counter of handmadeKitchen().
inline ObjectPose onCounter(int item, double x, double y, double theta) {
  return {item, Eigen::Translation3d(x, y, 0.9) * Eigen::AngleAxisd(theta, Eigen::Vector3d::UnitZ())};
}

/// `count` objects on a loose grid over the counter of handmadeKitchen().
inline std::vector<ObjectPose> handmadeScene(int count, int items) {
  std::vector<ObjectPose> objects;
  const int columns = (count + 1) / 2;
  for (int i = 0; i < count; ++i) {
    const double y = -0.55 + 1.1 * (i / 2 + 0.5) / columns;
    objects.push_back(onCounter(i % items, i % 2 == 0 ? 0.68 : 0.93, y, 0.7 * i));
  }
  return objects;
}

}  // namespace early_fusion::world
