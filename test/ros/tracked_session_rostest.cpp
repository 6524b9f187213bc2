// A session of training on the virtual robot, whose objects are tracked.
#include <early_fusion/Correction.h>
#include <early_fusion/Scene.h>
#include <early_fusion/Weights.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>

#include "early_fusion/core/random.h"
#include "early_fusion/learning/trajectory.h"
#include "early_fusion/ros/shared/conversions.h"
#include "early_fusion/ros/shared/topics.h"
#include "early_fusion/sim/cone_table.h"
#include "early_fusion/world/world.h"
#include "spin_until.h"

namespace early_fusion::nodes {
namespace {

constexpr std::uint64_t kSeed = 7;
constexpr std::size_t kRounds = 2;

class TrackedSessionTest : public testing::Test {
 protected:
  TrackedSessionTest() : world_(world::loadWorld("")) {
    scene_subscriber_ = node_.subscribe<Scene>(
        kSceneTopic, 100, [this](const SceneConstPtr& scene) { scenes_[scene->header.stamp] = scene; });
    correction_subscriber_ =
        node_.subscribe<Correction>(kCorrectionTopic, 100, [this](const CorrectionConstPtr& correction) {
          if (!correction->ends) corrections_.push_back(correction);
        });
    weights_subscriber_ = node_.subscribe<Weights>(
        kWeightsTopic, 10, [this](const WeightsConstPtr& weights) { weights_.insert(weights->id); });
  }

  void TearDown() override {
    std::string output;
    if (node_.getParam("correction_trainer/output", output)) std::filesystem::remove_all(output);
  }

  /// The objects of the virtual robot's scene, as it has placed them.
  std::vector<sim::Instance> placed(std::uint64_t number) const {
    const core::Request items = world_->objects.vocabulary().request({"mug", "banana", "cracker_box", "apple"});
    core::Random random(kSeed, {core::kEpisodeStream, number});
    return sim::sampleEpisodeOf(*world_, items, 1, random).instances;
  }

  /// The same instances in the order of the scene's.
  std::vector<sim::Instance> placedAs(const Scene& scene) const {
    std::vector<sim::Instance> ordered;
    for (const Instance& instance : scene.instances) {
      for (const sim::Instance& truth : placed(scene.episode)) {
        if (world_->objects.vocabulary().name(truth.item) == instance.item) ordered.push_back(truth);
      }
    }
    return ordered;
  }

  std::shared_ptr<const world::World> world_;
  ::ros::NodeHandle node_;
  std::map<::ros::Time, SceneConstPtr> scenes_;
  std::vector<CorrectionConstPtr> corrections_;
  std::set<std::string> weights_;
  ::ros::Subscriber scene_subscriber_, correction_subscriber_, weights_subscriber_;
};

TEST_F(TrackedSessionTest, LabelsRealImagesAsTheSimulatorWouldAndLearnsFromThem) {
  double noise_mm = 0;
  ::ros::NodeHandle("~").getParam("noise", noise_mm);
  const double tolerance_m = noise_mm > 0 ? 6e-3 * noise_mm : 1e-6;
  ASSERT_TRUE(spinUntil([&] { return weights_.size() > kRounds; }, 540))
      << weights_.size() << " weights, " << scenes_.size() << " scenes, " << corrections_.size() << " corrections";
  ASSERT_FALSE(corrections_.empty());
  std::map<std::uint64_t, std::vector<int>> pans;  // by episode
  std::size_t labelled = 0;
  for (const CorrectionConstPtr& correction : corrections_) {
    const auto found = scenes_.find(correction->header.stamp);
    if (found == scenes_.end()) continue;  // before the first scene came here
    const Scene& scene = *found->second;
    const std::vector<sim::Instance> truth = placedAs(scene);
    ASSERT_EQ(truth.size(), 4u);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      EXPECT_NEAR(scene.instances[i].x, truth[i].x, tolerance_m);
      EXPECT_NEAR(scene.instances[i].y, truth[i].y, tolerance_m);
      EXPECT_NEAR(std::remainder(scene.instances[i].theta - truth[i].theta, 2 * M_PI), 0, 1e-6);
    }
    ++labelled;
    if (noise_mm > 0) continue;  // then an expert that sees the truth may say something else
    const SceneState now = sceneState(scene, world_->objects.vocabulary(), world_->rig.lattice());
    pans[scene.episode].push_back(scene.pan);
    const sim::ConeTable cone(*world_, truth);
    const expert::Label label =
        learning::trainingLabel(learning::TrainingExpert::kSearching, cone, truth, now.state,
                                expert::panDirectionOver(pans[scene.episode]), now.state.request);
    const bool right = expert::contains(label.optimal, core::actionFromName(correction->policy));
    EXPECT_EQ(correction->confirmed, right) << correction->policy;
    EXPECT_EQ(correction->person, right ? "" : core::actionName(label.action));
  }
  EXPECT_GT(labelled, 2u);
}

}  // namespace
}  // namespace early_fusion::nodes

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "tracked_session_rostest");
  ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
