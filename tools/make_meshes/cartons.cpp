#include <algorithm>
#include <array>
#include <cmath>

#include "make_meshes/drawing.h"
#include "make_meshes/finish_object.h"
#include "make_meshes/objects.h"
#include "make_meshes/rounded_box.h"

namespace early_fusion::make_meshes {
namespace {

// A printed carton's texture, each face in its proportions: the front also serves the back, one side the other.
struct CartonCells {
  Cell front, side, top, bottom;

  BoxFaces faces() const { return {front.uv(), front.uv(), side.uv(), side.uv(), top.uv(), bottom.uv()}; }
};

// @param size depth, width, height [m]
CartonCells cartonCells(const Eigen::Vector3d& size) {
  constexpr int kMargins = 2 * Cell::kMargin;
  const double scale = (Cell{}.width - 2 * kMargins) / (size.x() + std::max(size.y(), size.z()));
  const auto edge = [scale](double length) { return static_cast<int>(scale * length) + kMargins; };
  const int depth = edge(size.x()), width = edge(size.y()), height = edge(size.z());
  return {{0, 0, width, height}, {width, 0, depth, height}, {0, height, width, depth}, {width, height, depth, depth}};
}

// A golden square cracker with pricks.
void drawCracker(Panel& panel, double x, double y, double half_width, double half_height) {
  const Colour baked{226, 164, 72}, rim{188, 116, 40}, prick{140, 82, 30};
  panel.rectangle(x - half_width, y - half_height, x + half_width, y + half_height, rim);
  panel.rectangle(x - 0.9 * half_width, y - 0.9 * half_height, x + 0.9 * half_width, y + 0.9 * half_height, baked);
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      panel.ellipse(x + 0.5 * column * half_width, y + 0.5 * row * half_height, 0.08 * half_width, 0.08 * half_height,
                    prick);
    }
  }
}

}  // namespace

Model crackerBox() {
  const Eigen::Vector3d size(0.072, 0.164, 0.213);
  const CartonCells cells = cartonCells(size);
  const Colour red{198, 24, 30}, cream{250, 236, 200}, dark{110, 8, 14};
  Canvas canvas(kObjectTextureSize, red);
  Panel front = canvas.panel(cells.front);
  front.verticalGradient({214, 30, 34}, {170, 14, 22});
  front.polygon({{0, 0.12}, {1, 0.06}, {1, 0.34}, {0, 0.40}}, cream);
  front.text("CRACKERS", 0.06, 0.13, 0.94, 0.33, red);
  drawCracker(front, 0.34, 0.58, 0.22, 0.17);
  drawCracker(front, 0.68, 0.79, 0.22, 0.17);
  Panel side = canvas.panel(cells.side);
  side.verticalGradient({206, 28, 34}, {166, 14, 22});
  side.rectangle(0.14, 0.42, 0.86, 0.9, cream);
  side.smallPrint(0.2, 0.46, 0.8, 0.88, 9, dark);
  side.text("CRACKERS", 0.06, 0.1, 0.94, 0.3, cream);
  Panel top = canvas.panel(cells.top);
  top.fill(red);
  top.text("CRACKERS", 0.1, 0.2, 0.9, 0.8, cream);
  canvas.panel(cells.bottom).fill(dark);
  return finishObject("cracker_box", roundedBox(size, 0.003, cells.faces()), canvas, 0.05);
}

Model sugarBox() {
  const Eigen::Vector3d size(0.049, 0.094, 0.176);
  const CartonCells cells = cartonCells(size);
  const Colour yellow{250, 206, 20}, white{246, 246, 240}, blue{24, 60, 150};
  Canvas canvas(kObjectTextureSize, yellow);
  for (const Cell& cell : {cells.front, cells.side}) {
    Panel panel = canvas.panel(cell);
    panel.fill(yellow);
    panel.rectangle(0, 0.44, 1, 1, white);
    panel.rectangle(0, 0.40, 1, 0.66, blue);
    panel.text("SUGAR", 0.08, 0.43, 0.92, 0.63, white);
  }
  Panel front = canvas.panel(cells.front);
  front.ellipse(0.5, 0.2, 0.3, 0.13, white);
  front.text("PURE", 0.3, 0.13, 0.7, 0.27, blue);
  front.text("1 kg", 0.3, 0.76, 0.7, 0.92, blue);
  canvas.panel(cells.side).smallPrint(0.2, 0.72, 0.8, 0.94, 5, {120, 120, 130});
  canvas.panel(cells.bottom).fill(white);
  return finishObject("sugar_box", roundedBox(size, 0.002, cells.faces()), canvas, 0.05);
}

Model gelatinBox() {
  const Eigen::Vector3d size(0.030, 0.089, 0.075);
  const CartonCells cells = cartonCells(size);
  const Colour berry{206, 16, 84}, white{250, 244, 246}, dark{120, 6, 44};
  Canvas canvas(kObjectTextureSize, berry);
  Panel front = canvas.panel(cells.front);
  front.fill(berry);
  front.polygon({{0, 0.55}, {1, 0.35}, {1, 1}, {0, 1}}, white);
  front.text("GELATIN", 0.05, 0.1, 0.95, 0.36, white);
  // A turned-out jelly.
  front.polygon({{0.34, 0.6}, {0.66, 0.6}, {0.8, 0.9}, {0.2, 0.9}}, berry);
  front.ellipse(0.5, 0.6, 0.16, 0.04, {240, 90, 140});
  Panel side = canvas.panel(cells.side);
  side.fill(white);
  side.rectangle(0, 0, 1, 0.5, berry);
  side.smallPrint(0.15, 0.6, 0.85, 0.92, 6, dark);
  Panel top = canvas.panel(cells.top);
  top.fill(berry);
  top.rectangle(0, 0.3, 1, 0.7, white);
  top.text("GELATIN", 0.1, 0.34, 0.9, 0.66, berry);
  canvas.panel(cells.bottom).fill(white);
  return finishObject("gelatin_box", roundedBox(size, 0.002, cells.faces()), canvas, 0.05);
}

namespace {

constexpr Cell kWhite{0, 0, 64, 64};
constexpr Cell kPrintedSide{100, 0, 78, 184};
constexpr Cell kPlainSide{178, 0, 78, 184};
constexpr Cell kSlope{0, 184, 128, 72};
constexpr Cell kGable{128, 184, 128, 72};

// The printed sides of the milk carton: blue above a wave, white below.
void drawMilkSide(Panel panel, bool printed) {
  const Colour white{248, 249, 250}, blue{20, 92, 196}, sky{110, 180, 240};
  panel.fill(white);
  std::vector<Eigen::Vector2d> wave{{1, 0}, {0, 0}}, shade{{1, 0}, {0, 0}};
  for (int i = 0; i <= 24; ++i) {
    const double x = i / 24.0;
    wave.emplace_back(x, 0.24 + 0.05 * std::sin(2 * M_PI * x));
    shade.emplace_back(x, 0.30 + 0.05 * std::sin(2 * M_PI * x));
  }
  panel.polygon(shade, sky);
  panel.polygon(wave, blue);
  if (printed) {
    panel.text("MILK", 0.06, 0.42, 0.94, 0.66, blue);
    panel.smallPrint(0.2, 0.84, 0.8, 0.94, 3, sky);
  }
}

// The square body, the two slopes of the roof and the two gables folded in between them.
Mesh milkCartonBody(double half, double shoulder, double ridge) {
  const int pieces = 6;
  const std::array<Eigen::Vector3d, 4> foot{{{half, -half, 0}, {half, half, 0}, {-half, half, 0}, {-half, -half, 0}}};
  const Eigen::Vector3d up(0, 0, shoulder);
  // The gables lean inwards, so the ridge is shorter than the carton is wide.
  const Eigen::Vector3d ridge_end[] = {{0, -0.8 * half, ridge}, {0, 0.8 * half, ridge}};
  Mesh mesh;
  for (int side = 0; side < 4; ++side) {
    const Eigen::Vector3d& a = foot[side];
    const Eigen::Vector3d& b = foot[(side + 1) % 4];
    const bool slope = side % 2 == 0;
    addPatch(mesh, {a, b, b + up, a + up}, pieces, 8, (slope ? kPrintedSide : kPlainSide).uv());
    const Eigen::Vector3d& end_a = ridge_end[side == 0 || side == 3 ? 0 : 1];
    const Eigen::Vector3d& end_b = ridge_end[side == 0 || side == 1 ? 1 : 0];
    addPatch(mesh, {a + up, b + up, end_b, end_a}, pieces, 3, (slope ? kSlope : kGable).uv());
  }
  addPatch(mesh, {foot[0], foot[3], foot[2], foot[1]}, pieces, pieces, kWhite.uv());
  return mesh;
}

}  // namespace

Model milkCarton() {
  const Colour white{248, 249, 250}, blue{20, 92, 196};
  Canvas canvas(kObjectTextureSize, white);
  drawMilkSide(canvas.panel(kPrintedSide), true);
  drawMilkSide(canvas.panel(kPlainSide), false);
  canvas.panel(kSlope).fill(blue);
  canvas.panel(kGable).fill({14, 70, 160});
  const double half = 0.036, shoulder = 0.175, ridge = 0.215;
  Mesh mesh = milkCartonBody(half, shoulder, ridge);
  Mesh fin = plainBox({0.004, 2 * half, 0.022}, kWhite.uv());
  transform(fin, Eigen::Isometry3d(Eigen::Translation3d(0, 0, ridge + 0.006)));
  append(mesh, fin);
  return finishObject("milk_carton", mesh, canvas, 0.08, 20);
}

}  // namespace early_fusion::make_meshes
