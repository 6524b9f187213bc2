#pragma once

#include <array>

#include "projection.h"
#include "vector_lanes.h"

namespace early_fusion::render {

/// kLanes triangles on a screen, ready to be filled. Coordinates are subsamples from the screen's top left corner.
struct TriangleBatch {
  IntLanes first_x, last_x, first_y, last_y;  ///< samples whose centres lie in the bounding box
  /// For each edge: its value at the centre of sample (first_x, first_y), and its slope per subsample. A sample is
  /// covered if all three values are >= 0 at its centre. If two triangles share an edge, one of them covers the samples
  /// on it.
  std::array<IntLanes, 3> edge, edge_x, edge_y;
  FloatLanes offset_x, offset_y;       ///< from the first corner to that sample's centre [subsamples]
  FloatLanes depth, depth_x, depth_y;  ///< at the first corner, and its slope per subsample
  FloatLanes depth_low, depth_high;    ///< of the corners: bounds the depth of slivers, whose slopes are inexact
  FloatLanes inverse_area;             ///< of twice the area [1 / subsamples^2]
};

/// The corners of kLanes triangles.
struct TriangleCorners {
  std::array<IntLanes, 3> x, y;  ///< [subsamples]
  std::array<FloatLanes, 3> depth;
};

/// Prepares the triangles that are clockwise on the screen (y points down) and, if `two_sided`, the others too.
/// @param width, height of the screen [samples]
/// @return bit i is set if triangle i must be filled: its front side is visible, and its bounding box has the centre of
/// a sample. The batch is undefined for the others.
std::uint32_t setUp(TriangleBatch& batch, TriangleCorners corners, bool two_sided, int width, int height);

}  // namespace early_fusion::render
