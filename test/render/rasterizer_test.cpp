#include "early_fusion/render/rasterizer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>
#include <thread>

#include "early_fusion/core/error.h"
#include "render/ray_caster.h"
#include "world/handmade_world.h"

// The thread sanitizer has its own operator new.
#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define EARLY_FUSION_COUNTS_NO_ALLOCATIONS
#endif
#endif

#ifndef EARLY_FUSION_COUNTS_NO_ALLOCATIONS
namespace {
std::atomic<long> allocations{0};
}

[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto align = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(align, (size + align - 1) / align * align)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
#endif

namespace early_fusion::render {
namespace {

constexpr int kSize = 128;
constexpr int kBlue = 200;

struct Color {
  int red, green, blue;
};

Color colorAt(const core::Image& image, int x, int y) {
  const std::uint8_t* rgb = &image.rgb[3 * (y * image.width + x)];
  return {rgb[0], rgb[1], rgb[2]};
}

core::Image rendered(const world::World& world, const Eigen::Isometry3d& camera, int size = kSize) {
  Rasterizer rasterizer(world, size);
  core::Image image;
  rasterizer.render(camera, image);
  return image;
}

double ramp(double coordinate) { return 20 + 180 * coordinate; }

/// Red grows with u, green with v, blue is the same all over: red / blue tells u whatever the light is.
world::Texture rampTexture() {
  constexpr int kTexels = 256;
  world::Texture texture{kTexels, std::vector<std::uint32_t>(kTexels * kTexels)};
  for (int y = 0; y < kTexels; ++y) {
    for (int x = 0; x < kTexels; ++x) {
      const int red = static_cast<int>(std::lround(ramp((x + 0.5) / kTexels)));
      const int green = static_cast<int>(std::lround(ramp((y + 0.5) / kTexels)));
      texture.texels[y * kTexels + x] = world::rgb(red, green, kBlue);
    }
  }
  return texture;
}

/// A quad with the ramps, away from the texture's edges, where red wraps from full to none.
world::FixedMesh rampQuad(const Eigen::Vector3f& corner, const Eigen::Vector3f& right, const Eigen::Vector3f& down,
                          int cells = 1) {
  world::MeshPart part;
  part.texture = rampTexture();
  world::appendQuad(part, corner, right, down, cells, cells);
  for (world::Vertex& vertex : part.vertices) vertex.uv = vertex.uv * 0.6f + Eigen::Vector2f::Constant(0.2f);
  return world::fixedMesh(std::move(part));
}

world::FixedMesh plainQuad(std::uint32_t color, const Eigen::Vector3f& corner, const Eigen::Vector3f& right,
                           const Eigen::Vector3f& down, int cells = 1) {
  world::MeshPart part;
  part.texture = world::plainTexture(color);
  world::appendQuad(part, corner, right, down, cells, cells);
  return world::fixedMesh(std::move(part));
}

/// Compares an image of ramps with what the ray caster sees: the texture coordinates in pixels that are covered whole,
/// the background in those that are not covered, a mixture in the others.
/// @return the number of pixels covered whole
int expectRampsAsRayCast(const world::World& world, const Eigen::Isometry3d& camera) {
  const core::Image image = rendered(world, camera);
  const Color background = colorAt(rendered(world::World{}, camera), 0, 0);
  const RayCaster caster(world, kSize);
  int whole = 0, doubtful = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      int hits = 0;
      Eigen::Vector2d uv(0, 0);
      for (int sample = 0; sample < 4; ++sample) {
        const auto hit = caster.cast(camera, x + 0.25 + 0.5 * (sample % 2), y + 0.25 + 0.5 * (sample / 2));
        if (!hit) continue;
        ++hits;
        uv += 0.25 * hit->uv;
      }
      const Color seen = colorAt(image, x, y);
      const bool is_background = seen.red == background.red && seen.green == background.green;
      if (hits == 0) {
        doubtful += !is_background;
      } else if (hits < 4) {
        doubtful += is_background;
      } else {
        ++whole;
        const double light = static_cast<double>(seen.blue) / kBlue;
        const bool agrees =
            std::fabs(seen.red - light * ramp(uv.x())) < 4 && std::fabs(seen.green - light * ramp(uv.y())) < 4;
        doubtful += !agrees;
      }
    }
  }
  // A corner is rounded to 1/32 pixel, which can move an edge over a sample.
  EXPECT_LE(doubtful, kSize * kSize / 200);
  return whole;
}

/// Looks along x with a horizon in the middle.
const Eigen::Isometry3d kAhead = world::lookAlong({0, 0, 1}, {1, 0, 0});

TEST(Rasterizer, PointsLandWhereThePinholePutsThem) {
  for (const Eigen::Vector3f& point :
       {Eigen::Vector3f(1, 0, 1), {1, 0.3f, 1.2f}, {2, -0.9f, 0.2f}, {0.5f, 0.2f, 0.8f}}) {
    world::World world{};
    const float edge = 0.02f * point.x();
    world.kitchen.push_back(
        plainQuad(world::rgb(255, 0, 0), point + Eigen::Vector3f(0, edge, edge), {0, -2 * edge, 0}, {0, 0, -2 * edge}));
    const core::Image image = rendered(world, kAhead);
    const Color background = colorAt(rendered(world::World{}, kAhead), 0, 0);
    Eigen::Vector2d sum(0, 0);
    double weights = 0;
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const double weight = background.green - colorAt(image, x, y).green;
        sum += weight * Eigen::Vector2d(x + 0.5, y + 0.5);
        weights += weight;
      }
    }
    ASSERT_GT(weights, 0);
    // fx = fy = 64 / tan(30 degrees), principal point (64, 64); the quad's middle is the point, as it faces the camera.
    // Its edges are seen to half a pixel, the samples' spacing.
    const double focal_length = 64 / std::tan(M_PI / 6);
    EXPECT_NEAR(sum.x() / weights, 64 - focal_length * point.y() / point.x(), 0.25);
    EXPECT_NEAR(sum.y() / weights, 64 - focal_length * (point.z() - 1) / point.x(), 0.25);
  }
}

TEST(Rasterizer, TexturesAreInPerspective) {
  world::World world{};
  world.kitchen.push_back(rampQuad({0.6f, 0.25f, 1.5f}, {2.5f, -0.6f, 0.1f}, {0.1f, 0.1f, -0.9f}));
  EXPECT_GT(expectRampsAsRayCast(world, kAhead), 2000);
}

TEST(Rasterizer, AQuadThatPassesBehindTheCameraIsCutAtTheNearPlane) {
  world::World world{};
  world.kitchen.push_back(rampQuad({9.f, 2.f, 0.8f}, {0, -4.f, 0}, {-12.f, 0, 0}));
  EXPECT_GT(expectRampsAsRayCast(world, kAhead), 4000);
  EXPECT_GT(expectRampsAsRayCast(world, world::lookAlong({0, 0, 1}, {1, 0.4, -0.6})), 8000);
}

TEST(Rasterizer, AQuadFarBeyondTheImageIsCutAtTheGuardBand) {
  world::World world{};
  world.kitchen.push_back(rampQuad({0.1f, 40.f, 50.f}, {0, -90.f, 0}, {0.02f, 0, -80.f}));
  EXPECT_EQ(expectRampsAsRayCast(world, world::lookAlong({0, 0, 1}, {1, 0, 0})), kSize * kSize);
}

TEST(Rasterizer, TheNearerSurfaceHidesTheFartherEvenWhereTheyPierce) {
  world::World world{};
  world.kitchen.push_back(plainQuad(world::rgb(220, 0, 0), {1.f, 0.8f, 1.5f}, {0.8f, -1.6f, 0}, {0, 0, -1.f}));
  world.kitchen.push_back(plainQuad(world::rgb(0, 220, 0), {1.8f, 0.8f, 1.5f}, {-0.8f, -1.6f, 0}, {0, 0, -1.f}));
  world.kitchen.push_back(plainQuad(world::rgb(0, 0, 220), {1.5f, 0.8f, 1.2f}, {0, -1.6f, 0}, {-0.6f, 0, -0.4f}));
  const core::Image image = rendered(world, kAhead);
  const RayCaster caster(world, kSize);
  int compared = 0, wrong = 0, seen_of[3] = {0, 0, 0};
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const auto corner = [&](int i) { return caster.cast(kAhead, x + i % 2, y + i / 2); };
      const auto first = corner(0);
      bool uniform = first.has_value();
      for (int i = 1; i < 4 && uniform; ++i) uniform = corner(i) && corner(i)->mesh == first->mesh;
      if (!uniform) continue;
      const Color color = colorAt(image, x, y);
      const int channel[3] = {color.red, color.green, color.blue};
      const int seen = static_cast<int>(std::max_element(channel, channel + 3) - channel);
      ++compared;
      ++seen_of[seen];
      wrong += seen != first->mesh;
    }
  }
  EXPECT_GT(compared, 5000);
  for (const int count : seen_of) EXPECT_GT(count, 300);
  EXPECT_EQ(wrong, 0);
}

TEST(Rasterizer, BackFacesAreNotDrawn) {
  world::World world{};
  world.kitchen.push_back(plainQuad(world::rgb(255, 0, 0), {1.f, -0.5f, 1.5f}, {0, 1.f, 0}, {0, 0, -1.f}));
  EXPECT_TRUE(rendered(world, kAhead).rgb == rendered(world::World{}, kAhead).rgb);
}

TEST(Rasterizer, NoSeamsBetweenTheTrianglesOfASurface) {
  core::Random random(5);
  for (const int cells : {1, 7, 60}) {
    world::World whole{}, cut{};
    const Eigen::Vector3f corner(1.f, 1.2f, 2.2f), right(0.7f, -2.8f, 0), down(0, 0, -2.6f);
    whole.kitchen.push_back(plainQuad(world::rgb(90, 90, 90), corner, right, down));
    cut.kitchen.push_back(plainQuad(world::rgb(90, 90, 90), corner, right, down, cells));
    for (world::World* world : {&whole, &cut}) {  // a glaring backdrop that would shine through
      world->kitchen.push_back(plainQuad(world::rgb(255, 0, 0), {3.f, 9.f, 9.f}, {0, -18.f, 0}, {0, 0, -18.f}));
    }
    for (world::Vertex& vertex : cut.kitchen.front().mesh.parts.front().vertices) {
      const bool inside = vertex.uv.minCoeff() > 0 && vertex.uv.maxCoeff() < 1;
      if (!inside) continue;
      const auto shift = [&] { return static_cast<float>(random.uniform(-0.3, 0.3)) / static_cast<float>(cells); };
      const float along = shift(), below = shift();
      vertex.position += along * right + below * down;
    }
    for (const double pan : {-0.2, 0.0, 0.13}) {
      const Eigen::Isometry3d camera = world::lookAlong({0, 0.01, 1.03}, {1, pan, -0.1});
      EXPECT_TRUE(rendered(cut, camera).rgb == rendered(whole, camera).rgb) << cells << " cells, pan " << pan;
    }
  }
}

TEST(Rasterizer, ObjectsCastSoftShadowsAwayFromTheLight) {
  auto world = world::handmadeKitchen(1, 3);
  const Eigen::Isometry3d camera = world::lookAlong({0, 0, 1.35}, {0.8, 0, -0.4});
  Rasterizer rasterizer(*world, kSize);
  core::Image with, without;
  rasterizer.setObjects({world::onCounter(0, 0.75, 0.1, 0.0)});
  rasterizer.render(camera, with);
  rasterizer.setObjects({});
  rasterizer.render(camera, without);
  const RayCaster caster(*world, kSize);
  const auto brightness = [&](double x, double y) {
    const Eigen::Vector2d pixel = *caster.project(camera, {x, y, 0.9});
    const auto sum = [&](const core::Image& image) {
      const Color color = colorAt(image, static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
      return static_cast<double>(color.red + color.green + color.blue);
    };
    return sum(with) / sum(without);
  };
  // The light comes from the upper left in front: the box's shadow falls behind it, to the right.
  EXPECT_LT(brightness(0.80, 0.03), 0.6);
  EXPECT_EQ(brightness(0.66, 0.10), 1.0);  // in front
  EXPECT_EQ(brightness(0.75, 0.20), 1.0);  // to the left
  int half_lit = 0;
  for (double y = -0.1; y < 0.1; y += 0.002) {
    const double ratio = brightness(0.80, y);
    half_lit += ratio > 0.65 && ratio < 0.95;
  }
  EXPECT_GT(half_lit, 0) << "the shadow has a hard edge";
}

TEST(Rasterizer, DrawsTheObjectsThatWereSetLast) {
  auto world = world::handmadeKitchen(4, 3);
  const Eigen::Isometry3d camera = world::lookAlong({0, 0, 1.35}, {0.8, 0, -0.4});
  const std::vector<world::ObjectPose> scene = world::handmadeScene(4, 4);
  Rasterizer used(*world, kSize);
  const auto drawn = [&](Rasterizer& rasterizer, const std::vector<world::ObjectPose>& objects) {
    core::Image image;
    rasterizer.setObjects(objects);
    rasterizer.render(camera, image);
    return image.rgb;
  };
  const auto fresh = [&](const std::vector<world::ObjectPose>& objects) {
    Rasterizer rasterizer(*world, kSize);
    return drawn(rasterizer, objects);
  };
  drawn(used, scene);
  EXPECT_TRUE(drawn(used, {scene[0], scene[2]}) == fresh({scene[0], scene[2]}));
  EXPECT_FALSE(drawn(used, {scene[2]}) == fresh({scene[0], scene[2]}));
  EXPECT_TRUE(drawn(used, {}) == fresh({}));
}

/// An image for each of some steps: the camera moves, and halfway an object goes.
std::vector<std::vector<std::uint8_t>> episode(const world::World& world) {
  Rasterizer rasterizer(world, kSize);
  core::Image image;
  std::vector<std::vector<std::uint8_t>> images;
  for (int step = 0; step < 24; ++step) {
    std::vector<world::ObjectPose> objects = world::handmadeScene(8, 4);
    if (step >= 12) objects.erase(objects.begin() + 2);
    rasterizer.setObjects(objects);
    rasterizer.render(world::lookAlong({0, 0, 1.35}, {1, 0.05 * (step - 12), -0.4}), image);
    images.push_back(image.rgb);
  }
  return images;
}

TEST(Rasterizer, EveryInstanceAndThreadDrawsTheSameBits) {
  auto world = world::handmadeKitchen(4, 6);
  const auto expected = episode(*world);
  EXPECT_TRUE(episode(*world) == expected);
  std::vector<std::vector<std::vector<std::uint8_t>>> images(3);
  std::vector<std::thread> threads;
  for (auto& of_thread : images) threads.emplace_back([&] { of_thread = episode(*world); });
  for (std::thread& thread : threads) thread.join();
  for (const auto& of_thread : images) EXPECT_TRUE(of_thread == expected);
  EXPECT_TRUE(episode(*world::handmadeKitchen(4, 6)) == expected) << "the image depends on the world::World's address";
}

TEST(Rasterizer, WhatWasDrawnBeforeLeavesNoTrace) {
  auto world = world::handmadeKitchen(4, 6);
  const Eigen::Isometry3d camera = world::lookAlong({0, 0, 1.35}, {1, 0, -0.4});
  Rasterizer used(*world, kSize), fresh(*world, kSize);
  core::Image first, again, expected;
  used.setObjects(world::handmadeScene(12, 4));
  used.render(world::lookAlong({0.8, 0, 1.0}, {1, 1, 0}), first);
  used.setObjects(world::handmadeScene(4, 4));
  used.render(camera, again);
  fresh.setObjects(world::handmadeScene(4, 4));
  fresh.render(camera, expected);
  EXPECT_TRUE(again.rgb == expected.rgb);
}

#ifndef EARLY_FUSION_COUNTS_NO_ALLOCATIONS
TEST(Rasterizer, RenderAllocatesNothingOnceWarm) {
  auto world = world::handmadeKitchen(4, 6);
  Rasterizer rasterizer(*world, kSize);
  core::Image image;
  rasterizer.setObjects(world::handmadeScene(8, 4));
  const auto look = [&](int step) {
    rasterizer.render(world::lookAlong({0, 0, 1.35}, {1, 0.05 * (step - 12), -0.4}), image);
  };
  for (int step = 0; step < 24; ++step) look(step);
  const long before = allocations;
  for (int step = 0; step < 24; ++step) look(step);
  EXPECT_EQ(allocations, before);
}
#endif

TEST(Rasterizer, ImageSizesOutOfRangeAreNamed) {
  const world::World world{};
  for (const int size : {0, -16, 100, 4096}) {
    try {
      Rasterizer rasterizer(world, size);
      ADD_FAILURE() << size << " was accepted";
    } catch (const core::Error& error) {
      EXPECT_NE(std::string(error.what()).find("image_size: '" + std::to_string(size) + "'"), std::string::npos);
    }
  }
  EXPECT_EQ(rendered(world, kAhead, 16).rgb.size(), 3u * 16 * 16);
}

}  // namespace
}  // namespace early_fusion::render
