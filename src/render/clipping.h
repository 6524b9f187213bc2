#pragma once

#include <array>

#include "projection.h"

namespace early_fusion::render {

/// A vertex before the division by w, with everything that is linear over its triangle there.
struct ClipVertex {
  enum { kX, kY, kW, kDepth, kU, kV, kNormalX, kNormalY, kNormalZ, kCount };
  std::array<float, kCount> value;
};

/// A triangle and the five half-spaces: each adds one corner at most.
using ClipPolygon = std::array<ClipVertex, 8>;

/// True when the vertex can be projected as it is: beyond the near plane and within the guard band.
bool isSafe(float x, float y, float w);

/// Cuts a convex polygon of `count` corners to the near plane and the guard band, in place (Sutherland and Hodgman
/// 1974). Two triangles that share an edge get the same new corners on it, to the bit.
/// @return the corners that are left, 0 or at least 3.
int clipPolygon(ClipPolygon& polygon, int count);

}  // namespace early_fusion::render
