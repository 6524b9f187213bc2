#include "early_fusion/expert/searching_expert.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "early_fusion/sim/episode.h"
#include "world/test_world.h"

namespace early_fusion::expert {
namespace {

using core::Action;
using world::Orientation;

const world::World& world() {
  static const std::shared_ptr<const world::World> world = world::loadWorld("");
  return *world;
}

const core::Vocabulary& vocabulary() { return world().objects.vocabulary(); }

constexpr char kFarLeft[] = "peach", kFarRight[] = "rubiks_cube";

/// The expert's actions in a scene with these two instances.
Action atApart(Orientation orientation, PanDirection pan_direction, const std::vector<std::string>& request) {
  static const std::vector<sim::Instance> instances = {{vocabulary().index(kFarLeft), 0.75, 0.5, 0},
                                                       {vocabulary().index(kFarRight), 0.75, -0.5, 0}};
  static const sim::ConeTable cone(world(), instances);
  return searchingLabel(cone, instances, 0b11, orientation, pan_direction, vocabulary().request(request)).action;
}

TEST(SearchingExpert, KeepsToItsPanDirectionUntilTheViewHoldsThatSide) {
  EXPECT_EQ(atApart({5, 12}, PanDirection::kLeft, {kFarRight}), Action::kPanLeft);
  EXPECT_EQ(atApart({5, 12}, PanDirection::kRight, {kFarRight}), Action::kPanRight);
  EXPECT_EQ(atApart({-5, 12}, PanDirection::kRight, {kFarLeft}), Action::kPanRight);
  EXPECT_EQ(atApart({24, 12}, PanDirection::kLeft, {kFarRight}), Action::kPanRight);
  EXPECT_EQ(atApart({-24, 12}, PanDirection::kRight, {kFarLeft}), Action::kPanLeft);
}

TEST(SearchingExpert, StartsWithTheNearerEnd) {
  EXPECT_EQ(atApart({6, 12}, PanDirection::kStart, {kFarRight}), Action::kPanLeft);
  EXPECT_EQ(atApart({-6, 12}, PanDirection::kStart, {kFarLeft}), Action::kPanRight);
  EXPECT_EQ(atApart({12, 12}, PanDirection::kStart, {kFarRight}), Action::kPanRight)
      << "the view holds that end already";
}

TEST(SearchingExpert, GoesAcrossTheMiddleWithoutAPanDirection) {
  EXPECT_EQ(atApart({6, 12}, PanDirection::kNone, {kFarRight}), Action::kPanRight);
  EXPECT_EQ(atApart({-6, 12}, PanDirection::kNone, {kFarLeft}), Action::kPanLeft);
}

TEST(SearchingExpert, TiltsBeforeItTurnsWhereFrontOrBackIsOutOfView) {
  EXPECT_EQ(atApart({24, 22}, PanDirection::kLeft, {kFarRight}), Action::kTiltUp);
  EXPECT_EQ(atApart({24, 1}, PanDirection::kLeft, {kFarRight}), Action::kTiltDown);
  EXPECT_EQ(atApart({0, 1}, PanDirection::kLeft, {kFarRight}), Action::kPanLeft);
}

/// The shipped world with one text of its world file or its camera's URDF replaced.
std::shared_ptr<const world::World> worldWith(const std::string& name, const std::string& from, const std::string& to) {
  const world::TestFolder folder;
  for (const char* file : {"config/world.yaml", "urdf/pan_tilt_camera.urdf"}) {
    const std::string path = core::shareFolder() + "/" + file;
    const std::string text = core::readFile(path);
    folder.write(file, path.find(name) == std::string::npos ? text : world::replaced(text, from, to));
  }
  for (const char* file : {"config/objects.yaml", "urdf/kitchen.urdf", "meshes"}) {
    std::filesystem::create_symlink(core::shareFolder() + "/" + file, folder.path() + "/" + file);
  }
  return world::loadWorld(folder.path() + "/config/world.yaml");
}

TEST(SearchingExpert, LooksFromEndToEndWhicheverWayTheCameraIsBuilt) {
  const auto wide_tilt = worldWith("camera.urdf", "upper=\"0.767945\"", "upper=\"1.396264\"");
  const auto mostly_left = worldWith("camera.urdf", "upper=\"0.907572\"", "upper=\"1.745330\"");
  const auto narrow_view = worldWith("world.yaml", "horizontal_fov_deg: 60", "horizontal_fov_deg: 40");
  for (const auto& other : {wide_tilt, mostly_left, narrow_view}) {
    const std::vector<sim::Instance> instances = {{0, -2, 0, 0}};  // behind the camera
    const sim::ConeTable cone(*other, instances);
    const Orientation lowest = cone.lattice().lowest, highest = cone.lattice().highest;
    for (const int tilt : {lowest.tilt, highest.tilt}) {
      Orientation at{highest.pan - 1, tilt};
      std::vector<int> pans;
      for (int step = 0; step < 300; ++step) {
        pans.push_back(at.pan);
        at = world::turned(at, searchingLabel(cone, instances, 1, at, panDirectionOver(pans), {0}).action);
        ASSERT_TRUE(cone.lattice().contains(at));
      }
      for (auto half = pans.begin(); half != pans.end(); half += 150) {
        EXPECT_GE(*std::max_element(half, half + 150), highest.pan - cone.viewSteps() - 1);
        EXPECT_LE(*std::min_element(half, half + 150), lowest.pan + cone.viewSteps() + 1);
      }
    }
  }
  const sim::ConeTable cone(*mostly_left, {{0, -2, 0, 0}});
  EXPECT_EQ(searchingLabel(cone, {{0, -2, 0, 0}}, 1, {8, 12}, PanDirection::kStart, {0}).action, Action::kPanRight);
}

TEST(SearchingExpert, RemovesOnTheWayWhatIsLargeEnoughToHideSomething) {
  for (const auto& [name, is_removed] : {std::pair("cracker_box", true), std::pair("peach", false)}) {
    const std::vector<sim::Instance> instances = {{vocabulary().index(name), 0.65, -0.3, 0},
                                                  {vocabulary().index("mug"), 0.75, 0.5, 0}};
    const sim::ConeTable cone(world(), instances);
    const std::vector<Orientation>& ahead = cone.orientationsOf(0);
    const Orientation at_it = ahead[ahead.size() / 2];
    ASSERT_FALSE(isInView(cone, 1, at_it));
    const auto action = [&](sim::InstanceMask present, const std::string& requested) {
      return searchingLabel(cone, instances, present, at_it, PanDirection::kLeft, vocabulary().request({requested}))
          .action;
    };
    EXPECT_EQ(action(0b11, "mug"), is_removed ? Action::kRemove : Action::kPanLeft) << name;
    EXPECT_EQ(action(0b10, "mug"), Action::kPanLeft) << "it is gone";
    EXPECT_EQ(action(0b11, name), Action::kCollect) << name;
    EXPECT_EQ(action(0b01, "mug"), Action::kIdle) << "nothing is left to look for";
  }
}

TEST(SearchingExpert, IdlesWhenNothingRequestedIsThere) {
  EXPECT_EQ(atApart({0, 12}, PanDirection::kLeft, {}), Action::kIdle);
  EXPECT_EQ(atApart({0, 12}, PanDirection::kLeft, {"mug"}), Action::kIdle);
}

TEST(SearchingExpert, IsTheGreedyExpertForWhatIsInView) {
  const sim::Task task = sim::loadTask("hard");
  std::map<bool, int> cases;
  for (std::uint64_t number = 0; number < 40; ++number) {
    const sim::Episode episode(world(), {task, 3, number});
    const std::vector<sim::Instance>& instances = episode.setup().instances;
    const sim::EpisodeState& state = episode.state();
    // If an item has one instance, the expert must go for it in view, and must not know of it out of view.
    for (std::size_t i = 0; i < instances.size(); ++i) {
      const auto same = std::count_if(instances.begin(), instances.end(),
                                      [&](const sim::Instance& other) { return other.item == instances[i].item; });
      if (same > 1) continue;
      const core::Request request{instances[i].item};
      const auto search = [&](PanDirection pan_direction) {
        return searchingLabel(episode.cone(), instances, state.present, state.orientation, pan_direction, request);
      };
      const Label left = search(PanDirection::kLeft), right = search(PanDirection::kRight);
      const bool in_view = isInView(episode.cone(), static_cast<int>(i), state.orientation);
      ++cases[in_view];
      if (in_view) {
        const Label greedy = label(episode.cone(), instances, state.present, state.orientation, request);
        EXPECT_EQ(left.action, greedy.action);
        EXPECT_EQ(left.optimal, greedy.optimal);
        EXPECT_EQ(left.steps, greedy.steps);
        EXPECT_EQ(left.action, right.action);
      } else {
        const bool turns = std::abs(state.orientation.pan) >= 10;  // with one of the pan directions
        if (left.action == Action::kRemove) {
          EXPECT_EQ(right.action, Action::kRemove);
          EXPECT_GE(episode.cone().nearest(state.orientation, state.present), 0);
        } else {
          EXPECT_EQ(left.action == right.action, turns && state.orientation.tilt >= 9 && state.orientation.tilt <= 14);
        }
        EXPECT_EQ(left.optimal, 1u << static_cast<int>(left.action));
        EXPECT_EQ(left.steps, 0);
      }
    }
  }
  EXPECT_GT(cases[true], 50);
  EXPECT_GT(cases[false], 50);
}

TEST(SearchingExpert, InViewMeansThatItsMiddleOrMoreIsInTheFrame) {
  core::Random random(4);
  const sim::Task task = sim::loadTask("hard");
  const double half_fov = 0.5 * world().options.horizontal_fov_deg * M_PI / 180;
  for (std::uint64_t number = 0; number < 40; ++number) {
    const sim::Episode episode(world(), {task, 4, number});
    const Orientation from = episode.state().orientation;
    for (std::size_t i = 0; i < episode.setup().instances.size(); ++i) {
      const sim::Instance& instance = episode.setup().instances[i];
      const Eigen::Vector3d middle(0, 0, 0.5 * world().objects[instance.item].mesh.bounds().max().z());
      const Eigen::Vector3d seen =
          world().rig.worldFromCamera(from).inverse() * (sim::worldFromObject(world(), instance) * middle);
      const double off_axis =
          std::max(std::abs(std::atan2(seen.x(), seen.z())), std::abs(std::atan2(seen.y(), seen.z())));
      const bool in_view = isInView(episode.cone(), static_cast<int>(i), from);
      EXPECT_TRUE(in_view || off_axis > half_fov - 0.12) << off_axis;
      EXPECT_TRUE(!in_view || off_axis < half_fov + 0.20) << off_axis;
    }
  }
}

class SearchingExpertIn : public testing::TestWithParam<std::pair<const char*, double>> {};

// The F1 that is possible without knowledge of unseen objects. On these scenes the greedy expert has 0.982, 0.985 and
// 0.973.
TEST_P(SearchingExpertIn, FindsNearlyAllInTime) {
  const auto& [name, min_f1] = GetParam();
  const sim::Task task = sim::loadTask(name);
  constexpr int kEpisodes = 500;
  double f1 = 0;
  for (std::uint64_t number = 0; number < kEpisodes; ++number) {
    sim::Episode episode(world(), {task, 5, number});
    std::vector<int> pans;
    while (!episode.finished()) {
      const sim::EpisodeState state = episode.state();
      pans.push_back(state.orientation.pan);
      const PanDirection pan_direction = panDirectionOver(pans);
      episode.step(searchingLabel(episode.cone(), episode.setup().instances, state.present, state.orientation,
                                  pan_direction, state.request)
                       .action);
    }
    f1 += episode.score().f1 / kEpisodes;
  }
  EXPECT_GE(f1, min_f1);
  RecordProperty("f1", std::to_string(f1));
}

INSTANTIATE_TEST_SUITE_P(AllTasks, SearchingExpertIn,
                         testing::Values(std::pair("simple", 0.96), std::pair("medium", 0.96), std::pair("hard", 0.95)),
                         [](const auto& info) { return info.param.first; });

}  // namespace
}  // namespace early_fusion::expert
