#pragma once

#include <array>

#include "projection.h"

namespace early_fusion::render {

/// A vertex before the division by w, with all values that are linear over its triangle in this space.
struct ClipVertex {
  enum { kX, kY, kW, kDepth, kU, kV, kNormalX, kNormalY, kNormalZ, kCount };
  std::array<float, kCount> value;
};

/// The maximum number of corners: three, and at most one more for each of the five half-spaces.
using ClipPolygon = std::array<ClipVertex, 8>;

/// True if the vertex needs no clipping: it is beyond the near plane and within the guard band.
bool isSafe(float x, float y, float w);

/// Clips a convex polygon of `count` corners to the near plane and the guard band, in place (Sutherland and Hodgman
/// 1974). Two triangles that share an edge get the same new corners on it, bit for bit.
/// @return the number of remaining corners, 0 or at least 3.
int clipPolygon(ClipPolygon& polygon, int count);

}  // namespace early_fusion::render
