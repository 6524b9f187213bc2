#include <cmath>

#include "make_meshes/curve.h"
#include "make_meshes/drawing.h"
#include "make_meshes/finish_object.h"
#include "make_meshes/loft.h"
#include "make_meshes/objects.h"

namespace early_fusion::make_meshes {
namespace {

using Profile = std::vector<Eigen::Vector2d>;

constexpr Cell kOutside{0, 0, 256, 112};
constexpr Cell kInside{0, 112, 144, 144};
constexpr Cell kUnderside{144, 112, 112, 72};
constexpr Cell kHandle{144, 184, 112, 72};

// The handle of a mug of radius `r`: its ends lie inside the wall.
Mesh mugHandle(double r, const UvRect& uv) {
  const std::vector<Eigen::Vector3d> spine = smoothCurve<3>({{0, r - 0.002, 0.020},
                                                             {0, r + 0.016, 0.022},
                                                             {0, r + 0.028, 0.036},
                                                             {0, r + 0.028, 0.058},
                                                             {0, r + 0.016, 0.072},
                                                             {0, r - 0.002, 0.074}},
                                                            3);
  return sweep(spine, Eigen::Vector3d::UnitX(), std::vector<Eigen::Vector2d>(spine.size(), {0.0065, 0.0045}), 10, uv);
}

}  // namespace

Model mug() {
  const Colour violet{112, 44, 168}, cream{236, 226, 240};
  Canvas canvas(kObjectTextureSize, violet);
  Panel outside = canvas.panel(kOutside);
  outside.rectangle(0, 0, 1, 0.07, cream);
  Panel inside = canvas.panel(kInside);
  inside.fill(cream);
  inside.ellipse(0.5, 0.5, 0.45, 0.45, {200, 186, 210});
  canvas.panel(kUnderside).fill({90, 34, 140});
  const double r = 0.042, h = 0.092, wall = 0.004;
  const int segments = 28;
  Mesh mesh = revolve({{0, 0}, {r - 0.006, 0}}, segments, kUnderside.uv(), Wrap::kFlat);
  append(
      mesh,
      revolve(
          {{r - 0.006, 0}, {r - 0.001, 0.003}, {r, 0.012}, {r, 0.035}, {r, 0.062}, {r, h - 0.001}, {r - wall / 2, h}},
          segments, kOutside.uv()));
  append(mesh, revolve({{r - wall / 2, h},
                        {r - wall, h - 0.002},
                        {r - wall, 0.04},
                        {r - wall, 0.014},
                        {r - 0.012, 0.008},
                        {0, 0.006}},
                       segments, kInside.uv(), Wrap::kFlat));
  append(mesh, mugHandle(r, kHandle.uv()));
  return finishObject("mug", mesh, canvas, 0.35);
}

Model bowl() {
  const Colour teal{0, 150, 160}, pale{120, 222, 220}, white{240, 250, 248};
  Canvas canvas(kObjectTextureSize, teal);
  Panel outside = canvas.panel(kOutside);
  outside.verticalGradient({10, 170, 178}, {0, 120, 132});
  outside.rectangle(0, 0, 1, 0.12, white);
  Panel inside = canvas.panel(kInside);
  inside.fill(pale);
  inside.ellipse(0.5, 0.5, 0.25, 0.25, {90, 204, 204});
  canvas.panel(kUnderside).fill({0, 110, 120});
  const int segments = 32;
  const Profile outer = smoothCurve<2>({{0.034, 0.004}, {0.058, 0.014}, {0.074, 0.034}, {0.080, 0.060}}, 2);
  const Profile inner = smoothCurve<2>({{0.077, 0.060}, {0.070, 0.034}, {0.054, 0.018}, {0.030, 0.009}, {0, 0.008}}, 2);
  Mesh mesh = revolve({{0, 0}, {0.033, 0}}, segments, kUnderside.uv(), Wrap::kFlat);
  Profile wall{{0.033, 0}};
  wall.insert(wall.end(), outer.begin(), outer.end());
  wall.push_back({0.0785, 0.0615});
  append(mesh, revolve(wall, segments, kOutside.uv()));
  Profile hollow{{0.0785, 0.0615}};
  hollow.insert(hollow.end(), inner.begin(), inner.end());
  append(mesh, revolve(hollow, segments, kInside.uv(), Wrap::kFlat));
  return finishObject("bowl", mesh, canvas, 0.35);
}

Model plate() {
  const Colour white{226, 224, 216}, navy{28, 44, 110}, shade{204, 200, 190};
  const Cell face{0, 0, 176, 176}, underside{176, 0, 80, 80};
  Canvas canvas(kObjectTextureSize, shade);
  Panel top = canvas.panel(face);
  top.fill(white);
  // Rings from the rim inwards.
  const std::pair<double, Colour> rings[] = {{0.49, navy}, {0.42, white}, {0.34, shade}, {0.32, white}};
  for (const auto& [radius, colour] : rings) top.ellipse(0.5, 0.5, radius, radius, colour);
  const int segments = 36;
  Mesh mesh = revolve({{0, 0}, {0.045, 0}, {0.075, 0}, {0.084, 0.003}, {0.110, 0.014}, {0.129, 0.021}, {0.130, 0.0225}},
                      segments, underside.uv(), Wrap::kFlat);
  append(
      mesh,
      revolve(
          {{0.130, 0.0225}, {0.128, 0.024}, {0.108, 0.018}, {0.088, 0.008}, {0.076, 0.005}, {0.040, 0.005}, {0, 0.005}},
          segments, face.uv(), Wrap::kFlat));
  return finishObject("plate", mesh, canvas, 0.3);
}

namespace {

// Foot, stem and bowl up to the rim, seen from outside.
Profile wineGlassOutside() {
  const Profile stem =
      smoothCurve<2>({{0.034, 0.002}, {0.018, 0.006}, {0.006, 0.014}, {0.0042, 0.035}, {0.0042, 0.075}}, 2);
  const Profile cup =
      smoothCurve<2>({{0.006, 0.086}, {0.024, 0.098}, {0.038, 0.125}, {0.040, 0.155}, {0.033, 0.200}}, 2);
  Profile outside{{0.034, 0}};
  outside.insert(outside.end(), stem.begin(), stem.end());
  outside.insert(outside.end(), cup.begin(), cup.end());
  return outside;
}

}  // namespace

Model wineGlass() {
  const Colour tint{206, 224, 232}, wine{132, 20, 52}, light{244, 250, 252};
  const Cell outside{0, 0, 176, 256}, inside{176, 0, 80, 96}, wine_cell{176, 96, 80, 80}, underside{176, 176, 80, 80};
  Canvas canvas(kObjectTextureSize, tint);
  Panel glass = canvas.panel(outside);
  // Up to the wine's level the cup shows the wine through pale glass.
  glass.rectangle(0, 0.22, 1, 0.40, mix(tint, wine, 0.8));
  for (const double x : {0.2, 0.7}) glass.rectangle(x, 0.02, x + 0.05, 0.36, light);
  canvas.panel(wine_cell).fill(wine);
  canvas.panel(inside).fill(mix(tint, {150, 170, 180}, 0.5));
  const int segments = 22;
  const Profile wall = wineGlassOutside();
  const double level = 0.150;
  Mesh mesh = revolve({{0, 0}, wall.front()}, segments, underside.uv(), Wrap::kFlat);
  append(mesh, revolve(wall, segments, outside.uv()));
  append(mesh, revolve({wall.back(), {0.0315, 0.200}, {0.0355, 0.175}, {0.0375, level}}, segments, inside.uv()));
  append(mesh, revolve({{0.0375, level}, {0.02, level}, {0, level}}, segments, wine_cell.uv(), Wrap::kFlat));
  return finishObject("wine_glass", mesh, canvas, 0.4);
}

}  // namespace early_fusion::make_meshes
