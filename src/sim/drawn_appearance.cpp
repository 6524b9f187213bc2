#include "early_fusion/sim/drawn_appearance.h"

#include <algorithm>
#include <cmath>

#include "early_fusion/core/random.h"
#include "early_fusion/world/placed_hull.h"

namespace early_fusion::sim {

namespace {

constexpr int kTrainedTextures = 24;  // the rest of world::kProceduralTextures is held out
static_assert(kTrainedTextures < world::kProceduralTextures);
constexpr int kLowestQuality = 30, kQualities = 66;
constexpr int kTriesForAPlace = 20;

double around(double middle, double spread, core::Random& random) {
  return random.uniform(middle - spread, middle + spread);
}

float factor(double spread, core::Random& random) { return static_cast<float>(around(1, spread, random)); }

float octaves(double spread, core::Random& random) { return static_cast<float>(std::exp2(around(0, spread, random))); }

/// Factors in [1 - spread, 1 + spread], times `all`.
world::ColorFactors colors(double spread, float all, core::Random& random) {
  world::ColorFactors factors;
  for (float& one : factors) one = all * factor(spread, random);
  return factors;
}

/// A direction within `most_deg` of the shipped light's, uniform over the angle and the turn about it.
std::array<float, 3> towardsLight(double most_deg, core::Random& random) {
  const Eigen::Vector3d shipped(world::kTowardsLight[0], world::kTowardsLight[1], world::kTowardsLight[2]);
  const double angle = random.uniform(0, most_deg) * EIGEN_PI / 180, turn = random.uniform(0, 2 * EIGEN_PI);
  const Eigen::Vector3d side = Eigen::AngleAxisd(turn, shipped) * shipped.unitOrthogonal();
  const Eigen::Vector3d towards = (std::cos(angle) * shipped + std::sin(angle) * side).normalized();
  return {static_cast<float>(towards.x()), static_cast<float>(towards.y()), static_cast<float>(towards.z())};
}

int texture(const std::string& set, core::Random& random) {
  return set == "trained" ? random.below(kTrainedTextures)
                          : kTrainedTextures + random.below(world::kProceduralTextures - kTrainedTextures);
}

world::SurfaceLook procedural(const Randomisation& most, core::Random& random) {
  world::SurfaceLook look;
  look.texture = texture(most.texture_set, random);
  look.texture_scale = octaves(most.texture_scale, random);
  look.color = colors(most.kitchen_color, 1, random);
  return look;
}

std::vector<world::SurfaceLook> kitchenLooks(const world::World& world, const Randomisation& most,
                                             core::Random& random) {
  std::vector<world::SurfaceLook> looks;
  for (const world::FixedMesh& fixed : world.kitchen) {
    for (std::size_t part = 0; part < fixed.mesh.parts.size(); ++part) {
      world::SurfaceLook look = procedural(most, random);
      if (random.uniform() >= most.kitchen_textures) {
        look.texture = -1;
        look.texture_scale = 1;
      }
      looks.push_back(look);
    }
  }
  return looks;
}

world::SensorLook sensorLook(const Randomisation& most, core::Random& random) {
  world::SensorLook look;
  look.blur_px = static_cast<float>(random.uniform(0, most.blur_px));
  const float exposure = octaves(most.exposure, random);
  look.gain = {exposure * factor(most.white_balance, random), exposure, exposure * factor(most.white_balance, random)};
  look.gamma = octaves(most.gamma, random);
  look.noise = static_cast<float>(random.uniform(0, most.noise));
  const int quality = kLowestQuality + random.below(kQualities);
  look.jpeg_quality = random.uniform() < most.jpeg ? quality : 0;
  return look;
}

double radius(const world::World& world, int item) {
  double square = 0;
  for (const Eigen::Vector3d& corner : world.objects[item].hull) {
    square = std::max(square, corner.head<2>().squaredNorm());
  }
  return std::sqrt(square);
}

/// Whether a distractor stands on the counter's top, clear of the kitchen's collision shapes.
bool standsOnCounter(const world::World& world, const world::Distractor& one, double disc_radius) {
  const Eigen::Vector3d centre(one.x, one.y, world.placement.z), reach(disc_radius, disc_radius, 0);
  if (world.counter_top.overhang({centre - reach, centre + reach}) > 0) return false;
  const Eigen::Vector3d half(0.5 * one.size[0], 0.5 * one.size[1], 0), up(0, 0, one.size[2]);
  const Eigen::AlignedBox3d box(-half, half + up);
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) corners.push_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
  const world::PlacedHull hull(corners,
                               Eigen::Translation3d(centre) * Eigen::AngleAxisd(one.theta, Eigen::Vector3d::UnitZ()));
  return std::none_of(world.obstacles.begin(), world.obstacles.end(), [&hull](const auto& obstacle) {
    return hull.bounds().intersects(obstacle->bounds()) && hull.distanceTo(*obstacle) == 0;
  });
}

std::vector<world::Distractor> distractors(const world::World& world, const Randomisation& most,
                                           const std::vector<Instance>& instances, core::Random& random) {
  struct Disc {
    Eigen::Vector2d centre;
    double radius;
  };
  std::vector<Disc> taken;
  for (const Instance& one : instances) taken.push_back({{one.x, one.y}, radius(world, one.item)});
  std::vector<world::Distractor> placed;
  const int count = random.below(most.distractors + 1);
  for (int tries = 0; tries < kTriesForAPlace * count && static_cast<int>(placed.size()) < count; ++tries) {
    world::Distractor one;
    one.is_round = random.below(2) == 1;
    one.size = {random.uniform(0.03, 0.12), random.uniform(0.03, 0.12), random.uniform(0.03, 0.2)};
    if (one.is_round) one.size[1] = one.size[0];
    one.x = random.uniform(world.placement.min_x, world.placement.max_x);
    one.y = random.uniform(world.placement.min_y, world.placement.max_y);
    one.theta = random.uniform(0, 2 * EIGEN_PI);
    one.look = procedural(most, random);
    const Disc disc{{one.x, one.y}, 0.5 * std::hypot(one.size[0], one.size[1])};
    const bool is_free = std::none_of(taken.begin(), taken.end(), [&](const Disc& other) {
      return (other.centre - disc.centre).norm() < other.radius + disc.radius;
    });
    if (!is_free || !standsOnCounter(world, one, disc.radius)) continue;
    taken.push_back(disc);
    placed.push_back(one);
  }
  return placed;
}

}  // namespace

std::shared_ptr<const world::Appearance> drawAppearance(const world::World& world, const Randomisation& randomisation,
                                                        const std::vector<Instance>& instances, std::uint64_t seed,
                                                        std::uint64_t episode) {
  if (randomisation.isNone()) return nullptr;
  const Randomisation& most = randomisation;
  core::Random look = most.looks > 0 ? core::Random(most.look_seed, {core::kLookStream, episode % most.looks})
                                     : core::Random(seed, {core::kLookStream, episode});
  core::Random places(seed, {core::kDistractorStream, episode});
  auto drawn = std::make_shared<world::Appearance>();
  if (most.light_direction_deg > 0) drawn->towards_light = towardsLight(most.light_direction_deg, look);
  drawn->direct_light = colors(most.light_color, factor(most.light_strength, look), look);
  drawn->ambient_light = colors(most.light_color, factor(most.ambient_strength, look), look);
  drawn->kitchen = kitchenLooks(world, most, look);
  for (int item = 0; item < world.objects.size(); ++item) {
    drawn->object_colors.push_back(colors(most.object_color, factor(most.object_brightness, look), look));
  }
  drawn->camera_roll_rad = around(0, most.camera_roll_deg, look) * EIGEN_PI / 180;
  drawn->focal_factor = around(1, most.field_of_view, look);
  drawn->sensor = sensorLook(most, look);
  drawn->noise_seed = look.next();
  drawn->distractors = distractors(world, most, instances, places);
  return drawn;
}

}  // namespace early_fusion::sim
