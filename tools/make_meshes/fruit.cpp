#include <algorithm>
#include <cmath>

#include "make_meshes/curve.h"
#include "make_meshes/drawing.h"
#include "make_meshes/finish_object.h"
#include "make_meshes/loft.h"
#include "make_meshes/noise.h"
#include "make_meshes/objects.h"

namespace early_fusion::make_meshes {
namespace {

constexpr Cell kSkin{0, 0, 256, 224};
constexpr Cell kStalk{0, 224, 128, 32};
constexpr Cell kLeaf{128, 224, 128, 32};

// 0 below `from`, 1 above `to`, smooth between.
double ramp(double from, double to, double value) {
  const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// How far apart two directions around a fruit are, in turns: 0 to 0.5.
double turnsBetween(double a, double b) {
  const double turns = std::abs(a - b);
  return std::min(turns, 1 - turns);
}

// Presses a seam, as of a peach, into the side that faces +x.
void pressSeam(Mesh& mesh, double depth, double width_rad) {
  for (Triangle& triangle : mesh) {
    for (Corner& corner : triangle) {
      const double angle = std::atan2(corner.position.y(), corner.position.x());
      const double pressed = 1 - depth * std::exp(-angle * angle / (width_rad * width_rad));
      corner.position.x() *= pressed;
      corner.position.y() *= pressed;
    }
  }
}

}  // namespace

Model banana() {
  Canvas canvas(kObjectTextureSize, {244, 206, 40});
  canvas.panel(kSkin).paint([](double x, double y, const Colour&) {
    // Bottom is the stalk, top the blossom end; the skin lightens along its ridges.
    Colour colour = mix({250, 214, 44}, {226, 178, 24}, 0.5 + 0.5 * std::cos(2 * M_PI * 5 * x));
    colour = mix(colour, {168, 190, 60}, 0.8 * ramp(0.80, 0.92, y));
    const double blotch = fractalNoise(x, y, 6, 12, 21);
    colour = mix(colour, {120, 70, 20}, 0.75 * ramp(0.64, 0.70, blotch));
    colour = mix(colour, {70, 44, 18}, ramp(0.93, 0.955, y));
    return mix(colour, {56, 36, 16}, ramp(0.075, 0.05, y));
  });
  std::vector<Eigen::Vector3d> spine;
  std::vector<Eigen::Vector2d> radii;
  const int pieces = 24;
  for (int i = 0; i <= pieces; ++i) {
    const double s = static_cast<double>(i) / pieces;
    const double angle = (s - 0.5) * 2.1;
    const double bend = 0.098;
    spine.emplace_back(bend * std::cos(angle), bend * std::sin(angle), 0);
    // Full in the middle, a thin stalk at one end, a blunt tip at the other.
    const double belly = 0.0185 * std::pow(std::sin(M_PI * std::clamp(0.06 + 0.90 * s, 0.0, 1.0)), 0.55);
    const double radius = std::max(belly * ramp(0.02, 0.2, s) * ramp(1.03, 0.9, s), s < 0.5 ? 0.0058 : 0.0048);
    radii.emplace_back(radius, radius);
  }
  Mesh mesh = sweep(spine, Eigen::Vector3d::UnitZ(), radii, 14, kSkin.uv());
  return finishObject("banana", mesh, canvas, 0.08, 70);
}

Model peach() {
  Canvas canvas(kObjectTextureSize, {246, 166, 90});
  canvas.panel(kSkin).paint([](double x, double y, const Colour&) {
    const double noise = fractalNoise(x, y, 5, 5, 31);
    const double blush = ramp(0.42, 0.10, turnsBetween(x, 0.3) + 0.3 * (noise - 0.5));
    Colour colour = mix({252, 184, 96}, {236, 96, 84}, 0.85 * blush);
    colour = mix(colour, {255, 206, 120}, 0.7 * ramp(0.14, 0.04, y));
    return mix(colour, {196, 70, 60}, 0.5 * ramp(0.025, 0.005, turnsBetween(x, 0)));
  });
  canvas.panel(kStalk).fill({92, 62, 30});
  const std::vector<Eigen::Vector2d> profile = smoothCurve<2>({{0, 0.001},
                                                               {0.014, 0.001},
                                                               {0.029, 0.014},
                                                               {0.034, 0.034},
                                                               {0.028, 0.055},
                                                               {0.014, 0.064},
                                                               {0.005, 0.061},
                                                               {0, 0.057}},
                                                              2);
  Mesh mesh = revolve(profile, 26, kSkin.uv());
  pressSeam(mesh, 0.12, 0.22);
  return finishObject("peach", mesh, canvas, 0.02, 70);
}

namespace {

Colour appleSkin(double x, double y) {
  // Streaks run from pole to pole; one cheek and the stalk's hollow stay green.
  const double streak = smoothNoise(x * 40, y * 3, 40, 3, 41);
  const double cheek = ramp(0.17, 0.06, turnsBetween(x, 0.62)) * ramp(0.9, 0.55, y);
  const double green = std::clamp(cheek + ramp(0.20, 0.1, y), 0.0, 1.0);
  const Colour red = mix({176, 12, 24}, {206, 34, 36}, streak);
  return mix(red, {136, 182, 40}, green * (0.7 + 0.3 * streak));
}

Mesh appleLeaf() {
  const std::vector<Eigen::Vector3d> spine =
      smoothCurve<3>({{0.002, 0, 0.078}, {0.014, 0, 0.086}, {0.028, 0, 0.088}, {0.040, 0, 0.082}}, 2);
  std::vector<Eigen::Vector2d> radii;
  for (std::size_t i = 0; i < spine.size(); ++i) {
    const double s = static_cast<double>(i) / (spine.size() - 1);
    radii.emplace_back(0.0012 + 0.010 * std::sin(M_PI * s), 0.0008);
  }
  return sweep(spine, Eigen::Vector3d::UnitY(), radii, 8, kLeaf.uv());
}

}  // namespace

Model apple() {
  Canvas canvas(kObjectTextureSize, {176, 16, 26});
  canvas.panel(kSkin).paint([](double x, double y, const Colour&) { return appleSkin(x, y); });
  canvas.panel(kStalk).fill({84, 56, 28});
  canvas.panel(kLeaf).fill({54, 140, 36});
  const std::vector<Eigen::Vector2d> profile = smoothCurve<2>({{0, 0.005},
                                                               {0.008, 0.002},
                                                               {0.017, 0.001},
                                                               {0.030, 0.015},
                                                               {0.0385, 0.042},
                                                               {0.034, 0.062},
                                                               {0.020, 0.071},
                                                               {0.008, 0.066},
                                                               {0, 0.058}},
                                                              2);
  Mesh mesh = revolve(profile, 26, kSkin.uv());
  append(mesh, sweep(smoothCurve<3>({{0, 0, 0.055}, {0.001, 0, 0.070}, {0.004, 0, 0.086}}, 2), Eigen::Vector3d::UnitY(),
                     std::vector<Eigen::Vector2d>(5, {0.0017, 0.0017}), 6, kStalk.uv()));
  append(mesh, appleLeaf());
  return finishObject("apple", mesh, canvas, 0.3, 70);
}

}  // namespace early_fusion::make_meshes
