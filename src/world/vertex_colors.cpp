#include "vertex_colors.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh_texture.h"

namespace early_fusion::world {

namespace {

constexpr int kSmallestCell = 4;  // texels; two triangles share a cell
constexpr int kLargestCell = 16;
constexpr int kOrderBits = 10;

/// The place of (x, y, z), each in [0, 2^kOrderBits), on a curve that visits neighbours after each other (Morton 1966).
std::uint32_t alongCurve(const std::array<std::uint32_t, 3>& at) {
  std::uint32_t place = 0;
  for (int bit = kOrderBits - 1; bit >= 0; --bit) {
    for (const std::uint32_t coordinate : at) place = place << 1 | (coordinate >> bit & 1u);
  }
  return place;
}

/// The triangles' numbers along the curve.
std::vector<std::size_t> orderInSpace(const MeshPart& part) {
  Eigen::AlignedBox3f box;
  for (const Vertex& vertex : part.vertices) box.extend(vertex.position);
  const float step = std::max(box.sizes().maxCoeff(), 1e-9f) / ((1 << kOrderBits) - 1);
  const std::size_t triangles = part.indices.size() / 3;
  std::vector<std::uint32_t> places(triangles);
  for (std::size_t i = 0; i < triangles; ++i) {
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    for (int k = 0; k < 3; ++k) middle += part.vertices[part.indices[3 * i + k]].position / 3;
    const Eigen::Vector3f at = (middle - box.min()) / step;
    places[i] = alongCurve(
        {static_cast<std::uint32_t>(at.x()), static_cast<std::uint32_t>(at.y()), static_cast<std::uint32_t>(at.z())});
  }
  std::vector<std::size_t> order(triangles);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return places[a] < places[b]; });
  return order;
}

/// The column and row of a cell: the same curve in the plane.
std::array<int, 2> cellAt(std::size_t number) {
  std::array<int, 2> at{};
  for (int bit = 0; number >> (2 * bit) != 0; ++bit) {
    at[0] |= static_cast<int>(number >> (2 * bit) & 1u) << bit;
    at[1] |= static_cast<int>(number >> (2 * bit + 1) & 1u) << bit;
  }
  return at;
}

Eigen::Array4f unpacked(std::uint32_t color) {
  return {static_cast<float>(color & 255u), static_cast<float>(color >> 8 & 255u),
          static_cast<float>(color >> 16 & 255u), static_cast<float>(color >> 24)};
}

std::uint32_t packed(const Eigen::Array4f& color) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) {
    value |= static_cast<std::uint32_t>(std::lround(std::clamp(color[i], 0.f, 255.f))) << (8 * i);
  }
  return value;
}

std::uint32_t meanColor(const std::vector<std::uint32_t>& colors) {
  Eigen::Array4d sum = Eigen::Array4d::Zero();
  for (const std::uint32_t color : colors) sum += unpacked(color).cast<double>();
  return packed((sum / static_cast<double>(colors.size())).cast<float>());
}

}  // namespace

void bakeVertexColors(MeshPart& part) {
  const std::size_t triangles = part.indices.size() / 3;
  int cells = 1;  // along an edge of the texture
  while (static_cast<std::size_t>(cells) * cells * 2 < triangles) cells *= 2;
  const int cell = std::clamp(kMaxTextureSize / cells, kSmallestCell, kLargestCell);
  Texture texture{cells * cell, {}};
  // Reduced copies and samples at the edge of the used cells mix the others in.
  texture.texels.assign(static_cast<std::size_t>(texture.size) * texture.size, meanColor(part.colors));

  std::vector<Vertex> vertices;
  vertices.reserve(3 * triangles);
  const std::vector<std::size_t> order = orderInSpace(part);
  for (std::size_t place = 0; place < triangles; ++place) {
    const std::uint32_t* corner = &part.indices[3 * order[place]];
    const std::array<int, 2> at = cellAt(place / 2);
    // The lower left half of the cell with its diagonal, or the upper right one, which is a texel smaller.
    const int shift = static_cast<int>(place % 2);
    const auto last = static_cast<float>(cell - 1 - shift);
    const auto right = static_cast<float>(shift);
    const Eigen::Vector2f corners[3] = {
        shift == 0 ? Eigen::Vector2f(0, last) : Eigen::Vector2f(right + last, 0), {right, 0}, {right + last, last}};
    const Eigen::Array4f colors[3] = {unpacked(part.colors[corner[0]]), unpacked(part.colors[corner[1]]),
                                      unpacked(part.colors[corner[2]])};
    for (int y = 0; y < cell; ++y) {
      for (int x = 0; x < cell; ++x) {
        if (shift == 0 ? x > y : x <= y) continue;
        const float first = static_cast<float>(shift == 0 ? y - x : x - y - shift) / last;
        const float third = static_cast<float>(shift == 0 ? x : y) / last;
        texture.texels[static_cast<std::size_t>(at[1] * cell + y) * texture.size + at[0] * cell + x] =
            packed(first * colors[0] + (1 - first - third) * colors[1] + third * colors[2]);
      }
    }
    for (int k = 0; k < 3; ++k) {
      vertices.push_back(part.vertices[corner[k]]);
      const Eigen::Vector2f texel = corners[k] + Eigen::Vector2f(at[0] * cell + 0.5f, at[1] * cell + 0.5f);
      vertices.back().uv = texel / static_cast<float>(texture.size);
    }
  }
  part.vertices = std::move(vertices);
  part.indices.resize(part.vertices.size());
  std::iota(part.indices.begin(), part.indices.end(), 0u);
  part.texture = std::move(texture);
  part.colors.clear();
}

}  // namespace early_fusion::world
