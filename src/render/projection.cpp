#include "projection.h"

#include <cmath>

namespace early_fusion::render {

namespace {

struct Range {
  float low, high;
};

Range range(const LinearForm& form, const RenderMesh& mesh) {
  float middle = form.constant;
  float radius = 0.f;
  for (int axis = 0; axis < 3; ++axis) {
    middle += form.factor[axis] * mesh.box_centre[axis];
    radius += std::fabs(form.factor[axis]) * mesh.box_half_size[axis];
  }
  return {middle - radius, middle + radius};
}

LinearForm after(const LinearForm& form, const RenderPose& pose) {
  LinearForm result{{0.f, 0.f, 0.f}, form.constant};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      result.factor[column] += form.factor[row] * pose.rotation[row][column];
    }
    result.constant += form.factor[row] * pose.translation[row];
  }
  return result;
}

}  // namespace

LinearForm operator+(const LinearForm& a, const LinearForm& b) {
  LinearForm sum;
  for (int axis = 0; axis < 3; ++axis) sum.factor[axis] = a.factor[axis] + b.factor[axis];
  sum.constant = a.constant + b.constant;
  return sum;
}

LinearForm operator*(float scale, const LinearForm& a) {
  return {{scale * a.factor[0], scale * a.factor[1], scale * a.factor[2]}, scale * a.constant};
}

Projection Projection::after(const RenderPose& pose) const {
  Projection result = *this;
  result.x = render::after(x, pose);
  result.y = render::after(y, pose);
  result.w = render::after(w, pose);
  result.depth = render::after(depth, pose);
  return result;
}

Visibility visibility(const Projection& projection, const RenderMesh& mesh) {
  const Range w = range(projection.w, mesh);
  if (w.high < kNearPlane) return Visibility::kOutside;
  bool safe = w.low >= kNearPlane;
  const LinearForm* forms[2] = {&projection.x, &projection.y};
  const float half_sizes[2] = {projection.half_width, projection.half_height};
  for (int axis = 0; axis < 2; ++axis) {
    for (const float side : {-1.f, 1.f}) {
      const LinearForm towards_edge = side * *forms[axis];
      if (range(towards_edge + half_sizes[axis] * projection.w, mesh).high < 0.f) return Visibility::kOutside;
      // A little less than the band, because vertices are rounded.
      safe = safe && range(towards_edge + 0.99f * kGuardBand * projection.w, mesh).low >= 0.f;
    }
  }
  return safe ? Visibility::kSafe : Visibility::kNeedsClip;
}

}  // namespace early_fusion::render
