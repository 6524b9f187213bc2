#include <benchmark/benchmark.h>

#include <cmath>

#include "early_fusion/render/rasterizer.h"
#include "world/handmade_world.h"

namespace early_fusion::render {
namespace {

constexpr int kItems = 16;
constexpr int kCells = 9;  // 972 triangles in a box, about as many in a ball
constexpr int kImageSize = 128;

const world::World& world() {
  static const std::shared_ptr<const world::World> kitchen = world::handmadeKitchen(kItems, kCells);
  return *kitchen;
}

/// A camera that pans over the counter, so that every frame is different.
Eigen::Isometry3d wanderingCamera(int frame) {
  const double pan = 0.5 * std::sin(0.013 * frame), tilt = 0.45 + 0.15 * std::sin(0.031 * frame);
  return world::lookAlong({0, 0, 1.35},
                          {std::cos(pan) * std::cos(tilt), std::sin(pan) * std::cos(tilt), -std::sin(tilt)});
}

/// Frames a second. The argument is the number of objects. Every thread has its own rasterizer.
void render(benchmark::State& state) {
  Rasterizer rasterizer(world(), kImageSize);
  rasterizer.setObjects(world::handmadeScene(static_cast<int>(state.range(0)), kItems));
  core::Image image;
  int frame = 1000 * state.thread_index();
  for (auto _ : state) {
    rasterizer.render(wanderingCamera(frame++), image);
    benchmark::DoNotOptimize(image.rgb.data());
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(render)->ArgName("objects")->Arg(4)->Arg(8)->Arg(12)->Threads(1)->Threads(2)->UseRealTime();

/// Draws the shadow map again, as at the start of an episode and after COLLECT and REMOVE.
void changeScene(benchmark::State& state) {
  Rasterizer rasterizer(world(), kImageSize);
  const std::vector<world::ObjectPose> all = world::handmadeScene(static_cast<int>(state.range(0)), kItems);
  const std::vector<world::ObjectPose> but_one(all.begin() + 1, all.end());
  bool complete = false;
  for (auto _ : state) rasterizer.setObjects((complete = !complete) ? all : but_one);
}
BENCHMARK(changeScene)->ArgName("objects")->Arg(8);

}  // namespace
}  // namespace early_fusion::render

BENCHMARK_MAIN();
