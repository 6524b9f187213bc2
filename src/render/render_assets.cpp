#include "render_assets.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>

#include "early_fusion/world/appearance.h"
#include "procedural_texture.h"

namespace early_fusion::render {

namespace {

/// Small enough for effective culling, and large enough to fill whole lanes.
constexpr std::size_t kClusterTriangles = 96;

struct Triangle {
  std::array<std::uint32_t, 3> corner;
  std::int32_t material;
};

/// The triangles of many parts in one list.
struct Soup {
  std::vector<world::Vertex> vertices;
  std::vector<Triangle> triangles;
};

template <class Lanes, class Element>
void setLane(std::vector<Lanes>& lanes, std::size_t index, Element value) {
  lanes[index / kLanes][index % kLanes] = value;
}

std::size_t lanesFor(std::size_t count) { return (count + kLanes - 1) / kLanes; }

std::vector<std::uint32_t> halved(const std::vector<std::uint32_t>& texels, int size) {
  std::vector<std::uint32_t> half(static_cast<std::size_t>(size) * size / 4);
  for (int y = 0; y < size / 2; ++y) {
    for (int x = 0; x < size / 2; ++x) {
      const std::uint32_t* top = &texels[static_cast<std::size_t>(2 * y) * size + 2 * x];
      std::uint32_t mean = 0;
      for (int shift = 0; shift < 32; shift += 8) {
        const auto channel = [shift](std::uint32_t texel) { return texel >> shift & 255u; };
        mean |= (channel(top[0]) + channel(top[1]) + channel(top[size]) + channel(top[size + 1]) + 2) / 4 << shift;
      }
      half[static_cast<std::size_t>(y) * size / 2 + x] = mean;
    }
  }
  return half;
}

std::int32_t addMaterial(RenderAssets& assets, const world::MeshPart& part) {
  const world::Texture& texture = part.texture;
  assert(texture.size > 0 && (texture.size & (texture.size - 1)) == 0);
  assert(texture.texels.size() == static_cast<std::size_t>(texture.size) * texture.size);
  std::vector<std::vector<std::uint32_t>> levels = {texture.texels};
  for (int size = texture.size; size > 1; size /= 2) levels.push_back(halved(levels.back(), size));
  assets.materials.push_back({static_cast<std::int32_t>(assets.texels.size()), texture.size, part.specular});
  for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
    assets.texels.insert(assets.texels.end(), level->begin(), level->end());
  }
  return static_cast<std::int32_t>(assets.materials.size()) - 1;
}

std::array<float, 3> moved(const RenderPose& pose, const Eigen::Vector3f& p, bool is_point) {
  std::array<float, 3> result;
  for (int row = 0; row < 3; ++row) {
    const float* r = pose.rotation[row];
    result[row] = r[0] * p.x() + r[1] * p.y() + r[2] * p.z();
    if (is_point) result[row] += pose.translation[row];
  }
  return result;
}

void addMesh(Soup& soup, RenderAssets& assets, const world::TexturedMesh& mesh, const RenderPose& pose) {
  for (const world::MeshPart& part : mesh.parts) {
    const std::int32_t material = addMaterial(assets, part);
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const world::Vertex& vertex : part.vertices) {
      const std::array<float, 3> position = moved(pose, vertex.position, true);
      const std::array<float, 3> normal = moved(pose, vertex.normal, false);
      soup.vertices.push_back({{position[0], position[1], position[2]}, {normal[0], normal[1], normal[2]}, vertex.uv});
    }
    for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
      const std::uint32_t* corner = &part.indices[i];
      soup.triangles.push_back({{first + corner[0], first + corner[1], first + corner[2]}, material});
    }
  }
}

void setBox(RenderMesh& mesh, const Eigen::AlignedBox3f& box) {
  for (int axis = 0; axis < 3; ++axis) {
    mesh.box_centre[axis] = 0.5f * (box.min()[axis] + box.max()[axis]);
    mesh.box_half_size[axis] = 0.5f * (box.max()[axis] - box.min()[axis]) + 1e-5f;  // larger than the rounding error
  }
}

void setVertices(RenderMesh& mesh, const std::vector<world::Vertex>& vertices) {
  mesh.vertex_count = static_cast<int>(vertices.size());
  const std::size_t lanes = lanesFor(vertices.size());
  for (auto& array : mesh.position) array.resize(lanes);
  for (auto& array : mesh.normal) array.resize(lanes);
  for (auto& array : mesh.uv) array.resize(lanes);
  Eigen::AlignedBox3f box;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) setLane(mesh.position[axis], i, vertices[i].position[axis]);
    for (int axis = 0; axis < 3; ++axis) setLane(mesh.normal[axis], i, vertices[i].normal[axis]);
    for (int axis = 0; axis < 2; ++axis) setLane(mesh.uv[axis], i, vertices[i].uv[axis]);
    box.extend(vertices[i].position);
  }
  setBox(mesh, box);
}

/// The triangles [first, last) of a soup, with the vertices that they use, in the order of their use.
RenderMesh makeMesh(const Soup& soup, const Triangle* first, const Triangle* last) {
  RenderMesh mesh;
  mesh.triangle_count = static_cast<int>(last - first);
  const std::size_t lanes = lanesFor(mesh.triangle_count);
  for (auto& array : mesh.corner) array.resize(lanes);
  mesh.uv_area.resize(lanes);
  std::vector<world::Vertex> vertices;
  std::map<std::uint32_t, int> index_of;
  for (const Triangle* triangle = first; triangle != last; ++triangle) {
    const std::size_t i = triangle - first;
    constexpr int kClockwise[3] = {0, 2, 1};
    Eigen::Vector2f uv[3];
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t corner = triangle->corner[kClockwise[k]];
      const auto [entry, is_new] = index_of.insert({corner, static_cast<int>(vertices.size())});
      if (is_new) vertices.push_back(soup.vertices[corner]);
      setLane(mesh.corner[k], i, entry->second);
      uv[k] = soup.vertices[corner].uv;
    }
    const Eigen::Vector2f a = uv[1] - uv[0], b = uv[2] - uv[0];
    setLane(mesh.uv_area, i, std::fabs(a.x() * b.y() - b.x() * a.y()));
    mesh.material.push_back(triangle->material);
  }
  setVertices(mesh, vertices);
  return mesh;
}

RenderMesh makeMesh(const Soup& soup) {
  return makeMesh(soup, soup.triangles.data(), soup.triangles.data() + soup.triangles.size());
}

void addProceduralMaterials(RenderAssets& assets) {
  assets.first_procedural_material = static_cast<std::int32_t>(assets.materials.size());
  for (int number = 0; number < world::kProceduralTextures; ++number) {
    world::MeshPart part;
    part.texture = proceduralTexture(number);
    addMaterial(assets, part);
  }
}

/// A flat face, counter-clockwise seen from outside, as a fan of triangles.
void addFace(Soup& soup, const std::vector<Eigen::Vector3f>& corners, const Eigen::Vector3f& normal,
             std::int32_t material) {
  const auto first = static_cast<std::uint32_t>(soup.vertices.size());
  const Eigen::Vector3f u = (corners[1] - corners[0]).normalized(), v = normal.cross(u);
  for (const Eigen::Vector3f& corner : corners)
    soup.vertices.push_back({corner, normal, {corner.dot(u), corner.dot(v)}});
  for (std::uint32_t i = 2; i < corners.size(); ++i) {
    soup.triangles.push_back({{first, first + i - 1, first + i}, material});
  }
}

/// An upright prism on z = 0 with height 1 and a regular polygon of `sides` corners as its base.
RenderMesh prism(int sides, float radius, float first_angle, std::int32_t material) {
  Soup soup;
  std::vector<Eigen::Vector3f> base, top;
  for (int i = 0; i < sides; ++i) {
    const float angle = first_angle + static_cast<float>(2 * EIGEN_PI * i / sides);
    base.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.f);
    top.push_back(base.back() + Eigen::Vector3f::UnitZ());
  }
  addFace(soup, top, Eigen::Vector3f::UnitZ(), material);
  for (int i = 0; i < sides; ++i) {
    const int next = (i + 1) % sides;
    const Eigen::Vector3f normal = (base[i] + base[next]).normalized();
    addFace(soup, {base[i], base[next], top[next], top[i]}, normal, material);
  }
  return makeMesh(soup);
}

void addDistractors(RenderAssets& assets) {
  constexpr int kCylinderSides = 16;
  assets.first_distractor_material = static_cast<std::int32_t>(assets.materials.size());
  for (int i = 0; i < world::kMaxDistractors; ++i) {
    const auto material = static_cast<std::int32_t>(assets.materials.size());
    assets.materials.push_back(assets.materials[assets.first_procedural_material]);
    assets.boxes.push_back(prism(4, std::sqrt(0.5f), static_cast<float>(EIGEN_PI / 4), material));
    assets.cylinders.push_back(prism(kCylinderSides, 0.5f, 0.f, material));
  }
}

/// Halves the triangles [first, last) along the longest side of their box until they are few enough.
void addClusters(Soup& soup, Triangle* first, Triangle* last, std::vector<RenderMesh>& clusters) {
  if (first == last) return;
  if (last - first <= static_cast<std::ptrdiff_t>(kClusterTriangles)) {
    clusters.push_back(makeMesh(soup, first, last));
    return;
  }
  const auto centre = [&soup](const Triangle& triangle, int axis) {
    float sum = 0.f;
    for (const std::uint32_t corner : triangle.corner) sum += soup.vertices[corner].position[axis];
    return sum;
  };
  Eigen::AlignedBox3f box;
  for (const Triangle* t = first; t != last; ++t)
    box.extend(Eigen::Vector3f(centre(*t, 0), centre(*t, 1), centre(*t, 2)));
  int longest = 0;
  box.sizes().maxCoeff(&longest);
  std::stable_sort(first, last,
                   [&](const Triangle& a, const Triangle& b) { return centre(a, longest) < centre(b, longest); });
  Triangle* middle = first + (last - first) / 2;
  addClusters(soup, first, middle, clusters);
  addClusters(soup, middle, last, clusters);
}

std::shared_ptr<const RenderAssets> makeRenderAssets(const world::World& world) {
  auto assets = std::make_shared<RenderAssets>();
  assets->texels = {0};  // and a material for parts without one
  assets->materials = {Material{}};
  const RenderPose identity = renderPose(Eigen::Isometry3d::Identity());
  for (int item = 0; item < world.objects.size(); ++item) {
    Soup soup;
    assets->first_object_material.push_back(static_cast<std::int32_t>(assets->materials.size()));
    addMesh(soup, *assets, world.objects[item].mesh, identity);
    assets->objects.push_back(makeMesh(soup));
  }
  assets->first_object_material.push_back(static_cast<std::int32_t>(assets->materials.size()));
  Soup soup;
  for (const world::FixedMesh& fixed : world.kitchen)
    addMesh(soup, *assets, fixed.mesh, renderPose(fixed.world_from_mesh));
  addClusters(soup, soup.triangles.data(), soup.triangles.data() + soup.triangles.size(), assets->kitchen);
  addProceduralMaterials(*assets);
  addDistractors(*assets);
  return assets;
}

}  // namespace

RenderPose renderPose(const Eigen::Isometry3d& pose) {
  const auto rounded = [](double value) {
    return static_cast<float>(std::ldexp(std::nearbyint(std::ldexp(value, 30)), -30));
  };
  RenderPose result;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) result.rotation[row][column] = rounded(pose(row, column));
    result.translation[row] = rounded(pose(row, 3));
  }
  return result;
}

std::shared_ptr<const RenderAssets> sharedRenderAssets(const world::World& world) {
  // The assets keep their World alive, so another World cannot have its address while the entry is valid.
  static std::mutex mutex;
  static std::map<const world::World*, std::weak_ptr<const RenderAssets>> assets_of;
  const std::lock_guard<std::mutex> lock(mutex);
  for (auto entry = assets_of.begin(); entry != assets_of.end();) {
    entry = entry->second.expired() ? assets_of.erase(entry) : std::next(entry);
  }
  if (const auto found = assets_of.find(&world); found != assets_of.end()) {
    if (auto assets = found->second.lock()) return assets;
  }
  auto assets = makeRenderAssets(world);
  assets_of[&world] = assets;
  return assets;
}

}  // namespace early_fusion::render
