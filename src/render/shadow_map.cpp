#include "shadow_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace early_fusion::render {

namespace {

constexpr int kLongSide = 736;  // [texels]: about 3 mm each on a counter of 2 m, less than a pixel
constexpr int kMargin = 8;      // [texels] that no object reaches
constexpr int kCellBits = 3;
constexpr int kCellSize = 1 << kCellBits;  // [texels]
constexpr int kBoxSize = 3;                // [texels], of the filter
constexpr int kFilterSize = kBoxSize + 1;  // [texels] that a box touches if it begins between two texels
// [texels] along the normal: a little more than the distance to the farthest texel centre that the filter touches, so
// that no surface shades itself
constexpr float kOffset = 2.25f;
constexpr float kNothing = -std::numeric_limits<float>::max();

int texelsFor(double half_extent, double texel_size) {
  const int texels = static_cast<int>(std::ceil(2 * half_extent / texel_size)) + 2 * kMargin;
  return (texels + kCellSize - 1) / kCellSize * kCellSize;
}

FloatLanes evaluate(const LinearForm& form, const std::array<FloatLanes, 3>& p) {
  return form.factor[0] * p[0] + form.factor[1] * p[1] + form.factor[2] * p[2] + form.constant;
}

Eigen::AlignedBox3d casterBox(const world::World& world) {
  double radius = 0.01, height = 0.01;
  for (int item = 0; item < world.objects.size(); ++item) {
    for (const world::MeshPart& part : world.objects[item].mesh.parts) {
      for (const world::Vertex& vertex : part.vertices) {
        const double x = vertex.position.x(), y = vertex.position.y();
        radius = std::max(radius, std::sqrt(x * x + y * y));
        height = std::max<double>(height, vertex.position.z());
      }
    }
  }
  const world::HorizontalRectangle& area = world.placement;
  return {Eigen::Vector3d(area.min_x - radius, area.min_y - radius, area.z),
          Eigen::Vector3d(area.max_x + radius, area.max_y + radius, area.z + height)};
}

/// Largest distance of the box's corners from its centre along an axis.
double extent(const Eigen::AlignedBox3d& box, const double (&axis)[3]) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) sum += 0.5 * (box.max()[i] - box.min()[i]) * std::fabs(axis[i]);
  return sum;
}

/// scale * axis . (point - centre of the box)
LinearForm along(const double (&axis)[3], double scale, const Eigen::AlignedBox3d& box) {
  LinearForm form{{0.f, 0.f, 0.f}, 0.f};
  double constant = 0;
  for (int i = 0; i < 3; ++i) {
    form.factor[i] = static_cast<float>(scale * axis[i]);
    constant -= scale * axis[i] * 0.5 * (box.min()[i] + box.max()[i]);
  }
  form.constant = static_cast<float>(constant);
  return form;
}

}  // namespace

ShadowMap::ShadowMap(const world::World& world) : box_(casterBox(world)) {
  setLight(world::kTowardsLight);
  draw({});
}

void ShadowMap::setLight(const std::array<float, 3>& towards_light) {
  const double light[3] = {towards_light[0], towards_light[1], towards_light[2]};
  const double length = std::sqrt(light[0] * light[0] + light[2] * light[2]);
  const double right[3] = {light[2] / length, 0, -light[0] / length};
  const double up[3] = {light[1] * right[2], light[2] * right[0] - light[0] * right[2], -light[1] * right[0]};
  const double half_width = extent(box_, right), half_height = extent(box_, up);
  const double texel_size = 2 * std::max(half_width, half_height) / kLongSide;
  texel_size_ = static_cast<float>(texel_size);
  width_ = texelsFor(half_width, texel_size);
  height_ = texelsFor(half_height, texel_size);
  projection_.perspective = false;
  projection_.x = along(right, kSubsamples / texel_size, box_);
  projection_.y = along(up, kSubsamples / texel_size, box_);
  projection_.w = {{0.f, 0.f, 0.f}, 1.f};
  projection_.depth = along(light, 1.0, box_);
  projection_.half_width = 0.5f * kSubsamples * width_;
  projection_.half_height = 0.5f * kSubsamples * height_;
  buffer_.clear();
  buffer_.emplace_back(width_, height_, false);
}

void ShadowMap::draw(const std::vector<Caster>& casters) {
  buffer_.front().clear(kNothing);
  drawer_.clear();
  for (const Caster& caster : casters) {
    drawer_.draw(*caster.mesh, caster.world_from_mesh, projection_, buffer_.front());
  }
  buffer_.front().copyDepth(depth_);
  summarise();
}

void ShadowMap::summarise() {
  const int columns = width_ / kCellSize, rows = height_ / kCellSize;
  cell_low_.assign(static_cast<std::size_t>(columns) * rows, 0.f);
  cell_high_.assign(cell_low_.size(), 0.f);
  constexpr int kReach = kCellSize + kFilterSize - 1;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      float low = std::numeric_limits<float>::max(), high = kNothing;
      for (int y = row * kCellSize; y < std::min(row * kCellSize + kReach, height_); ++y) {
        const float* texels = &depth_[static_cast<std::size_t>(y) * width_];
        for (int x = column * kCellSize; x < std::min(column * kCellSize + kReach, width_); ++x) {
          low = std::min(low, texels[x]);
          high = std::max(high, texels[x]);
        }
      }
      cell_low_[static_cast<std::size_t>(row) * columns + column] = low;
      cell_high_[static_cast<std::size_t>(row) * columns + column] = high;
    }
  }
}

FloatLanes ShadowMap::lit(const std::array<FloatLanes, 3>& point, const std::array<FloatLanes, 3>& normal,
                          IntLanes needed) const {
  std::array<FloatLanes, 3> p;
  for (int i = 0; i < 3; ++i) p[i] = point[i] + (kOffset * texel_size_) * normal[i];
  constexpr float kTexels = 1.f / kSubsamples;
  const FloatLanes x = (evaluate(projection_.x, p) + projection_.half_width) * kTexels - 0.5f * kBoxSize;
  const FloatLanes y = (evaluate(projection_.y, p) + projection_.half_height) * kTexels - 0.5f * kBoxSize;
  const FloatLanes depth = evaluate(projection_.depth, p);
  const IntLanes first_x = floorToInt(x), first_y = floorToInt(y);
  const IntLanes inside =
      needed & (first_x >= 0) & (first_x <= width_ - kFilterSize) & (first_y >= 0) & (first_y <= height_ - kFilterSize);
  if (maskBits(inside) == 0) return allLanes(1.f);
  // Most points are far from a shadow's edge. For these, two numbers of a cell give the same result as the filter.
  const IntLanes cell = ((first_y >> kCellBits) * (width_ / kCellSize) + (first_x >> kCellBits)) & inside;
  const IntLanes all_lit = ~inside | (gather<FloatLanes>(cell_high_.data(), cell) <= depth);
  const IntLanes none_lit = gather<FloatLanes>(cell_low_.data(), cell) > depth;
  FloatLanes result = select(all_lit, allLanes(1.f), FloatLanes{});
  const IntLanes open = ~(all_lit | none_lit);
  if (maskBits(open) != 0) {
    const IntLanes first_texel = (first_y * width_ + first_x) & inside;
    result = select(open, filtered(first_texel, x - toFloat(first_x), y - toFloat(first_y), depth), result);
  }
  return result;
}

/// The mean of the comparisons over a box of 3x3 texels whose centre is the point. A texel at the rim counts by its
/// share in the box. The box begins in `first_texel`, at the position that the fractions give.
FloatLanes ShadowMap::filtered(IntLanes first_texel, FloatLanes fraction_x, FloatLanes fraction_y,
                               FloatLanes depth) const {
  std::int32_t offset[kLanes];
  std::memcpy(offset, &first_texel, sizeof offset);
  FloatLanes sum{};
  for (int row = 0; row < kFilterSize; ++row) {
    const Columns<kFilterSize> texels = gatherRecords<kFilterSize>(depth_.data() + row * width_, offset);
    const auto lit = [&](int column) { return select(texels[column] <= depth, allLanes(1.f), FloatLanes{}); };
    const FloatLanes row_sum = (1.f - fraction_x) * lit(0) + lit(1) + lit(2) + fraction_x * lit(3);
    if (row == 0) {
      sum += (1.f - fraction_y) * row_sum;
    } else {
      sum += row == kFilterSize - 1 ? fraction_y * row_sum : row_sum;
    }
  }
  return sum * (1.f / (kBoxSize * kBoxSize));
}

}  // namespace early_fusion::render
