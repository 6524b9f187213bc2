#pragma once

#include <opencv2/core.hpp>

#include "make_meshes/drawing.h"

namespace early_fusion::make_meshes {

// Textures that repeat without a seam.
cv::Mat floorPlanks();
cv::Mat wallPlaster();
cv::Mat ceilingPaint();
cv::Mat counterStone();
cv::Mat splashTiles();

/// A painted cabinet; its parts are at kDoor, kPaint and kSteel.
cv::Mat cabinetPaint(const Colour& paint);
inline constexpr Cell kDoor{0, 0, 192, 256};
inline constexpr Cell kPaint{192, 0, 64, 192};
inline constexpr Cell kSteel{192, 192, 64, 64};

/// A window with a view of the sky at kView and white wood at kFrame.
cv::Mat windowView();
inline constexpr Cell kView{0, 0, 256, 208};
inline constexpr Cell kFrame{0, 208, 256, 48};

}  // namespace early_fusion::make_meshes
