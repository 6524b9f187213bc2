#include "early_fusion/sim/drawn_appearance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "early_fusion/world/placed_hull.h"
#include "world/test_world.h"

namespace early_fusion::sim {
namespace {

const world::World& world() {
  static const std::shared_ptr<const world::World> world = world::testWorld();
  return *world;
}

std::size_t kitchenParts() {
  std::size_t parts = 0;
  for (const world::FixedMesh& fixed : world().kitchen) parts += fixed.mesh.parts.size();
  return parts;
}

EpisodeKey key(const Randomisation& randomisation, std::uint64_t seed, std::uint64_t number) {
  Task task;
  task.instances = 3;
  task.randomisation = randomisation;
  return {task, seed, number};
}

TEST(DrawnAppearance, WithoutRandomisationThereIsNone) {
  EXPECT_EQ(sampleEpisode(world(), key({}, 1, 0)).appearance, nullptr);
}

TEST(DrawnAppearance, TheKeyDeterminesItAndTheSceneStaysTheSame) {
  const Randomisation randomisation = loadRandomisation("real_camera");
  const EpisodeSetup a = sampleEpisode(world(), key(randomisation, 1, 5)),
                     b = sampleEpisode(world(), key(randomisation, 1, 5));
  EXPECT_EQ(a.appearance->towards_light, b.appearance->towards_light);
  EXPECT_EQ(a.appearance->noise_seed, b.appearance->noise_seed);
  EXPECT_EQ(a.appearance->object_colors, b.appearance->object_colors);
  EXPECT_EQ(a.appearance->distractors.size(), b.appearance->distractors.size());
  const EpisodeSetup plain = sampleEpisode(world(), key({}, 1, 5));
  EXPECT_EQ(a.instances, plain.instances);
  EXPECT_EQ(a.request, plain.request);
  EXPECT_NE(sampleEpisode(world(), key(randomisation, 1, 6)).appearance->noise_seed, a.appearance->noise_seed);
  EXPECT_NE(sampleEpisode(world(), key(randomisation, 2, 5)).appearance->noise_seed, a.appearance->noise_seed);
}

TEST(DrawnAppearance, NothingDepartsFartherThanItMay) {
  Randomisation most;
  most.light_direction_deg = 20;
  most.light_strength = 0.5;
  most.light_color = 0.2;
  most.kitchen_color = 0.3;
  most.object_brightness = 0.1;
  most.camera_roll_deg = 4;
  most.field_of_view = 0.1;
  most.exposure = 1;
  most.gamma = 0.5;
  most.noise = 6;
  most.blur_px = 1;
  double widest_deg = 0, darkest = 1, brightest = 1;
  for (std::uint64_t episode = 0; episode < 300; ++episode) {
    const auto look = drawAppearance(world(), most, {}, 1, episode);
    double cosine = 0, square = 0;
    for (int i = 0; i < 3; ++i) {
      cosine += double(look->towards_light[i]) * world::kTowardsLight[i];
      square += double(look->towards_light[i]) * look->towards_light[i];
    }
    EXPECT_NEAR(square, 1, 1e-6);
    const double angle_deg = std::acos(std::min(1.0, cosine)) * 180 / M_PI;
    EXPECT_LT(angle_deg, 20.01);
    widest_deg = std::max(widest_deg, angle_deg);
    for (const float channel : look->direct_light) {
      EXPECT_GE(channel, 0.5f * 0.8f);
      EXPECT_LE(channel, 1.5f * 1.2f);
    }
    ASSERT_EQ(look->kitchen.size(), kitchenParts());
    for (const world::SurfaceLook& part : look->kitchen) {
      EXPECT_EQ(part.texture, -1);
      EXPECT_EQ(part.texture_scale, 1);
      for (const float channel : part.color) EXPECT_LE(std::fabs(channel - 1), 0.3001f);
    }
    ASSERT_EQ(look->object_colors.size(), static_cast<std::size_t>(world().objects.size()));
    for (const world::ColorFactors& color : look->object_colors) {
      EXPECT_LE(std::fabs(color[0] - 1), 0.1001f);
      EXPECT_EQ(color[0], color[2]) << "object_color is 0";
    }
    EXPECT_TRUE(look->distractors.empty());
    EXPECT_LE(std::fabs(look->camera_roll_rad), 4 * M_PI / 180);
    EXPECT_LE(std::fabs(look->focal_factor - 1), 0.1);
    EXPECT_GE(look->sensor.gain[1], 0.5f);
    EXPECT_LE(look->sensor.gain[1], 2.f);
    EXPECT_EQ(look->sensor.gain[0], look->sensor.gain[1]) << "white_balance is 0";
    EXPECT_GE(look->sensor.gamma, std::exp2(-0.5f) * 0.9999f);
    EXPECT_LE(look->sensor.gamma, std::exp2(0.5f) * 1.0001f);
    EXPECT_LE(look->sensor.noise, 6.f);
    EXPECT_LE(look->sensor.blur_px, 1.f);
    EXPECT_EQ(look->sensor.jpeg_quality, 0);
    darkest = std::min<double>(darkest, look->sensor.gain[1]);
    brightest = std::max<double>(brightest, look->sensor.gain[1]);
  }
  EXPECT_GT(widest_deg, 18);
  EXPECT_LT(darkest, 0.55);
  EXPECT_GT(brightest, 1.8);
}

TEST(DrawnAppearance, HeldOutTexturesAreNeverTrained) {
  Randomisation most;
  most.kitchen_textures = 1;
  most.distractors = 4;
  std::set<int> trained, held_out;
  for (std::uint64_t episode = 0; episode < 200; ++episode) {
    for (const auto& [set, textures] : {std::pair{"trained", &trained}, std::pair{"held_out", &held_out}}) {
      most.texture_set = set;
      const auto look = drawAppearance(world(), most, {}, 1, episode);
      for (const world::SurfaceLook& part : look->kitchen) textures->insert(part.texture);
      for (const world::Distractor& one : look->distractors) textures->insert(one.look.texture);
    }
  }
  EXPECT_EQ(trained.size() + held_out.size(), static_cast<std::size_t>(world::kProceduralTextures));
  for (const int texture : held_out) EXPECT_EQ(trained.count(texture), 0u) << texture;
  EXPECT_GE(*trained.begin(), 0);
  EXPECT_LT(*held_out.rbegin(), world::kProceduralTextures);
}

TEST(DrawnAppearance, ThereAreAsManyLooksAsWanted) {
  Randomisation most;
  most.exposure = 1;
  most.looks = 3;
  most.look_seed = 9;
  std::set<float> gains;
  for (std::uint64_t episode = 0; episode < 30; ++episode) {
    gains.insert(drawAppearance(world(), most, {}, episode, episode)->sensor.gain[1]);
  }
  EXPECT_EQ(gains.size(), 3u);
}

TEST(DrawnAppearance, DistractorsStandOnTheCounterAndClearOfTheKitchen) {
  world::World wide = world();
  wide.placement = wide.counter_top;
  // A post in the middle of the counter.
  const Eigen::Vector3d middle(0.5 * (wide.counter_top.min_x + wide.counter_top.max_x), 0, wide.counter_top.z);
  const std::vector<Eigen::Vector3d> post = {{-0.1, -0.3, 0}, {0.1, -0.3, 0}, {-0.1, 0.3, 0}, {0.1, 0.3, 0},
                                             {-0.1, -0.3, 1}, {0.1, -0.3, 1}, {-0.1, 0.3, 1}, {0.1, 0.3, 1}};
  wide.obstacles = {std::make_shared<world::PlacedHull>(post, Eigen::Isometry3d(Eigen::Translation3d(middle)))};
  Randomisation most;
  most.distractors = 16;
  int placed = 0;
  for (std::uint64_t episode = 0; episode < 100; ++episode) {
    const auto look = drawAppearance(wide, most, {}, 1, episode);
    for (const world::Distractor& one : look->distractors) {
      ++placed;
      const Eigen::Rotation2Dd turn(one.theta);
      for (const double along : {-0.5, 0.0, 0.5}) {
        for (const double across : {-0.5, 0.0, 0.5}) {
          const Eigen::Vector2d p =
              Eigen::Vector2d(one.x, one.y) + turn * Eigen::Vector2d(along * one.size[0], across * one.size[1]);
          EXPECT_GE(p.x(), wide.counter_top.min_x);
          EXPECT_LE(p.x(), wide.counter_top.max_x);
          EXPECT_GE(p.y(), wide.counter_top.min_y);
          EXPECT_LE(p.y(), wide.counter_top.max_y);
          EXPECT_FALSE(std::fabs(p.x() - middle.x()) < 0.1 && std::fabs(p.y() - middle.y()) < 0.3);
        }
      }
    }
  }
  EXPECT_GT(placed, 300);
}

TEST(DrawnAppearance, DistractorsTouchNoObjectAndNotEachOther) {
  Randomisation most;
  most.distractors = 6;
  std::size_t placed = 0;
  for (std::uint64_t episode = 0; episode < 50; ++episode) {
    const EpisodeSetup setup = sampleEpisode(world(), key(most, 3, episode));
    const std::vector<world::Distractor>& all = setup.appearance->distractors;
    EXPECT_LE(all.size(), 6u);
    placed += all.size();
    const auto radius = [](const world::Distractor& one) { return 0.5 * std::hypot(one.size[0], one.size[1]); };
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (const Instance& object : setup.instances) {
        double nearest = 1;
        for (const Eigen::Vector3d& corner : world().objects[object.item].hull) {
          const Eigen::Vector3d p = worldFromObject(world(), object) * corner;
          nearest = std::min(nearest, std::hypot(p.x() - all[i].x, p.y() - all[i].y));
        }
        EXPECT_GE(nearest, radius(all[i]));
      }
      for (std::size_t k = 0; k < i; ++k) {
        EXPECT_GE(std::hypot(all[i].x - all[k].x, all[i].y - all[k].y), radius(all[i]) + radius(all[k]));
      }
    }
  }
  EXPECT_GT(placed, 75u) << "three an episode on average, less those without a place";
}

}  // namespace
}  // namespace early_fusion::sim
