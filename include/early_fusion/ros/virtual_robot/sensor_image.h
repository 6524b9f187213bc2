#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "early_fusion/core/image.h"
#include "early_fusion/core/options.h"
#include "early_fusion/core/random.h"

namespace early_fusion::nodes {

/// The virtual robot's random streams, besides those of core::RandomStream. The braces show the keys that follow.
enum VirtualRobotStream : std::uint64_t {
  kSensorStream = 101,  ///< {image}: noise
  kPickStream = 102,    ///< {pick}: whether it fails
  kTrackerStream = 103  ///< {sighting}: errors and dropouts of the objects' frames
};

/// What a real camera does to the image of a scene.
struct SensorOptions {
  std::string encoding = "bgr8";
  int row_padding = 0;  ///< [bytes]
  double blur_px = 0;   ///< standard deviation of a Gaussian
  double exposure = 1;  ///< gain
  double noise = 0;     ///< standard deviation [grey levels]

  core::OptionSet options();
};

/// An image as a camera's driver sends it.
struct SensorImage {
  int width = 0;
  int height = 0;
  std::string encoding;
  std::size_t step = 0;  ///< [bytes]
  std::vector<std::uint8_t> data;
};

/// Blurs, exposes, adds noise and encodes. The same random stream gives the same noise.
/// @param scene for yuv422 of an even width.
SensorImage sensorImage(const core::Image& scene, const SensorOptions& options, core::Random random);

}  // namespace early_fusion::nodes
