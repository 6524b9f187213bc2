#include "early_fusion/sim/tracked_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "early_fusion/core/error.h"
#include "early_fusion/world/world.h"
#include "experiment/temporary_folder.h"

namespace early_fusion::sim {
namespace {

constexpr std::int64_t kSecond = 1000000000;

core::Vocabulary items() { return core::Vocabulary({"can", "mug"}); }

TrackedScene twoMugsAndACan() { return {{{"tag_1", "mug"}, {"tag_2", "can"}, {"tag_3", "mug"}}, items(), 2}; }

Eigen::Isometry3d poseAt(double x, double y, double theta) {
  return Eigen::Translation3d(x, y, 0.9) * Eigen::AngleAxisd(theta, Eigen::Vector3d::UnitZ());
}

std::string errorOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const core::Error& error) {
    return error.what();
  }
  return "";
}

TEST(TrackedScene, PutsEachFramesItemWhereItWasSeen) {
  TrackedScene scene = twoMugsAndACan();
  scene.see(0, kSecond, poseAt(0.5, -0.25, 0));
  scene.see(2, kSecond, poseAt(0.75, 0.125, 0.5));
  EXPECT_EQ(scene.instances()[0], (Instance{1, 0.5, -0.25, 0}));
  EXPECT_EQ(scene.instances()[1], (Instance{0, 0, 0, 0}));
  EXPECT_EQ(scene.instances()[2].item, 1);
  EXPECT_EQ(scene.instances()[2].x, 0.75);
  EXPECT_NEAR(scene.instances()[2].theta, 0.5, 1e-12);
  EXPECT_EQ(scene.present(kSecond), 0b101u);
}

TEST(TrackedScene, AppliesTheTagsPlaceOnTheObjectInTheTagsAxes) {
  TrackedObject mug{"tag_1", "mug"};
  mug.frame_from_object.translation() = Eigen::Vector3d(0.25, 0, 0);
  TrackedScene scene({mug}, items(), 2);
  scene.see(0, kSecond, poseAt(1, 2, std::acos(-1.0) / 2));
  EXPECT_NEAR(scene.instances()[0].x, 1, 1e-12);
  EXPECT_NEAR(scene.instances()[0].y, 2.25, 1e-12);
}

TEST(TrackedScene, HoldsAnObjectThroughADropoutAndThenLeavesItOut) {
  TrackedScene scene = twoMugsAndACan();
  scene.see(1, kSecond, poseAt(0.5, 0, 0));
  EXPECT_EQ(scene.present(3 * kSecond), 0b010u);
  EXPECT_EQ(scene.present(3 * kSecond + 1), 0u);
  scene.see(1, 4 * kSecond, poseAt(0.5, 0, 0));
  EXPECT_EQ(scene.present(4 * kSecond), 0b010u);
}

TEST(TrackedScene, IgnoresASightingOlderThanTheLast) {
  TrackedScene scene = twoMugsAndACan();
  scene.see(0, 2 * kSecond, poseAt(0.5, 0, 0));
  scene.see(0, kSecond, poseAt(0.75, 0, 0));
  EXPECT_EQ(scene.instances()[0].x, 0.5);
}

TEST(TrackedScene, NeedsWhatWasTakenToBeSeenAgainBeforeTheNextEpisode) {
  TrackedScene scene = twoMugsAndACan();
  for (int i = 0; i < 3; ++i) scene.see(i, kSecond, poseAt(0.5, 0, 0));
  scene.take(2, kSecond);
  EXPECT_EQ(scene.present(kSecond), 0b011u);
  EXPECT_EQ(scene.taken(), std::vector<std::string>{"mug (tag_3)"});
  EXPECT_EQ(errorOf([&] { scene.beginEpisode(2 * kSecond); }), "not seen on the counter: mug (tag_3); put them back");
  scene.see(2, 2 * kSecond, poseAt(0.5, 0, 0));
  EXPECT_EQ(scene.present(2 * kSecond), 0b011u);
  scene.beginEpisode(2 * kSecond);
  EXPECT_EQ(scene.present(2 * kSecond), 0b111u);
  EXPECT_TRUE(scene.taken().empty());
}

TEST(TrackedScene, NamesABadFrameItemOrHold) {
  const auto make = [](std::vector<TrackedObject> objects, double hold_sec) {
    return errorOf([&] { TrackedScene(objects, items(), hold_sec); });
  };
  EXPECT_NE(make({{"a", "mug"}, {"a", "can"}}, 1).find("frame: 'a' is listed twice"), std::string::npos);
  EXPECT_NE(make({{"a", "bowl"}}, 1).find("bowl"), std::string::npos);
  EXPECT_NE(make({{"", "mug"}}, 1).find("frame: is empty"), std::string::npos);
  EXPECT_NE(make({{"a", "mug"}}, -1).find("hold_sec: -1"), std::string::npos);
  EXPECT_NE(make({}, 1).find("objects: 0"), std::string::npos);
}

TEST(TrackedScene, NamesTheFrameOfAPoseThatIsNotFinite) {
  TrackedScene scene = twoMugsAndACan();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(errorOf([&] { scene.see(1, kSecond, poseAt(nan, 0, 0)); }), "the pose of frame 'tag_2' is not finite");
}

TEST(AsTracked, HasErrorsOfTheGivenStandardDeviations) {
  constexpr int kCount = 10000;
  const std::vector<Instance> truth(kCount, Instance{1, 0.5, -0.25, 0.5});
  core::Random random(3);
  const std::vector<Instance> seen = asTracked(truth, {5, 2}, random);
  double x = 0, y = 0, theta = 0, x_squared = 0, y_squared = 0, theta_squared = 0;
  for (const Instance& instance : seen) {
    const double dx = instance.x - 0.5, dy = instance.y + 0.25, dtheta = instance.theta - 0.5;
    x += dx / kCount, y += dy / kCount, theta += dtheta / kCount;
    x_squared += dx * dx / kCount, y_squared += dy * dy / kCount, theta_squared += dtheta * dtheta / kCount;
    EXPECT_EQ(instance.item, 1);
  }
  for (const double mean : {x, y}) EXPECT_NEAR(mean, 0, 3e-4);
  for (const double square : {x_squared, y_squared}) EXPECT_NEAR(std::sqrt(square), 5e-3, 2e-4);
  EXPECT_NEAR(theta, 0, 3e-3);
  EXPECT_NEAR(std::sqrt(theta_squared), 2 * M_PI / 180, 1.5e-3);
  EXPECT_EQ(asTracked(truth, {}, random), truth);
}

TEST(NearestOrientation, IsThatOfTheNearestAxisUnlessTheCameraStandsElsewhere) {
  const auto world = world::loadWorld("");
  const world::Orientation orientation{3, 2};
  const Eigen::Isometry3d pose = world->rig.worldFromCamera(orientation);
  EXPECT_EQ(nearestOrientation(world->rig, pose), orientation);
  const double less_than_half_a_step = 0.4 * world::kStepRad;
  const Eigen::Isometry3d turned = pose * Eigen::AngleAxisd(less_than_half_a_step, Eigen::Vector3d::UnitX());
  EXPECT_EQ(nearestOrientation(world->rig, turned), orientation);
  const Eigen::Isometry3d beside = Eigen::Translation3d(0, 0.1, 0) * pose;
  EXPECT_NE(errorOf([&] { nearestOrientation(world->rig, beside); }).find("camera URDF"), std::string::npos);
  const Eigen::Isometry3d backwards = pose * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY());
  EXPECT_NE(errorOf([&] { nearestOrientation(world->rig, backwards); }).find("degrees from"), std::string::npos);
}

TEST(LoadTrackedObjects, ReadsFramesItemsAndPlaces) {
  const experiment::TemporaryFolder folder;
  const std::string file = folder.write(
      "tracked.yaml", "objects:\n  - {frame: tag_1, item: mug, position: [0.1, 0, -0.2], rotation: [0, 0, 90]}\n");
  const std::vector<TrackedObject> objects = loadTrackedObjects(file);
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_EQ(objects[0].frame, "tag_1");
  EXPECT_EQ(objects[0].item, "mug");
  const Eigen::Vector3d point = objects[0].frame_from_object * Eigen::Vector3d(1, 0, 0);
  EXPECT_TRUE(point.isApprox(Eigen::Vector3d(0.1, 1, -0.2), 1e-12)) << point;
}

TEST(LoadTrackedObjects, NamesFileLineAndValueOfAFault) {
  const experiment::TemporaryFolder folder;
  const auto faultOf = [&](const std::string& text) {
    return errorOf([&] { loadTrackedObjects(folder.write("tracked.yaml", text)); });
  };
  EXPECT_NE(faultOf("objects:\n  - {frame: a, item: mug, colour: red}\n").find(":2: unknown key 'colour'"),
            std::string::npos);
  EXPECT_NE(faultOf("objects:\n  - {frame: a}\n").find("needs a item"), std::string::npos);
  EXPECT_NE(faultOf("objects:\n  - {frame: a, item: mug, position: [1, 2]}\n").find("position is '[1, 2]'"),
            std::string::npos);
  EXPECT_NE(faultOf("things: []\n").find("needs 'objects'"), std::string::npos);
}

TEST(TrackedScene, ForgetsItsStampsWhenTheTimeJumpsBackButNotWhatWasTaken) {
  TrackedScene scene({{"mug_frame", "mug", Eigen::Isometry3d::Identity()},
                      {"box_frame", "cracker_box", Eigen::Isometry3d::Identity()}},
                     core::Vocabulary({"cracker_box", "mug"}), 1);
  constexpr std::int64_t kLate = 1000000000000, kEarly = 5000000000;
  for (const int object : {0, 1}) scene.see(object, kLate, Eigen::Isometry3d::Identity());
  scene.take(1, kLate);
  scene.forgetStamps();
  EXPECT_EQ(scene.present(kEarly), 0u);
  EXPECT_EQ(scene.taken(), (std::vector<std::string>{"cracker_box (box_frame)"}));
  for (const int object : {0, 1}) scene.see(object, kEarly, Eigen::Isometry3d::Identity());
  EXPECT_EQ(scene.present(kEarly), 0b01u);
  scene.beginEpisode(kEarly);
  EXPECT_EQ(scene.present(kEarly), 0b11u);
}

}  // namespace
}  // namespace early_fusion::sim
