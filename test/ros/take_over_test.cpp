#include "early_fusion/ros/correction/take_over.h"

#include <gtest/gtest.h>

#include "early_fusion/core/error.h"
#include "early_fusion/ros/correction/presses.h"

namespace early_fusion::nodes {
namespace {

constexpr char kPolicys[] = "TILT_UP";

class TakeOverTest : public testing::Test {
 protected:
  /// The policy's answer to step `step` of an episode. Its stamp names both.
  TakeOver::Output step(std::uint64_t episode, std::uint32_t step, const std::string& weights = "w0",
                        const std::string& held = "") {
    Action action;
    action.header.stamp = stamp(episode, step);
    action.episode = episode;
    action.step = step;
    action.name = kPolicys;
    action.weights = weights;
    action.item = item_;
    Request request;
    request.items = {"mug"};
    sensor_msgs::Image frame;
    frame.data = {7};
    return take_over_.onStep(action, request, frame, held, now_);
  }
  TakeOver::Output press(const std::string& name, const ::ros::Time& stamp = {}) {
    return take_over_.onPress(name, stamp, now_);
  }
  /// Step `step` with a press.
  void pressed(std::uint64_t episode, std::uint32_t number, const std::string& weights = "w0") {
    step(episode, number, weights);
    ASSERT_TRUE(press("IDLE").action);
  }
  static ::ros::Time stamp(std::uint64_t episode, std::uint32_t step) {
    return {static_cast<std::uint32_t>(100 + episode), step};
  }

  double now_ = 1000;
  std::string item_;
  TakeOver take_over_{{0.5, 2, 10, true}};
};

TEST_F(TakeOverTest, APressIsDoneInsteadOfThePolicysActionAndRecorded) {
  const TakeOver::Output opened = step(3, 0);
  ASSERT_TRUE(opened.proposal);
  EXPECT_EQ(opened.proposal->name, kPolicys);
  EXPECT_FALSE(opened.action);
  const TakeOver::Output answered = press("COLLECT", stamp(3, 0));
  ASSERT_TRUE(answered.action && answered.record);
  EXPECT_EQ(answered.action->name, "COLLECT");
  EXPECT_EQ(answered.action->header.stamp, stamp(3, 0));
  EXPECT_EQ(answered.action->item, "mug") << "the only one that is requested";
  EXPECT_EQ(answered.record->policy, kPolicys);
  EXPECT_EQ(answered.record->person, "COLLECT");
  EXPECT_EQ(answered.record->episode, 3u);
  EXPECT_EQ(answered.record->items, std::vector<std::string>{"mug"});
  EXPECT_EQ(answered.record->frame.data, std::vector<std::uint8_t>{7});
}

TEST_F(TakeOverTest, WithoutAPressThePolicyActsWhenThePatienceIsOver) {
  step(0, 0);
  now_ += 0.4;
  EXPECT_FALSE(take_over_.onTime(now_).action);
  now_ += 0.2;
  const TakeOver::Output answered = take_over_.onTime(now_);
  ASSERT_TRUE(answered.action);
  EXPECT_EQ(answered.action->name, kPolicys);
  EXPECT_EQ(answered.record->person, "");
  EXPECT_FALSE(take_over_.onTime(now_).action);
}

TEST_F(TakeOverTest, AfterAPressTheNextStepWaitsLongerUnlessThePersonLetsGo) {
  pressed(0, 0);
  step(0, 1);
  now_ += 1.9;
  EXPECT_FALSE(take_over_.onTime(now_).action);
  EXPECT_TRUE(press("PAN_LEFT").action);
  step(0, 2);
  const TakeOver::Output let_go = press(kGoOn);
  ASSERT_TRUE(let_go.action);
  EXPECT_EQ(let_go.action->name, kPolicys);
  EXPECT_EQ(let_go.record->person, "");
  step(0, 3);
  now_ += 0.6;
  EXPECT_TRUE(take_over_.onTime(now_).action);
}

TEST_F(TakeOverTest, AConfirmedStepIsThePolicysAndIsRecordedAsRight) {
  pressed(0, 0);
  step(0, 1);
  const TakeOver::Output confirmed = press(kConfirm);
  ASSERT_TRUE(confirmed.action);
  EXPECT_EQ(confirmed.action->name, kPolicys);
  EXPECT_EQ(confirmed.record->person, "");
  EXPECT_TRUE(confirmed.record->confirmed);
  step(0, 2);
  EXPECT_FALSE(press(kGoOn).record->confirmed);
}

TEST_F(TakeOverTest, APressJustBeforeAStepIsForItAndAnOldOneIsNot) {
  pressed(0, 0);
  EXPECT_FALSE(press("REMOVE").action);
  now_ += 0.9;
  EXPECT_EQ(step(0, 1).action->name, "REMOVE");
  EXPECT_FALSE(press("REMOVE").action);
  now_ += 1.1;
  EXPECT_FALSE(step(0, 2).action);
}

TEST_F(TakeOverTest, AHeldStickMovesAtEveryStep) {
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(step(0, i, "w0", "PAN_RIGHT").action->name, "PAN_RIGHT");
}

TEST_F(TakeOverTest, APickIsForTheItemThatThePolicyNames) {
  item_ = "bowl";
  step(0, 0);
  EXPECT_EQ(press("REMOVE").action->item, "bowl");
  step(0, 1);
  EXPECT_EQ(press("PAN_LEFT").action->item, "") << "a move has none";
}

TEST_F(TakeOverTest, ARepeatedStepIsAnsweredAsBeforeAndRecordedOnce) {
  pressed(0, 0);
  const TakeOver::Output again = step(0, 0);
  ASSERT_TRUE(again.action);
  EXPECT_EQ(again.action->name, "IDLE");
  EXPECT_FALSE(again.record || again.proposal || again.end);
}

TEST_F(TakeOverTest, AnOpenStepThatIsRepeatedIsProposedAgain) {
  step(0, 0);
  now_ += 0.4;
  EXPECT_TRUE(step(0, 0).proposal);
  now_ += 0.2;
  EXPECT_TRUE(take_over_.onTime(now_).action) << "its time goes on";
}

TEST_F(TakeOverTest, TheNextEpisodeEndsTheRecordAndWaitsForNewWeights) {
  pressed(5, 0);
  const TakeOver::Output held = step(6, 0);
  ASSERT_TRUE(held.end);
  EXPECT_TRUE(held.end->ends);
  EXPECT_EQ(held.end->episode, 5u);
  EXPECT_FALSE(held.proposal || held.action);
  EXPECT_EQ(take_over_.waitsFor(), "weights other than 'w0'");
  EXPECT_FALSE(step(6, 0).end) << "once";
  EXPECT_TRUE(step(6, 0, "w1").proposal);
}

TEST_F(TakeOverTest, OnARealCameraStepZeroBeginsTheNextEpisode) {
  pressed(0, 0);
  Action action;
  action.header.stamp = ::ros::Time(500);
  action.weights = "w1";
  const TakeOver::Output output = take_over_.onStep(action, {}, {}, "", now_);
  EXPECT_TRUE(output.end);
  EXPECT_TRUE(output.proposal);
}

TEST_F(TakeOverTest, ASilentEpisodeHasEnded) {
  pressed(0, 0);
  now_ += 9;
  EXPECT_FALSE(take_over_.onTime(now_).end);
  now_ += 2;
  EXPECT_TRUE(take_over_.onTime(now_).end);
  EXPECT_FALSE(take_over_.onTime(now_).end);
}

TEST_F(TakeOverTest, AnEpisodeThatThePersonEndedIsIdleUntilTheNextOne) {
  pressed(0, 0);
  step(0, 1);
  const TakeOver::Output ended = press(kEpisodeDone);
  ASSERT_TRUE(ended.end && ended.action);
  EXPECT_EQ(ended.action->name, "IDLE");
  EXPECT_FALSE(ended.record);
  const TakeOver::Output rest = step(0, 2, "w1");
  ASSERT_TRUE(rest.action);
  EXPECT_EQ(rest.action->name, "IDLE");
  EXPECT_FALSE(rest.record || rest.proposal);
  const TakeOver::Output next = step(1, 0, "w1");
  EXPECT_FALSE(next.end) << "it has ended already";
  EXPECT_TRUE(next.proposal);
}

TEST_F(TakeOverTest, APressForAnotherImageOrOfAnUnknownNameIsAnError) {
  step(0, 0);
  EXPECT_THROW(press("COLLECT", stamp(0, 1)), core::Error);
  EXPECT_THROW(press("JUMP"), core::Error);
  EXPECT_TRUE(press("COLLECT", stamp(0, 0)).action);
  EXPECT_THROW(press("COLLECT", stamp(0, 0)), core::Error) << "it is answered";
}

TEST(TakeOver, WithoutATrainerAnEpisodeDoesNotWaitForWeights) {
  TakeOver::Options options;
  options.wait_for_weights = false;
  TakeOver take_over(options);
  Action action;
  action.header.stamp = ::ros::Time(1);
  take_over.onStep(action, {}, {}, "", 0);
  take_over.onPress("IDLE", {}, 0);
  action.header.stamp = ::ros::Time(2);
  action.episode = 1;
  const TakeOver::Output output = take_over.onStep(action, {}, {}, "", 0);
  EXPECT_TRUE(output.end && output.proposal);
}

}  // namespace
}  // namespace early_fusion::nodes
