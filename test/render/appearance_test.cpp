#include "early_fusion/world/appearance.h"

#include <gtest/gtest.h>

#include "early_fusion/render/rasterizer.h"
#include "model/error_of.h"
#include "world/handmade_world.h"

namespace early_fusion::render {
namespace {

/// A wall of one colour that faces the camera, and nothing else.
world::World wall(std::uint32_t color) {
  world::World world;
  world::MeshPart part;
  part.texture = world::plainTexture(color);
  world::appendQuad(part, {2, 3, 3}, {0, -6, 0}, {0, 0, -6});
  world.kitchen.push_back(world::fixedMesh(part));
  world.objects = world::handmadeObjects(1, 2);
  world.placement = world.counter_top = {0.5, 1, -0.3, 0.3, 0};
  return world;
}

const Eigen::Isometry3d kCamera = world::lookAlong({0, 0, 0.3}, {1, 0, 0});

struct Pixel {
  int red, green, blue;
};

core::Image drawn(Rasterizer& rasterizer, const world::Appearance& look) {
  rasterizer.setAppearance(std::make_shared<const world::Appearance>(look));
  core::Image image;
  rasterizer.render(kCamera, image);
  return image;
}

Pixel middle(const core::Image& image) {
  const std::uint8_t* rgb = &image.rgb[3 * (image.height / 2 * image.width + image.width / 2)];
  return {rgb[0], rgb[1], rgb[2]};
}

TEST(Appearance, FactorsOfLightAndSurfaceMultiplyTheColour) {
  const world::World world = wall(world::rgb(100, 100, 100));
  Rasterizer rasterizer(world, 64);
  const Pixel plain = middle(drawn(rasterizer, {}));
  world::Appearance look;
  look.direct_light = look.ambient_light = {0.5f, 1.f, 1.5f};
  const Pixel lit = middle(drawn(rasterizer, look));
  EXPECT_NEAR(lit.red, 0.5 * plain.red, 1);
  EXPECT_EQ(lit.green, plain.green);
  EXPECT_NEAR(lit.blue, 1.5 * plain.blue, 1);
  look.kitchen = {{-1, 1, {1.f, 0.5f, 1.f}}};
  EXPECT_NEAR(middle(drawn(rasterizer, look)).green, 0.5 * plain.green, 1);
  EXPECT_NEAR(middle(drawn(rasterizer, look)).red, 0.5 * plain.red, 1);
}

TEST(Appearance, TheLightComesFromItsDirection) {
  const world::World world = wall(world::rgb(100, 100, 100));
  Rasterizer rasterizer(world, 64);
  world::Appearance from_camera, along_wall;
  from_camera.towards_light = {-0.8f, 0.f, 0.6f};
  along_wall.towards_light = {0.f, 0.f, 1.f};
  // The wall faces -x: ambient 0.4, and 0.72 of the light times the cosine.
  EXPECT_NEAR(middle(drawn(rasterizer, from_camera)).red, 100 * (0.4 + 0.72 * 0.8), 1);
  EXPECT_NEAR(middle(drawn(rasterizer, along_wall)).red, 100 * 0.4, 1);
}

TEST(Appearance, AProceduralTextureReplacesAPartsOwn) {
  const world::World world = wall(world::rgb(255, 0, 0));
  Rasterizer rasterizer(world, 64);
  ASSERT_EQ(middle(drawn(rasterizer, {})).green, 0);
  for (int texture = 0; texture < world::kProceduralTextures; ++texture) {
    world::Appearance look;
    look.kitchen = {{texture, 1, {1, 1, 1}}};
    EXPECT_GT(middle(drawn(rasterizer, look)).green, 0) << texture;
  }
}

TEST(Appearance, DistractorsAreDrawnAndCastShadows) {
  const std::shared_ptr<const world::World> world = world::loadWorld("");
  Rasterizer rasterizer(*world, 128);
  const double z = world->placement.z;
  const Eigen::Isometry3d camera = world::lookAlong({0.2, 0, z + 0.6}, {0.8, 0, -0.5});
  core::Image without, with, bare;
  world::Appearance look;
  look.distractors.push_back({true, 1.0, 0.0, 0.0, {0.1, 0.1, 0.2}, {0, 1, {1, 1, 1}}});
  rasterizer.render(camera, without);
  rasterizer.setAppearance(std::make_shared<const world::Appearance>(look));
  rasterizer.render(camera, with);
  int changed = 0, darker = 0;
  for (std::size_t i = 0; i < with.rgb.size(); i += 3) {
    changed += with.rgb[i] != without.rgb[i];
    darker += with.rgb[i] + 20 < without.rgb[i];
  }
  EXPECT_GT(changed, 100);
  EXPECT_GT(darker, 20);
  rasterizer.setAppearance(nullptr);
  rasterizer.render(camera, bare);
  EXPECT_EQ(bare.rgb, without.rgb) << "a look leaves no trace";
}

TEST(Appearance, RollTurnsThePictureAndTheFocalFactorEnlargesIt) {
  world::World world = wall(world::rgb(200, 200, 200));
  world::MeshPart mark;
  mark.texture = world::plainTexture(world::rgb(255, 0, 0));
  world::appendQuad(mark, {1.9f, 0.05f, 1.0f}, {0, -0.1f, 0}, {0, 0, -0.1f});  // above the middle
  world.kitchen.push_back(world::fixedMesh(mark));
  Rasterizer rasterizer(world, 128);
  const auto centreOfMark = [&](const world::Appearance& look) {
    const core::Image image = drawn(rasterizer, look);
    double x = 0, y = 0, count = 0;
    for (int row = 0; row < 128; ++row) {
      for (int column = 0; column < 128; ++column) {
        if (image.rgb[3 * (row * 128 + column) + 1] > 60) continue;
        x += column - 63.5;
        y += row - 63.5;
        ++count;
      }
    }
    EXPECT_GT(count, 0);
    return Eigen::Vector2d(x / count, y / count);
  };
  const Eigen::Vector2d plain = centreOfMark({});
  EXPECT_NEAR(plain.x(), 0, 0.6);
  EXPECT_LT(plain.y(), -20);
  world::Appearance look;
  look.camera_roll_rad = M_PI / 2;  // clockwise, so the picture turns to the left
  EXPECT_NEAR(centreOfMark(look).x(), plain.y(), 0.6);
  EXPECT_NEAR(centreOfMark(look).y(), 0, 0.6);
  look.camera_roll_rad = 0;
  look.focal_factor = 1.25;
  EXPECT_NEAR(centreOfMark(look).y(), 1.25 * plain.y(), 0.6);
}

TEST(Appearance, NoiseIsTheSameForTheSameSceneAndCameraOnly) {
  const std::shared_ptr<const world::World> world = world::loadWorld("");
  Rasterizer rasterizer(*world, 64), other(*world, 64);
  auto look = std::make_shared<world::Appearance>();
  look->sensor.noise = 5;
  look->noise_seed = 3;
  rasterizer.setAppearance(look);
  other.setAppearance(std::make_shared<world::Appearance>(*look));
  core::Image first, again, elsewhere;
  rasterizer.render(world->rig.worldFromCamera({0, 0}), first);
  rasterizer.render(world->rig.worldFromCamera({0, 1}), elsewhere);
  other.render(world->rig.worldFromCamera({0, 0}), again);
  EXPECT_EQ(first.rgb, again.rgb);
  EXPECT_NE(first.rgb, elsewhere.rgb);
}

TEST(Appearance, ALookOfAnotherWorldIsAnError) {
  const world::World world = wall(world::rgb(100, 100, 100));
  Rasterizer rasterizer(world, 64);
  auto look = std::make_shared<world::Appearance>();
  look->kitchen.resize(5);
  model::expectError([&] { rasterizer.setAppearance(look); }, "5 parts of the kitchen");
}

}  // namespace
}  // namespace early_fusion::render
