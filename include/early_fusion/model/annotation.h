#pragma once

#include <string>
#include <vector>

#include "early_fusion/core/image.h"

namespace early_fusion::model {

/// A rectangle in pixels of the frame. It may reach beyond the frame.
struct Box {
  int left = 0, top = 0, right = 0, bottom = 0;
};

/// What is drawn on a frame for a person to see.
struct Annotation {
  double cone_radius_px =
      0;  ///< radius of the circle in which COLLECT and REMOVE act, in pixels of the frame; 0: no circle
  std::vector<std::string> request;  ///< item names, one a line
  std::vector<Box> boxes;            ///< frames around objects
  std::string action;                ///< empty: none
  std::string note;                  ///< bottom line, such as the expert's action; empty: none
};

/// The radius in the frame [px] of a cone about the optical axis.
double coneRadiusPx(double cone_half_angle_rad, double horizontal_fov_rad, int image_size);

/// The frame enlarged `scale` times, with the circle, the request and the action drawn on it.
core::Image annotate(const core::Image& image, const Annotation& annotation, int scale);

}  // namespace early_fusion::model
