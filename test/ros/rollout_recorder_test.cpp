#include "early_fusion/ros/trainer/rollout_recorder.h"

#include <gtest/gtest.h>

#include "early_fusion/core/error.h"
#include "early_fusion/learning/agent.h"
#include "early_fusion/learning/rollout.h"
#include "early_fusion/render/rasterizer.h"
#include "early_fusion/ros/shared/conversions.h"
#include "learning/small_session.h"

namespace early_fusion::nodes {
namespace {

/// The four messages of one step.
struct Messages {
  sensor_msgs::ImagePtr image;
  Request request;
  Scene scene;
  Action action;
};

class RolloutRecorderTest : public testing::Test {
 protected:
  static constexpr std::uint64_t kSeed = 4;

  RolloutRecorderTest() {
    plan_.goal.task = sim::taskText(sim::loadTask(files_.task()));
    plan_.goal.seed = kSeed;
    plan_.goal.first_episode = 10;
    plan_.goal.episodes = 3;
    plan_.weights = "w";
    plan_.mode = "sample";
    recorder_ = std::make_unique<RolloutRecorder>(*world_, plan_);
  }

  /// What a simulator and a policy say of an episode that the expert drives, while the policy answers IDLE.
  std::vector<Messages> playDriven(std::uint64_t number) {
    std::vector<Messages> steps = play(number);
    for (Messages& messages : steps) messages.action.name = "IDLE";
    return steps;
  }

  /// What a simulator and a policy say of an episode that the expert plays; TILT_UP first where `blunder` is set.
  std::vector<Messages> play(std::uint64_t number, bool blunder = false) {
    sim::Episode episode(*world_, {task_, kSeed, number});
    std::vector<Messages> steps;
    std::string previous;
    while (!episode.finished()) {
      const core::Action right = expert::decide(episode).action;
      const core::Action wrong = right == core::Action::kTiltUp ? core::Action::kTiltDown : core::Action::kTiltUp;
      const core::Action action = blunder && steps.empty() ? wrong : right;
      steps.push_back(step(episode, number, previous, action));
      previous = core::actionName(action);
      episode.step(action);
    }
    return steps;
  }

  Messages step(const sim::Episode& episode, std::uint64_t number, const std::string& previous, core::Action action) {
    const sim::EpisodeKey key{task_, kSeed, number};
    const core::Vocabulary& vocabulary = world_->objects.vocabulary();
    std_msgs::Header header;
    header.stamp = ::ros::Time(100, stamp_++);
    core::Image image;
    rasterizer_.setObjects(sim::presentObjects(*world_, episode.setup().instances, episode.state().present));
    rasterizer_.render(world_->rig.worldFromCamera(episode.state().orientation), image);
    Messages messages{imageMessage(image, header), requestMessage(episode, key, vocabulary, header),
                      sceneMessage(episode, key, vocabulary, previous, header), Action()};
    messages.action.header = header;
    messages.action.episode = number;
    messages.action.step = episode.state().step;
    messages.action.name = core::actionName(action);
    messages.action.weights = "w";
    messages.action.mode = "sample";
    messages.action.frames = std::min(3, episode.state().step + 1);
    return messages;
  }

  const learning::TrajectoryStep* add(const Messages& messages) {
    return recorder_->add(*messages.image, messages.request, messages.scene, messages.action);
  }
  void addAll(const std::vector<Messages>& steps) {
    for (const Messages& messages : steps) add(messages);
  }

  /// @return the recorder's error for these messages.
  std::string complaint(const Messages& messages) {
    try {
      add(messages);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "";
  }

  const learning::SmallSession files_;
  const std::shared_ptr<const world::World> world_ = world::loadWorld(files_.world());
  sim::Task task_ = sim::loadTask(files_.task());
  render::Rasterizer rasterizer_{*world_, learning::SmallSession::kImageSize};
  RolloutPlan plan_;
  std::unique_ptr<RolloutRecorder> recorder_;
  std::uint32_t stamp_ = 1;
};

TEST_F(RolloutRecorderTest, RecordsWhatARolloutInOneProcessDoes) {
  for (std::uint64_t number : {10, 11, 12}) addAll(play(number));
  std::vector<learning::Trajectory> wanted;
  learning::RolloutRunner runner(*world_, task_, kSeed);
  runner.run(10, 3, *learning::makeExpertAgent(), true,
             [&](learning::Trajectory trajectory) { wanted.push_back(std::move(trajectory)); });
  for (const learning::Trajectory& trajectory : wanted) {
    const std::optional<learning::Trajectory> recorded = recorder_->next();
    ASSERT_TRUE(recorded);
    EXPECT_EQ(recorded->episode, trajectory.episode);
    EXPECT_EQ(recorded->score.f1, trajectory.score.f1);
    ASSERT_EQ(recorded->steps.size(), trajectory.steps.size());
    for (std::size_t i = 0; i < trajectory.steps.size(); ++i) {
      EXPECT_EQ(*recorded->steps[i].frame, *trajectory.steps[i].frame);
      EXPECT_EQ(recorded->steps[i].repeats, trajectory.steps[i].repeats);
      EXPECT_EQ(recorded->steps[i].action, trajectory.steps[i].action);
      EXPECT_EQ(recorded->steps[i].label.action, trajectory.steps[i].label.action);
      EXPECT_EQ(recorded->steps[i].label.optimal, trajectory.steps[i].label.optimal);
      EXPECT_EQ(recorded->steps[i].request, trajectory.steps[i].request);
      ASSERT_EQ(recorded->steps[i].labelled_requests.size(), trajectory.steps[i].labelled_requests.size());
      for (std::size_t k = 0; k < trajectory.steps[i].labelled_requests.size(); ++k) {
        EXPECT_EQ(recorded->steps[i].labelled_requests[k].request, trajectory.steps[i].labelled_requests[k].request);
        EXPECT_EQ(recorded->steps[i].labelled_requests[k].label.action,
                  trajectory.steps[i].labelled_requests[k].label.action);
      }
    }
  }
  EXPECT_TRUE(recorder_->complete());
  EXPECT_FALSE(recorder_->next());
}

TEST_F(RolloutRecorderTest, HandsTrajectoriesOutInOrderWhateverOrderTheyCameIn) {
  addAll(play(11));
  EXPECT_FALSE(recorder_->next());
  EXPECT_EQ(recorder_->missing(), std::make_pair(std::uint64_t{10}, std::uint64_t{11}));
  addAll(play(10));
  EXPECT_EQ(recorder_->next()->episode, 10u);
  EXPECT_EQ(recorder_->next()->episode, 11u);
  EXPECT_EQ(recorder_->missing(), std::make_pair(std::uint64_t{12}, std::uint64_t{13}));
}

TEST_F(RolloutRecorderTest, IgnoresWhatIsNotOfThePlan) {
  std::vector<Messages> other = play(13);
  EXPECT_EQ(add(other[0]), nullptr);
  std::vector<Messages> foreign = play(10);
  foreign[0].scene.seed = 99;
  EXPECT_EQ(add(foreign[0]), nullptr);
  foreign = play(10);
  foreign[0].scene.task = "other";
  EXPECT_EQ(add(foreign[0]), nullptr);
  EXPECT_NE(add(play(10)[0]), nullptr);
}

TEST_F(RolloutRecorderTest, DropsAnEpisodeOfTheSameNumberThatIsNotThePlans) {
  const std::vector<Messages> own = play(10);
  task_ = sim::withUpTo(6, task_);
  const std::vector<Messages> other = play(10);
  EXPECT_NE(complaint(other[0]).find("is not the episode of task 'short', seed"), std::string::npos);
  std::vector<Messages> moved = own;
  moved[0].scene.instances[0].x += 1e-9;
  EXPECT_NE(complaint(moved[0]).find("is not the episode"), std::string::npos);
  EXPECT_NE(add(own[0]), nullptr);
  plan_.goal.max_instances = 6;
  recorder_ = std::make_unique<RolloutRecorder>(*world_, plan_);
  EXPECT_NE(complaint(own[0]).find("up to 6 objects"), std::string::npos);
  EXPECT_NE(add(other[0]), nullptr);
}

TEST_F(RolloutRecorderTest, IgnoresAStepThatIsPublishedAgain) {
  const std::vector<Messages> steps = play(10);
  for (const Messages& messages : steps) {
    EXPECT_NE(add(messages), nullptr);
    EXPECT_EQ(add(messages), nullptr);
  }
  EXPECT_EQ(recorder_->next()->steps.size(), steps.size());
}

TEST_F(RolloutRecorderTest, DropsAnEpisodeWithAMissingStep) {
  const std::vector<Messages> steps = play(10);
  add(steps[0]);
  add(steps[1]);
  EXPECT_NE(complaint(steps[3]).find("does not follow"), std::string::npos);
  for (std::size_t i = 4; i < steps.size(); ++i) EXPECT_EQ(add(steps[i]), nullptr);
  EXPECT_FALSE(recorder_->next());
  addAll(play(10));
  EXPECT_TRUE(recorder_->next());
}

TEST_F(RolloutRecorderTest, DropsAnEpisodeOfAPolicyThatHasNotSeenItsBeginning) {
  std::vector<Messages> steps = play(10);
  add(steps[0]);
  add(steps[1]);
  steps[2].action.frames = 1;
  EXPECT_NE(complaint(steps[2]).find("from its beginning"), std::string::npos);
  EXPECT_EQ(add(steps[3]), nullptr);
}

TEST_F(RolloutRecorderTest, DropsAnEpisodeOfOtherWeightsOrAnotherMode) {
  std::vector<Messages> steps = play(10);
  steps[0].action.weights = "old";
  EXPECT_NE(complaint(steps[0]).find("'old'"), std::string::npos);
  steps = play(10);
  steps[0].action.mode = "argmax";
  EXPECT_NE(complaint(steps[0]).find("argmax"), std::string::npos);
  steps = play(10);
  steps[0].action.weights = steps[0].action.mode = std::string(100000, 'x');
  EXPECT_NE(complaint(steps[0]).find("xxx... (100000 bytes)"), std::string::npos);
  EXPECT_LT(complaint(steps[0]).size(), 1000u) << "a foreign text is shown whole";
}

TEST_F(RolloutRecorderTest, DropsAnEpisodeWhoseStateDoesNotFollowFromItsActions) {
  const std::vector<Messages> one = play(10), other = play(10, true);
  ASSERT_NE(one[0].action.name, other[0].action.name);
  add(one[0]);
  // The simulator took another action than the one that was seen: two policies, or one that was replaced.
  EXPECT_NE(complaint(other[1]).find("does not follow"), std::string::npos);
}

TEST_F(RolloutRecorderTest, ANewBeginningReplacesAnEpisodeThatWasCutOff) {
  const std::vector<Messages> cut = play(10), whole = play(10);
  add(cut[0]);
  add(cut[1]);
  addAll(whole);
  EXPECT_EQ(recorder_->next()->steps.size(), whole.size());
}

TEST_F(RolloutRecorderTest, WhereTheExpertDrivesItsActionIsRecordedAndNotThePolicys) {
  plan_.goal.expert_share = 1;
  recorder_ = std::make_unique<RolloutRecorder>(*world_, plan_);
  addAll(playDriven(10));
  const std::optional<learning::Trajectory> recorded = recorder_->next();
  ASSERT_TRUE(recorded);
  EXPECT_EQ(recorded->agreement(), 1);
  learning::RolloutRunner(*world_, task_, kSeed)
      .run(10, 1, *learning::makeExpertAgent(), true, [&](const auto& wanted) {
        EXPECT_EQ(recorded->score.f1, wanted.score.f1);
        for (std::size_t s = 0; s < wanted.steps.size(); ++s) {
          EXPECT_EQ(recorded->steps[s].action, wanted.steps[s].action);
          EXPECT_EQ(*recorded->steps[s].frame, *wanted.steps[s].frame);
        }
      });
}

TEST_F(RolloutRecorderTest, RefusesASimulatorThatDrivesOtherSteps) {
  const std::vector<Messages> driven = playDriven(10);
  add(driven[0]);
  EXPECT_NE(complaint(driven[1]).find("does not follow from the previous step"), std::string::npos);
}

TEST_F(RolloutRecorderTest, RefusesAPlanThatNobodyCanDrive) {
  const auto refusal = [&]() -> std::string {
    try {
      RolloutRecorder(*world_, plan_);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "accepted";
  };
  plan_.goal.expert_share = 1.5;
  EXPECT_NE(refusal().find("expert_share is 1.5"), std::string::npos) << refusal();
  plan_.goal.expert_share = 0.5;
  plan_.goal.expert_share_per = "day";
  EXPECT_NE(refusal().find("'day'"), std::string::npos) << refusal();
  plan_.goal.expert_share_per = "step";
  plan_.goal.training_expert = "wise";
  EXPECT_NE(refusal().find("'wise'"), std::string::npos) << refusal();
}

TEST_F(RolloutRecorderTest, RefusesAnImageOfAnotherSize) {
  std::vector<Messages> steps = play(10);
  steps[0].image->width = 16;
  EXPECT_NE(complaint(steps[0]).find("16 x 32"), std::string::npos);
}

}  // namespace
}  // namespace early_fusion::nodes
