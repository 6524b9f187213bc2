#include "make_meshes/kitchen_textures.h"

#include <algorithm>
#include <cmath>

#include "make_meshes/noise.h"

namespace early_fusion::make_meshes {
namespace {

constexpr int kSize = 256;  // [px]

// Distance from `value` to the nearest multiple of 1, in [0, 0.5].
double toNearestLine(double value) { return std::abs(value - std::round(value)); }

}  // namespace

cv::Mat floorPlanks() {
  Canvas canvas(kSize, {0, 0, 0});
  canvas.whole().paint([](double x, double y, const Colour&) {
    constexpr int kPlanks = 8;
    const int plank = static_cast<int>(y * kPlanks);
    const double grain = fractalNoise(x, y, 3, 64, 100 + plank);
    Colour colour = mix({132, 94, 62}, {166, 124, 86}, grain);
    colour = mix(colour, {110, 78, 52}, 0.5 * hashNoise(plank, 0, 101));
    const double end = x - hashNoise(plank, 1, 102);
    const bool joint = toNearestLine(y * kPlanks) < 0.035 || toNearestLine(end) < 0.004;
    return joint ? Colour{78, 54, 36} : colour;
  });
  return canvas.finish();
}

cv::Mat wallPlaster() {
  Canvas canvas(kSize, {214, 206, 190});
  canvas.whole().mottle(6, 0.05, 111);
  return canvas.finish();
}

cv::Mat ceilingPaint() {
  Canvas canvas(kSize, {232, 230, 224});
  canvas.whole().mottle(4, 0.03, 121);
  return canvas.finish();
}

cv::Mat counterStone() {
  Canvas canvas(kSize, {0, 0, 0});
  canvas.whole().paint([](double x, double y, const Colour&) {
    const double cloud = fractalNoise(x, y, 4, 4, 131);
    const double grain = smoothNoise(x * 128, y * 128, 128, 128, 132);
    Colour colour = mix({52, 58, 62}, {74, 80, 82}, cloud);
    if (grain > 0.86) colour = mix(colour, {118, 122, 120}, 0.7);
    if (grain < 0.12) colour = mix(colour, {32, 36, 40}, 0.7);
    return colour;
  });
  return canvas.finish();
}

cv::Mat splashTiles() {
  Canvas canvas(kSize, {0, 0, 0});
  canvas.whole().paint([](double x, double y, const Colour&) {
    constexpr int kRows = 8, kColumns = 4;
    const double row = y * kRows;
    // Every other course is shifted by half a tile.
    const double column = x * kColumns + (static_cast<int>(row) % 2 == 0 ? 0.0 : 0.5);
    const double shade = hashNoise(static_cast<int>(column) % kColumns, static_cast<int>(row), 141);
    const bool grout = toNearestLine(row) < 0.06 || toNearestLine(column) < 0.03;
    return grout ? Colour{206, 208, 202} : mix({150, 176, 168}, {172, 196, 188}, shade);
  });
  return canvas.finish();
}

cv::Mat cabinetPaint(const Colour& paint) {
  const Colour shadow = mix(paint, {0, 0, 0}, 0.35), light = mix(paint, {255, 255, 255}, 0.3);
  Canvas canvas(kSize, paint);
  Panel door = canvas.panel(kDoor);
  door.fill(shadow);
  door.rectangle(0.02, 0.015, 0.98, 0.985, paint);
  // A sunk panel: its upper and left edges lie in the shade.
  door.rectangle(0.14, 0.11, 0.86, 0.89, shadow);
  door.polygon({{0.86, 0.11}, {0.86, 0.89}, {0.14, 0.89}, {0.16, 0.875}, {0.845, 0.875}, {0.845, 0.12}}, light);
  door.rectangle(0.165, 0.13, 0.84, 0.872, paint);
  canvas.panel(kSteel).verticalGradient({206, 206, 208}, {150, 150, 154});
  return canvas.finish();
}

cv::Mat windowView() {
  const Colour wood{238, 236, 228};
  Canvas canvas(kSize, wood);
  Panel view = canvas.panel(kView);
  view.paint([](double x, double y, const Colour&) {
    const double cloud = std::clamp(2.5 * fractalNoise(x, y, 3, 5, 151) - 1.0, 0.0, 1.0);
    const Colour sky = mix(mix({120, 176, 226}, {196, 220, 236}, y), {248, 250, 252}, 0.8 * cloud);
    // A hedge far off along the lower edge.
    const double hedge = 0.80 + 0.06 * fractalNoise(x, 0.5, 6, 2, 152);
    return y < hedge ? sky : mix({92, 120, 84}, {122, 146, 104}, fractalNoise(x, y, 24, 24, 153));
  });
  view.rectangle(0.485, 0, 0.515, 1, wood);
  return canvas.finish();
}

}  // namespace early_fusion::make_meshes
