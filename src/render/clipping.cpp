#include "clipping.h"

#include <cmath>

namespace early_fusion::render {

namespace {

constexpr int kPlanes = 5;

/// Zero on the plane, positive on the side that is kept.
float distance(const ClipVertex& vertex, int plane) {
  const auto& v = vertex.value;
  switch (plane) {
    case 0:
      return v[ClipVertex::kW] - kNearPlane;
    case 1:
      return kGuardBand * v[ClipVertex::kW] - v[ClipVertex::kX];
    case 2:
      return kGuardBand * v[ClipVertex::kW] + v[ClipVertex::kX];
    case 3:
      return kGuardBand * v[ClipVertex::kW] - v[ClipVertex::kY];
    default:
      return kGuardBand * v[ClipVertex::kW] + v[ClipVertex::kY];
  }
}

/// Always computed from the inside to the outside, for both orders of the corners. So there is no gap between
/// neighbouring triangles.
ClipVertex crossing(const ClipVertex& inside, const ClipVertex& outside, float inside_distance,
                    float outside_distance) {
  const float t = inside_distance / (inside_distance - outside_distance);
  ClipVertex result;
  for (int i = 0; i < ClipVertex::kCount; ++i) {
    result.value[i] = inside.value[i] + t * (outside.value[i] - inside.value[i]);
  }
  return result;
}

}  // namespace

bool isSafe(float x, float y, float w) {
  return w >= kNearPlane && std::fabs(x) <= kGuardBand * w && std::fabs(y) <= kGuardBand * w;
}

int clipPolygon(ClipPolygon& polygon, int count) {
  for (int plane = 0; plane < kPlanes && count > 0; ++plane) {
    const ClipPolygon from = polygon;
    int kept = 0;
    for (int i = 0; i < count; ++i) {
      const ClipVertex& a = from[i];
      const ClipVertex& b = from[(i + 1) % count];
      const float distance_a = distance(a, plane), distance_b = distance(b, plane);
      if (distance_a >= 0.f) polygon[kept++] = a;
      if (distance_a >= 0.f && distance_b < 0.f) polygon[kept++] = crossing(a, b, distance_a, distance_b);
      if (distance_a < 0.f && distance_b >= 0.f) polygon[kept++] = crossing(b, a, distance_b, distance_a);
    }
    count = kept;
  }
  return count >= 3 ? count : 0;
}

}  // namespace early_fusion::render
