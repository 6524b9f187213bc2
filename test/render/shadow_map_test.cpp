#include "shadow_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "world/handmade_world.h"

namespace early_fusion::render {
namespace {

constexpr double kHalfSize = 0.03;  // [m] of the plate that casts the shadow: about thirteen texels
constexpr double kStep = 0.00002;   // [m] between points: about a hundredth of a texel

struct Axes {
  Eigen::Vector3d light, right, up;
};

/// The map's: `right` is level in y, as that is how the map lies in the world.
Axes mapAxes() {
  const Eigen::Vector3d light(world::kTowardsLight[0], world::kTowardsLight[1], world::kTowardsLight[2]);
  const Eigen::Vector3d right = Eigen::Vector3d(light.z(), 0, -light.x()).normalized();
  return {light, right, light.cross(right)};
}

/// One object: a square plate that faces the light, its middle in the object's origin.
std::unique_ptr<world::World> plateWorld(const Axes& axes) {
  auto world = std::make_unique<world::World>();
  world::MeshPart part;
  part.texture = world::plainTexture(world::rgb(90, 90, 90));
  const Eigen::Vector3d corner = kHalfSize * (axes.up - axes.right);
  world::appendQuad(part, corner.cast<float>(), (2 * kHalfSize * axes.right).cast<float>(),
                    (-2 * kHalfSize * axes.up).cast<float>());
  world::Object object;
  object.name = "plate";
  object.mesh.parts.push_back(std::move(part));
  std::vector<world::Object> objects;
  objects.push_back(std::move(object));
  world->objects = world::ObjectSet(std::move(objects));
  world->placement = {0.55, 1.05, -0.8, 0.8, 0.9};
  return world;
}

/// The shadow's edge along a line from the shadow into the light.
struct Edge {
  double place = 0;     ///< where half of the light arrives, from the middle of the shadow [m]
  double width = 0;     ///< of the slope [m]
  double steepest = 0;  ///< largest change between two points
};

class PlateShadow : public testing::Test {
 protected:
  void put(const Eigen::Vector3d& middle) {
    middle_ = middle;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = middle;
    map_.draw({{&assets_->objects[0], renderPose(pose)}});
  }

  /// Light on the plane behind the plate, which faces the light too, at a distance from the middle of the shadow.
  double litAt(const Eigen::Vector3d& axis, double distance) const {
    const Eigen::Vector3d point = middle_ - 0.04 * axes_.light + distance * axis;
    std::array<FloatLanes, 3> p, normal;
    for (int i = 0; i < 3; ++i) {
      p[i] = allLanes(static_cast<float>(point[i]));
      normal[i] = allLanes(world::kTowardsLight[i]);
    }
    return map_.lit(p, normal, allLanes(-1))[0];
  }

  Edge walk(const Eigen::Vector3d& axis) const {
    Edge edge;
    double before = litAt(axis, 0);
    EXPECT_EQ(before, 0) << "the middle of the plate's shadow";
    for (double distance = 0; distance < 2 * kHalfSize; distance += kStep) {
      const double lit = litAt(axis, distance + kStep);
      // Of a slope that is point symmetric, the mean of the places of its pieces, weighted by their rise, is the
      // middle.
      edge.place += (lit - before) * (distance + 0.5 * kStep);
      edge.width += lit > 0 && lit < 1 ? kStep : 0;
      edge.steepest = std::max(edge.steepest, std::fabs(lit - before));
      before = lit;
    }
    EXPECT_EQ(before, 1) << "well beyond the shadow's edge";
    return edge;
  }

  const Eigen::Vector3d start_{0.8, 0, 0.93};  // [m], of the plate's middle
  const Axes axes_ = mapAxes();
  const std::unique_ptr<const world::World> world_ = plateWorld(axes_);
  const std::shared_ptr<const RenderAssets> assets_ = sharedRenderAssets(*world_);
  ShadowMap map_{*world_};
  Eigen::Vector3d middle_;
};

// Fails when the filter is off its point along either axis. The plate covers the texels whose centres it covers, so its
// edge in the map is wrong by at most half a texel. Over places that are one and a sixteenth texel apart, sixteen of
// them, that error takes sixteen values evenly spread over a texel: their mean is at most 1/32 texel. Corners are
// rounded to a sixteenth of a texel, which adds at most 1/32. A filter half a texel off moves both edges by half a
// texel.
TEST_F(PlateShadow, LiesWhereThePlateStopsTheLight) {
  for (const Eigen::Vector3d& axis : {axes_.right, axes_.up}) {
    put(start_);
    const double texel = walk(axis).width / 3;
    constexpr int kPlaces = 16;
    double ahead = 0, behind = 0;
    for (int place = 0; place < kPlaces; ++place) {
      put(start_ + place * 17.0 / 16 * texel * axis);
      ahead += walk(axis).place / kPlaces;
      behind += walk(-axis).place / kPlaces;
    }
    EXPECT_NEAR((ahead - behind) / 2, 0, texel / 8) << "the shadow is beside the plate, a texel being " << texel;
    EXPECT_NEAR((ahead + behind) / 2, kHalfSize, texel / 8) << "the shadow is larger or smaller than the plate";
  }
}

// Fails when the numbers that decide for a whole cell of texels do not know of all that a filter in the cell reads: the
// slope would break off where the filter reaches into the next cell. The places pass through two cells.
TEST_F(PlateShadow, HasAnEvenSlopeAtItsEdgesWhereverItLies) {
  for (const Eigen::Vector3d& axis : {axes_.right, axes_.up}) {
    put(start_);
    const double width = walk(axis).width;
    for (int place = 0; place < 16; ++place) {
      put(start_ + place * width / 3 * axis);
      for (const double side : {-1.0, 1.0}) {
        const Edge edge = walk(side * axis);
        EXPECT_NEAR(edge.width, width, 2.1 * kStep);
        EXPECT_LT(edge.steepest, 1.2 * kStep / width);
      }
    }
  }
}

}  // namespace
}  // namespace early_fusion::render
