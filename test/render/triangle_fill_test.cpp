#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "early_fusion/core/random.h"
#include "sample_buffer.h"
#include "triangle_batch.h"

namespace early_fusion::render {
namespace {

constexpr int kSize = 64;  // [samples]

struct Corner {
  int x, y;  // [subsamples]
  float depth;
};
using Corners = std::array<Corner, 3>;

/// One triangle, alone in its batch.
void draw(SampleBuffer& buffer, const Corners& triangle, int id, bool two_sided = true) {
  TriangleCorners corners{};
  for (int k = 0; k < 3; ++k) {
    corners.x[k][0] = triangle[k].x;
    corners.y[k][0] = triangle[k].y;
    corners.depth[k][0] = triangle[k].depth;
  }
  TriangleBatch batch;
  if (setUp(batch, corners, two_sided, kSize, kSize) & 1u) buffer.fill(batch, 0, id);
}

std::vector<int> ids(const SampleBuffer& buffer) {
  std::vector<int> rows(kSize * kSize);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      rows[y * kSize + x] = buffer.ids()[buffer.pixelOffset(x / 2, y / 2) + 2 * (y % 2) + x % 2];
    }
  }
  return rows;
}

std::vector<int> covered(const Corners& triangle, bool two_sided = true) {
  SampleBuffer buffer(kSize, kSize, true);
  buffer.clear(0.f);
  draw(buffer, triangle, 1, two_sided);
  return ids(buffer);
}

/// Some on the screen, some around it; often on a sample's centre.
Corner randomCorner(core::Random& random) {
  Corner corner{random.below(2 * kSize * kSubsamples) - kSize * kSubsamples / 2,
                random.below(2 * kSize * kSubsamples) - kSize * kSubsamples / 2, 1.f};
  if (random.below(2) == 0) {
    corner.x = (corner.x & ~(8 * kSubsamples - 1)) + kSubsamples / 2;
    corner.y = (corner.y & ~(8 * kSubsamples - 1)) + kSubsamples / 2;
  }
  return corner;
}

long side(const Corner& a, const Corner& b, long x, long y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

TEST(TriangleFill, CoversTheSamplesInsideAndNoneOutside) {
  core::Random random(1);
  for (int round = 0; round < 300; ++round) {
    const Corners t = {randomCorner(random), randomCorner(random), randomCorner(random)};
    const long area = side(t[0], t[1], t[2].x, t[2].y);
    if (area == 0) continue;
    const std::vector<int> rows = covered(t);
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const long px = kSubsamples * x + kSubsamples / 2, py = kSubsamples * y + kSubsamples / 2;
        const long sign = area > 0 ? 1 : -1;
        long nearest_edge = 1;
        for (int k = 0; k < 3; ++k) nearest_edge = std::min(nearest_edge, sign * side(t[k], t[(k + 1) % 3], px, py));
        if (nearest_edge == 0) continue;  // on an edge: the next test's
        ASSERT_EQ(rows[y * kSize + x], nearest_edge > 0 ? 1 : 0) << "round " << round << " at " << x << ", " << y;
      }
    }
  }
}

TEST(TriangleFill, ASampleOnASharedEdgeBelongsToOneTriangle) {
  core::Random random(2);
  int on_edge = 0;
  for (int round = 0; round < 3000; ++round) {
    const Corner a = randomCorner(random), b = randomCorner(random), c = randomCorner(random), d = randomCorner(random);
    const long side_c = side(a, b, c.x, c.y), side_d = side(a, b, d.x, d.y);
    if (side_c <= 0 || side_d >= 0) continue;  // not on both sides of the edge from a to b
    const std::vector<int> first = covered({a, b, c}), second = covered({b, a, d});
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const int i = y * kSize + x;
        ASSERT_LE(first[i] + second[i], 1) << "twice at " << x << ", " << y << " in round " << round;
        const long px = kSubsamples * x + kSubsamples / 2, py = kSubsamples * y + kSubsamples / 2;
        const bool inside_both_caps =
            side(b, c, px, py) > 0 && side(c, a, px, py) > 0 && side(a, d, px, py) > 0 && side(d, b, px, py) > 0;
        if (side(a, b, px, py) != 0 || !inside_both_caps) continue;
        ++on_edge;
        ASSERT_EQ(first[i] + second[i], 1) << "not at all at " << x << ", " << y << " in round " << round;
      }
    }
  }
  EXPECT_GT(on_edge, 100);
}

TEST(TriangleFill, OneSidedTrianglesShowTheirClockwiseSide) {
  const Corner a{0, 0, 1.f}, b{800, 0, 1.f}, c{0, 800, 1.f};
  const auto count = [](const std::vector<int>& rows) { return std::count(rows.begin(), rows.end(), 1); };
  EXPECT_GT(count(covered({a, b, c}, false)), 1000);
  EXPECT_EQ(count(covered({a, c, b}, false)), 0);
  EXPECT_EQ(count(covered({a, c, b}, true)), count(covered({a, b, c}, true)));
}

TEST(TriangleFill, TheGreaterDepthValueWinsInAnyOrder) {
  const Corners sloping = {Corner{0, 0, 0.1f}, {1024, 0, 0.9f}, {0, 1024, 0.1f}};
  const Corners level = {Corner{0, 0, 0.5f}, {1024, 0, 0.5f}, {0, 1024, 0.5f}};
  std::vector<int> rows[2];
  for (int order = 0; order < 2; ++order) {
    SampleBuffer buffer(kSize, kSize, true);
    buffer.clear(0.f);
    draw(buffer, order == 0 ? sloping : level, order == 0 ? 1 : 2);
    draw(buffer, order == 0 ? level : sloping, order == 0 ? 2 : 1);
    rows[order] = ids(buffer);
  }
  EXPECT_EQ(rows[0], rows[1]);
  EXPECT_EQ(rows[0][2 * kSize + 2], 2);    // on the left the level one is nearer
  EXPECT_EQ(rows[0][2 * kSize + 50], 1);   // on the right the sloping one
  EXPECT_EQ(rows[0][63 * kSize + 63], 0);  // beyond both
}

TEST(TriangleFill, CopiedDepthLiesRowByRow) {
  SampleBuffer buffer(kSize, kSize, false);
  buffer.clear(-1.f);
  // depth = x / 1024 over the upper left half
  draw(buffer, {Corner{0, 0, 0.f}, {1024, 0, 1.f}, {0, 1024, 0.f}}, 0);
  std::vector<float> depth;
  buffer.copyDepth(depth);
  ASSERT_EQ(depth.size(), static_cast<std::size_t>(kSize * kSize));
  EXPECT_NEAR(depth[3 * kSize + 20], (20 * 16 + 8) / 1024.0, 1e-6);
  EXPECT_NEAR(depth[40 * kSize + 5], (5 * 16 + 8) / 1024.0, 1e-6);
  EXPECT_EQ(depth[63 * kSize + 63], -1.f);
}

}  // namespace
}  // namespace early_fusion::render
