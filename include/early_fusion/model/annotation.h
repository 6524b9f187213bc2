#pragma once

#include <string>
#include <vector>

#include "early_fusion/core/image.h"

namespace early_fusion::model {

/// What a person wants to see of one step of a policy.
struct Annotation {
  double cone_radius_px =
      0;  ///< of the circle within which COLLECT and REMOVE act, in pixels of the plain image; 0: not shown
  std::vector<std::string> request;  ///< item names, a line each
  std::string action;                ///< empty: not shown
  std::string note;                  ///< bottom line, such as the expert's action; empty: not shown
};

/// Radius in the image of a cone about the optical axis. All in radians and pixels.
double coneRadiusPx(double cone_half_angle_rad, double horizontal_fov_rad, int image_size);

/// The image enlarged `scale` times, with a crosshair circle, the request and the action drawn on it.
core::Image annotate(const core::Image& image, const Annotation& annotation, int scale);

}  // namespace early_fusion::model
