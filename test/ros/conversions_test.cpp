#include "early_fusion/ros/shared/conversions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "early_fusion/core/error.h"
#include "learning/small_session.h"

namespace early_fusion::nodes {
namespace {

std::string errorOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const core::Error& error) {
    return error.what();
  }
  return "no error";
}

class ConversionsTest : public testing::Test {
 protected:
  Scene scene() const { return sceneMessage(episode_, key_, world_->objects.vocabulary(), "PAN_LEFT", header_); }
  SceneState parse(const Scene& scene) const {
    return sceneState(scene, world_->objects.vocabulary(), world_->rig.lattice());
  }

  const learning::SmallSession files_;
  const std::shared_ptr<const world::World> world_ = world::loadWorld(files_.world());
  const sim::EpisodeKey key_{sim::loadTask("hard"), 5, 9};
  sim::Episode episode_{*world_, key_};
  std_msgs::Header header_;
};

TEST_F(ConversionsTest, AnImageKeepsItsPixelsAndHasNoPadding) {
  core::Image image(4, 2);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = static_cast<std::uint8_t>(i);
  header_.frame_id = "camera";
  const auto message = imageMessage(image, header_);
  EXPECT_EQ(message->encoding, "rgb8");
  EXPECT_EQ(message->width, 4u);
  EXPECT_EQ(message->height, 2u);
  EXPECT_EQ(message->step, 12u);
  EXPECT_EQ(message->data, image.rgb);
  EXPECT_EQ(message->header.frame_id, "camera");
}

TEST_F(ConversionsTest, IntrinsicsProjectTheFieldOfViewOntoTheImagesEdges) {
  const sensor_msgs::CameraInfo info = cameraInfoMessage(128, 60, header_);
  // A ray at half the field of view meets the outer edge of the last pixel, half a pixel beyond its centre.
  const double u = info.K[0] * std::tan(30 * M_PI / 180) + info.K[2];
  EXPECT_NEAR(u, 127.5, 1e-9);
  EXPECT_DOUBLE_EQ(info.K[0], info.K[4]);
  EXPECT_DOUBLE_EQ(info.K[5], 63.5);
  EXPECT_DOUBLE_EQ(info.P[0], info.K[0]);
  EXPECT_EQ(info.D.size(), 5u);
}

TEST_F(ConversionsTest, JointStatesAreNamedRadians) {
  const sensor_msgs::JointState state = jointStateMessage(world_->rig, {3, -2}, header_);
  EXPECT_EQ(state.name, (std::vector<std::string>{"pan_joint", "tilt_joint"}));
  EXPECT_NEAR(state.position[0], 6 * M_PI / 180, 1e-12);
  EXPECT_NEAR(state.position[1], -4 * M_PI / 180, 1e-12);
}

TEST_F(ConversionsTest, ASceneComesBackBitForBit) {
  episode_.step(core::Action::kPanLeft);
  const SceneState state = parse(scene());
  ASSERT_EQ(state.instances.size(), episode_.setup().instances.size());
  for (std::size_t i = 0; i < state.instances.size(); ++i) {
    EXPECT_EQ(state.instances[i].item, episode_.setup().instances[i].item);
    EXPECT_EQ(state.instances[i].x, episode_.setup().instances[i].x);
    EXPECT_EQ(state.instances[i].y, episode_.setup().instances[i].y);
    EXPECT_EQ(state.instances[i].theta, episode_.setup().instances[i].theta);
  }
  EXPECT_EQ(state.state.step, 1);
  EXPECT_EQ(state.state.present, episode_.state().present);
  EXPECT_EQ(state.state.orientation, episode_.state().orientation);
  EXPECT_EQ(state.state.request, episode_.state().request);
}

TEST_F(ConversionsTest, AGoalNamesItsFirstEpisode) {
  RunEpisodesGoal goal;
  goal.task = "hard";
  goal.max_instances = 20;
  goal.seed = 5;
  goal.first_episode = 9;
  const sim::EpisodeKey key = firstEpisode(goal);
  EXPECT_EQ(key.task.name, "hard");
  EXPECT_EQ(key.task.instances, 12);
  EXPECT_EQ(key.task.maxInstances(), 20);
  EXPECT_EQ(key.seed, 5u);
  EXPECT_EQ(key.number, 9u);
  goal.max_instances = 4000000000u;
  EXPECT_NE(errorOf([&] { firstEpisode(goal); }).find("max_instances is 4000000000"), std::string::npos);
}

TEST_F(ConversionsTest, AGoalNamesTheRequestsAndTheLookOfItsEpisodes) {
  RunEpisodesGoal goal;
  goal.task = "hard";
  EXPECT_EQ(firstEpisode(goal).task.pairs, sim::PairChoice::kAll);
  setEpisodes(sim::withPairs("held_out", {0.25, 4}, sim::loadTask("hard")), goal);
  const sim::Task task = firstEpisode(goal).task;
  EXPECT_EQ(task.pairs, sim::PairChoice::kHeldOut);
  EXPECT_EQ(task.pair_split.held_out_pairs, 0.25);
  EXPECT_EQ(task.pair_split.held_out_pairs_seed, 4u);
  EXPECT_TRUE(task.randomisation.isNone());
  sim::Task noisy = task;
  noisy.randomisation.noise = 2.5;
  noisy.randomisation.looks = 3;
  setEpisodes(noisy, goal);
  EXPECT_EQ(firstEpisode(goal).task.randomisation.noise, 2.5);
  EXPECT_EQ(firstEpisode(goal).task.randomisation.looks, 3);
  goal.randomisation = "{noise: 1e9}";
  EXPECT_NE(errorOf([&] { firstEpisode(goal); }).find("randomisation:1: noise: '1e9' is out of range"),
            std::string::npos)
      << errorOf([&] { firstEpisode(goal); });
  goal.randomisation = "/etc/shadow";
  EXPECT_NE(errorOf([&] { firstEpisode(goal); }), "");
  goal.randomisation.clear();
  goal.held_out_pairs = 2;
  EXPECT_NE(errorOf([&] { firstEpisode(goal); }).find("held_out_pairs: '2' is out of range"), std::string::npos);
  goal.held_out_pairs = 0.5;
  goal.pairs = "some";
  EXPECT_NE(errorOf([&] { firstEpisode(goal); }).find("'some'"), std::string::npos);
}

TEST_F(ConversionsTest, AScenesFieldsNameItsEpisode) {
  EXPECT_EQ(scene().task, "hard");
  EXPECT_EQ(scene().seed, 5u);
  EXPECT_EQ(scene().episode, 9u);
  EXPECT_EQ(scene().steps, 48u);
}

TEST_F(ConversionsTest, TheRequestIsReadable) {
  const Request request = requestMessage(episode_, key_, world_->objects.vocabulary(), header_);
  EXPECT_EQ(request.episode, 9u);
  EXPECT_EQ(request.step, 0u);
  EXPECT_EQ(request.items, world_->objects.vocabulary().names(episode_.state().request));
  EXPECT_EQ(request.items.size(), 3u);
}

TEST_F(ConversionsTest, AnEpisodesResultCarriesItsScore) {
  while (!episode_.finished()) episode_.step(core::Action::kCollect);
  const EpisodeResult result = episodeResultMessage(episode_, key_, header_);
  EXPECT_EQ(result.requested, 3u);
  EXPECT_EQ(result.steps, 48u);
  EXPECT_EQ(result.seed, 5u);
  EXPECT_EQ(result.f1, episode_.score().f1);
  EXPECT_EQ(result.collected, static_cast<std::uint32_t>(episode_.collectedCount()));
}

TEST_F(ConversionsTest, ASceneThatCannotBeIsRefusedWithTheReason) {
  Scene unknown = scene();
  unknown.instances[0].item = "anvil";
  EXPECT_NE(errorOf([&] { parse(unknown); }).find("anvil"), std::string::npos);

  Scene infinite = scene();
  infinite.instances[1].x = INFINITY;
  EXPECT_NE(errorOf([&] { parse(infinite); }).find("not finite"), std::string::npos);
  infinite.instances[1].item = std::string(100000, 'x');
  EXPECT_LT(errorOf([&] { parse(infinite); }).size(), 1000u) << "a foreign text is shown whole";

  Scene turned = scene();
  turned.pan = 1000;
  EXPECT_NE(errorOf([&] { parse(turned); }).find("1000"), std::string::npos);

  Scene crowded = scene();
  crowded.instances.resize(33, crowded.instances[0]);
  EXPECT_NE(errorOf([&] { parse(crowded); }).find("33"), std::string::npos);
}

TEST_F(ConversionsTest, AListOfItemsReadsAsText) {
  EXPECT_EQ(itemList({"mug", "bowl"}), "mug, bowl");
  EXPECT_EQ(itemList({}), "nothing");
}

}  // namespace
}  // namespace early_fusion::nodes
