#include "make_meshes/kitchen.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "make_meshes/kitchen_textures.h"
#include "make_meshes/rounded_box.h"

namespace early_fusion::make_meshes {
namespace {

// [m]. The links' places in the room are in urdf/kitchen.urdf.
constexpr double kRoomDepth = 2.72;
constexpr double kRoomWidth = 5.0;
constexpr double kRoomHeight = 2.5;
constexpr double kCounterDepth = 0.75;
constexpr double kCounterWidth = 3.2;
constexpr double kCounterThickness = 0.04;
constexpr double kSplashHeight = 0.46;
// Large faces are divided, because a large triangle with a corner far out of view needs clipping.
constexpr double kPiece = 0.4;

int pieces(double length) { return std::max(1, static_cast<int>(std::ceil(length / kPiece))); }

Eigen::Isometry3d at(double x, double y, double z) { return Eigen::Isometry3d(Eigen::Translation3d(x, y, z)); }

// A rectangle cut into pieces, from its bottom left corner as seen from the front.
void addFace(Mesh& mesh, const Eigen::Vector3d& corner, const Eigen::Vector3d& right, const Eigen::Vector3d& up,
             const UvRect& uv) {
  addPatch(mesh, {corner, corner + right, corner + right + up, corner + up}, pieces(right.norm()), pieces(up.norm()),
           uv);
}

// A texture that repeats every `tile` metres on a face of this size.
UvRect tiled(double width, double height, double tile) { return {{0, 0}, {width / tile, height / tile}}; }

Model finishPart(const std::string& name, Mesh mesh, const cv::Mat& texture, double specular) {
  smoothNormals(mesh, 20);
  return {name, std::move(mesh), texture, specular};
}

Model floorPart() {
  Mesh mesh;
  addFace(mesh, {-kRoomDepth / 2, kRoomWidth / 2, 0}, {0, -kRoomWidth, 0}, {kRoomDepth, 0, 0},
          tiled(kRoomWidth, kRoomDepth, 1.2));
  return finishPart("floor", mesh, floorPlanks(), 0.1);
}

Model ceilingPart() {
  Mesh mesh;
  addFace(mesh, {kRoomDepth / 2, kRoomWidth / 2, 0}, {0, -kRoomWidth, 0}, {-kRoomDepth, 0, 0},
          tiled(kRoomWidth, kRoomDepth, 2.0));
  return finishPart("ceiling", mesh, ceilingPaint(), 0);
}

Model backWall() {
  Mesh mesh;
  addFace(mesh, {0, kRoomWidth / 2, 0}, {0, -kRoomWidth, 0}, {0, 0, kRoomHeight}, tiled(kRoomWidth, kRoomHeight, 1.5));
  return finishPart("back_wall", mesh, wallPlaster(), 0);
}

// Faces -y: the wall on the left. The one on the right is the same, turned about.
Model sideWall() {
  Mesh mesh;
  addFace(mesh, {-kRoomDepth / 2, 0, 0}, {kRoomDepth, 0, 0}, {0, 0, kRoomHeight}, tiled(kRoomDepth, kRoomHeight, 1.5));
  return finishPart("side_wall", mesh, wallPlaster(), 0);
}

// Front, sides, top and bottom of a block whose back stands against a wall; centred on the origin.
void addBlock(Mesh& mesh, const Eigen::Vector3d& size, const UvRect& front, const UvRect& side, const UvRect& top) {
  const Eigen::Vector3d h = size / 2;
  const Eigen::Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  addFace(mesh, {-h.x(), h.y(), -h.z()}, -y, z, front);
  addFace(mesh, {h.x(), h.y(), -h.z()}, -x, z, side);
  addFace(mesh, {-h.x(), -h.y(), -h.z()}, x, z, side);
  addFace(mesh, {-h.x(), h.y(), h.z()}, -y, x, top);
  addFace(mesh, {h.x(), h.y(), -h.z()}, -y, -x, top);
}

Model counterPart() {
  Mesh mesh;
  addBlock(mesh, {kCounterDepth, kCounterWidth, kCounterThickness}, tiled(kCounterWidth, kCounterThickness, 0.8),
           tiled(kCounterDepth, kCounterThickness, 0.8), tiled(kCounterWidth, kCounterDepth, 0.8));
  return finishPart("counter", mesh, counterStone(), 0.12);
}

Model splashPart() {
  Mesh mesh;
  addBlock(mesh, {0.02, kCounterWidth, kSplashHeight}, tiled(kCounterWidth, kSplashHeight, 0.56),
           Cell{88, 8, 16, 16}.uv(), Cell{88, 8, 16, 16}.uv());
  return finishPart("backsplash", mesh, splashTiles(), 0.15);
}

// A row of doors in the plane x = 0, centred on the origin. The handles are by the lower or the upper edges.
void addDoors(Mesh& mesh, int count, double width, double height, bool handles_low) {
  const double door_width = width / count;
  for (int i = 0; i < count; ++i) {
    const double left = width / 2 - i * door_width;
    addFace(mesh, {0, left, -height / 2}, {0, -door_width, 0}, {0, 0, height}, kDoor.uv());
    Mesh handle = plainBox({0.02, 0.014, 0.14}, kSteel.uv());
    // Doors open in pairs: the handles of a pair are side by side.
    const double y = i % 2 == 0 ? left - door_width + 0.04 : left - 0.04;
    transform(handle, at(-0.02, y, (handles_low ? -1 : 1) * (height / 2 - 0.14)));
    append(mesh, handle);
  }
}

Model baseCabinets() {
  const double depth = 0.68, width = 3.14, height = 0.76, plinth = 0.10;
  Mesh mesh;
  addBlock(mesh, {depth, width, height}, kPaint.uv(), kPaint.uv(), kPaint.uv());
  Mesh foot;
  addBlock(foot, {depth - 0.06, width, plinth}, kPaint.uv(), kPaint.uv(), kPaint.uv());
  transform(foot, at(0.03, 0, -(height + plinth) / 2));
  append(mesh, foot);
  Mesh doors;
  addDoors(doors, 6, width, height, false);
  transform(doors, at(-depth / 2 - 0.01, 0, 0));
  append(mesh, doors);
  return finishPart("base_cabinets", mesh, cabinetPaint({92, 112, 122}), 0.08);
}

// One of two: they hang on either side of the window.
Model upperCabinet() {
  const double depth = 0.32, width = 1.0, height = 0.75;
  Mesh mesh;
  addBlock(mesh, {depth, width, height}, kPaint.uv(), kPaint.uv(), kPaint.uv());
  Mesh doors;
  addDoors(doors, 2, width, height, true);
  transform(doors, at(-depth / 2 - 0.01, 0, 0));
  append(mesh, doors);
  return finishPart("upper_cabinet", mesh, cabinetPaint({214, 210, 198}), 0.08);
}

Model windowPart() {
  const double width = 1.0, height = 0.75, bar = 0.05;
  Mesh mesh;
  addFace(mesh, {-0.01, width / 2, -height / 2}, {0, -width, 0}, {0, 0, height}, kView.uv());
  const Eigen::Vector3d across(0.05, width, bar), upright(0.05, bar, height);
  for (const double side : {-1.0, 1.0}) {
    Mesh rail = plainBox(across, kFrame.uv()), post = plainBox(upright, kFrame.uv());
    transform(rail, at(-0.02, 0, side * (height - bar) / 2));
    transform(post, at(-0.02, side * (width - bar) / 2, 0));
    append(mesh, rail);
    append(mesh, post);
  }
  return finishPart("window", mesh, windowView(), 0);
}

}  // namespace

std::vector<Model> makeKitchen() {
  return {floorPart(),   ceilingPart(), backWall(),     sideWall(),  baseCabinets(),
          counterPart(), splashPart(),  upperCabinet(), windowPart()};
}

}  // namespace early_fusion::make_meshes
