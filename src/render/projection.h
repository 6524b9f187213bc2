#pragma once

#include "render_assets.h"

namespace early_fusion::render {

/// Screen coordinates are whole sixteenths of a sample (subsamples), so that edge tests are exact. y points down.
inline constexpr int kSubsampleBits = 4;
inline constexpr int kSubsamples = 1 << kSubsampleBits;

/// Triangles are clipped to this distance [subsamples] from the middle of the screen. (2 * kGuardBand)^2 is below 2^31.
inline constexpr float kGuardBand = 16000.f;

/// The largest screen that lies within the guard band [samples].
inline constexpr int kMaxScreenSize = 2 * static_cast<int>(kGuardBand) / kSubsamples - 16;

/// The near plane's distance [m]. Nothing nearer to the camera is drawn.
inline constexpr float kNearPlane = 0.02f;

/// A linear function of a point: factor . point + constant.
struct LinearForm {
  float factor[3];
  float constant;
};

LinearForm operator+(const LinearForm& a, const LinearForm& b);
LinearForm operator*(float scale, const LinearForm& a);

/// The projection of points to a screen: (x / w, y / w) from its middle [subsamples]. With perspective, w is the depth
/// along the axis [m] and the depth buffer has 1 / w. Without perspective, w is 1 and the depth buffer has `depth`.
/// Larger values are nearer.
struct Projection {
  bool perspective = true;
  LinearForm x, y, w, depth;
  float half_width = 0;   ///< of the screen [subsamples]
  float half_height = 0;  ///< of the screen [subsamples]

  /// The same projection for points of a mesh with this pose.
  Projection after(const RenderPose& pose) const;
};

enum class Visibility {
  kOutside,   ///< nothing is visible
  kSafe,      ///< every vertex is beyond the near plane and within the guard band
  kNeedsClip  ///< a vertex may be outside
};

/// Classifies a box in the frame of the projected points. In doubt, the result is kNeedsClip.
Visibility visibility(const Projection& projection, const RenderMesh& mesh);

}  // namespace early_fusion::render
