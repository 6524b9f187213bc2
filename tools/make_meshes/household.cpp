#include <cmath>

#include "make_meshes/drawing.h"
#include "make_meshes/finish_object.h"
#include "make_meshes/noise.h"
#include "make_meshes/objects.h"
#include "make_meshes/rounded_box.h"

namespace early_fusion::make_meshes {
namespace {

constexpr Cell kFoamSide{0, 0, 256, 64};
constexpr Cell kScourer{0, 64, 128, 192};
constexpr Cell kFoam{128, 64, 128, 192};

void drawPores(Panel& panel, int count, double size, double aspect, unsigned seed) {
  for (int i = 0; i < count; ++i) {
    const double radius = size * (0.4 + hashNoise(i, 2, seed));
    panel.ellipse(hashNoise(i, 0, seed), hashNoise(i, 1, seed), radius, radius * aspect, {214, 158, 10});
  }
}

}  // namespace

Model sponge() {
  const Colour foam{252, 214, 36}, green{30, 128, 52};
  Canvas canvas(kObjectTextureSize, foam);
  Panel side = canvas.panel(kFoamSide);
  side.fill(foam);
  drawPores(side, 90, 0.010, 4, 51);
  side.rectangle(0, 0, 1, 0.36, green);
  Panel top = canvas.panel(kScourer);
  top.paint([&](double x, double y, const Colour&) {
    return mix({22, 104, 42}, {44, 150, 66}, fractalNoise(x, y, 24, 36, 52));
  });
  Panel bottom = canvas.panel(kFoam);
  bottom.fill(foam);
  drawPores(bottom, 120, 0.022, 0.66, 53);
  const UvRect side_uv = kFoamSide.uv();
  const BoxFaces faces{side_uv, side_uv, side_uv, side_uv, kScourer.uv(), kFoam.uv()};
  return finishObject("sponge", roundedBox({0.076, 0.116, 0.040}, 0.005, faces, 6, 2), canvas, 0.0, 50);
}

Model rubiksCube() {
  const Colour black{18, 18, 20};
  const Colour stickers[] = {{206, 22, 30}, {255, 108, 0}, {0, 70, 190}, {0, 150, 66}, {245, 245, 245}, {255, 218, 0}};
  const auto face_cell = [](int face) { return Cell{(face % 3) * 85, (face / 3) * 128, 85, 128}; };
  Canvas canvas(kObjectTextureSize, black);
  for (int face = 0; face < 6; ++face) {
    Panel panel = canvas.panel(face_cell(face));
    for (int i = 0; i < 9; ++i) {
      const double left = 0.05 + 0.31 * (i % 3), top = 0.05 + 0.31 * (i / 3);
      panel.rectangle(left, top, left + 0.27, top + 0.27, stickers[face]);
    }
  }
  const BoxFaces faces{face_cell(0).uv(), face_cell(1).uv(), face_cell(2).uv(),
                       face_cell(3).uv(), face_cell(4).uv(), face_cell(5).uv()};
  return finishObject("rubiks_cube", roundedBox({0.058, 0.058, 0.058}, 0.003, faces), canvas, 0.15);
}

}  // namespace early_fusion::make_meshes
