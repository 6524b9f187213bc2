#include "triangle_batch.h"

namespace early_fusion::render {

namespace {

constexpr int kHalfSample = kSubsamples / 2;

IntLanes lowestOf(const std::array<IntLanes, 3>& c) { return lowest(lowest(c[0], c[1]), c[2]); }
IntLanes highestOf(const std::array<IntLanes, 3>& c) { return highest(highest(c[0], c[1]), c[2]); }
FloatLanes lowestOf(const std::array<FloatLanes, 3>& c) { return lowest(lowest(c[0], c[1]), c[2]); }
FloatLanes highestOf(const std::array<FloatLanes, 3>& c) { return highest(highest(c[0], c[1]), c[2]); }

/// The samples with lowest <= centre <= highest, within the screen.
IntLanes firstSample(const std::array<IntLanes, 3>& c) {
  return highest((lowestOf(c) + (kHalfSample - 1)) >> kSubsampleBits, IntLanes{});
}

IntLanes lastSample(const std::array<IntLanes, 3>& c, int size) {
  return lowest((highestOf(c) - kHalfSample) >> kSubsampleBits, allLanes(size - 1));
}

template <class Lanes>
void swapWhere(IntLanes mask, Lanes& a, Lanes& b) {
  const Lanes old_a = a;
  a = select(mask, b, a);
  b = select(mask, old_a, b);
}

IntLanes doubleArea(const TriangleCorners& c) {
  return (c.x[1] - c.x[0]) * (c.y[2] - c.y[0]) - (c.x[2] - c.x[0]) * (c.y[1] - c.y[0]);
}

void setUpEdges(TriangleBatch& t, const TriangleCorners& c, IntLanes centre_x, IntLanes centre_y) {
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    t.edge_x[k] = c.y[k] - c.y[next];
    t.edge_y[k] = c.x[next] - c.x[k];
    // In the neighbouring triangle, both slopes of the edge are negated, so exactly one of the two covers it.
    const IntLanes owned = (t.edge_x[k] > 0) | ((t.edge_x[k] == 0) & (t.edge_y[k] > 0));
    t.edge[k] = t.edge_x[k] * (centre_x - c.x[k]) + t.edge_y[k] * (centre_y - c.y[k]) + ~owned;
  }
}

void setUpDepth(TriangleBatch& t, const TriangleCorners& c) {
  const FloatLanes x1 = toFloat(c.x[1] - c.x[0]), y1 = toFloat(c.y[1] - c.y[0]), z1 = c.depth[1] - c.depth[0];
  const FloatLanes x2 = toFloat(c.x[2] - c.x[0]), y2 = toFloat(c.y[2] - c.y[0]), z2 = c.depth[2] - c.depth[0];
  t.depth = c.depth[0];
  t.depth_x = (z1 * y2 - z2 * y1) * t.inverse_area;
  t.depth_y = (z2 * x1 - z1 * x2) * t.inverse_area;
  t.depth_low = lowestOf(c.depth);
  t.depth_high = highestOf(c.depth);
}

}  // namespace

std::uint32_t setUp(TriangleBatch& batch, TriangleCorners corners, bool two_sided, int width, int height) {
  IntLanes area = doubleArea(corners);
  if (two_sided) {
    const IntLanes is_back = area < 0;
    swapWhere(is_back, corners.x[1], corners.x[2]);
    swapWhere(is_back, corners.y[1], corners.y[2]);
    swapWhere(is_back, corners.depth[1], corners.depth[2]);
    area = select(is_back, -area, area);
  }
  TriangleBatch& t = batch;
  t.first_x = firstSample(corners.x);
  t.first_y = firstSample(corners.y);
  t.last_x = lastSample(corners.x, width);
  t.last_y = lastSample(corners.y, height);
  const std::uint32_t accepted = maskBits((area > 0) & (t.first_x <= t.last_x) & (t.first_y <= t.last_y));
  if (accepted == 0) return 0;
  const IntLanes centre_x = t.first_x * kSubsamples + kHalfSample;
  const IntLanes centre_y = t.first_y * kSubsamples + kHalfSample;
  t.offset_x = toFloat(centre_x - corners.x[0]);
  t.offset_y = toFloat(centre_y - corners.y[0]);
  t.inverse_area = 1.f / toFloat(area);
  setUpEdges(t, corners, centre_x, centre_y);
  setUpDepth(t, corners);
  return accepted;
}

}  // namespace early_fusion::render
