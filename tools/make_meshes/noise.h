#pragma once

#include <cstdint>

namespace early_fusion::make_meshes {

/// A number in [0, 1) that is the same for the same arguments everywhere.
double hashNoise(int x, int y, std::uint32_t seed);

/// Smooth noise in [0, 1]: hashNoise on a lattice of unit cells, blended between.
///
/// @param x, y position [cells]. @param period_x, period_y the noise repeats after so many cells, for seamless tiling.
double smoothNoise(double x, double y, int period_x, int period_y, std::uint32_t seed);

/// Four octaves of smoothNoise in [0, 1], `x` and `y` in [0, 1] being one period with `cells_x` x `cells_y` coarse
/// cells.
double fractalNoise(double x, double y, int cells_x, int cells_y, std::uint32_t seed);

}  // namespace early_fusion::make_meshes
