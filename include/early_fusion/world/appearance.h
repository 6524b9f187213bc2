#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace early_fusion::world {

/// Towards the shipped world's light, unit length, world frame: up, to the left (+y) and in front of the counter (-x),
/// so that shadows fall away from the camera, to the right.
inline constexpr std::array<float, 3> kTowardsLight = {-0.400964f, 0.360867f, 0.842023f};

/// A factor for each of red, green and blue.
using ColorFactors = std::array<float, 3>;

/// How a part of the kitchen looks.
struct SurfaceLook {
  int texture = -1;         ///< a procedural texture, in [0, kProceduralTextures); -1: the part's own
  float texture_scale = 1;  ///< texture repetitions where the part's own texture has one
  ColorFactors color = {1, 1, 1};
};

inline constexpr int kProceduralTextures = 32;

inline constexpr int kMaxDistractors = 16;  ///< in an episode

/// A box or an upright cylinder on the counter that is no object: no policy knows it, and no action takes it away.
struct Distractor {
  bool is_round = false;
  double x = 0, y = 0;           ///< [m], world frame
  double theta = 0;              ///< [rad] about the world's z
  std::array<double, 3> size{};  ///< [m]: along its own x, y and z
  SurfaceLook look;              ///< its texture must be a procedural one
};

/// What the camera's sensor does to a frame, in this order.
struct SensorLook {
  float blur_px = 0;              ///< standard deviation of the blur [px]
  ColorFactors gain = {1, 1, 1};  ///< exposure and white balance
  float gamma = 1;                ///< exponent on values in [0, 1]
  float noise = 0;                ///< standard deviation of each value's noise [grey levels]
  int jpeg_quality = 0;           ///< [1, 100]; 0: not compressed

  bool isPlain() const {
    return blur_px == 0 && gain == ColorFactors{1, 1, 1} && gamma == 1 && noise == 0 && jpeg_quality == 0;
  }
};

/// How the world looks in an episode. The default is the world file's look. Nothing here moves an object or the
/// camera's axis, so labels stay what they are.
struct Appearance {
  std::array<float, 3> towards_light = kTowardsLight;  ///< unit length, world frame; its z is positive
  ColorFactors direct_light = {1, 1, 1};
  ColorFactors ambient_light = {1, 1, 1};
  std::vector<SurfaceLook> kitchen;         ///< for each part of World::kitchen's meshes, in their order; or empty
  std::vector<ColorFactors> object_colors;  ///< for each item; or empty
  std::vector<Distractor> distractors;
  double camera_roll_rad = 0;  ///< about the optical axis, clockwise as the camera looks
  double focal_factor = 1;     ///< on the focal length of the world's field of view
  SensorLook sensor;
  std::uint64_t noise_seed = 0;  ///< with the scene and the camera, it determines the noise
};

}  // namespace early_fusion::world
