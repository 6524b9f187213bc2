#include "early_fusion/ros/correction/correction_recorder.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/Empty.h>

#include "early_fusion/core/error.h"
#include "early_fusion/model/policy_file.h"
#include "early_fusion/ros/correction/correction_trainer_node.h"
#include "learning/small_correction.h"

namespace early_fusion::nodes {
namespace {

constexpr int kSize = 4;

Correction correction(std::uint64_t episode, std::uint32_t step) {
  Correction message;
  message.header.stamp = ::ros::Time(100 + episode, step);
  message.episode = episode;
  message.step = step;
  message.items = {"bowl"};
  message.policy = "PAN_LEFT";
  message.frame.header.stamp = message.header.stamp;
  message.frame.encoding = "rgb8";
  message.frame.width = message.frame.height = kSize;
  message.frame.step = 3 * kSize;
  message.frame.data.assign(3 * kSize * kSize, static_cast<std::uint8_t>(step));
  return message;
}

Correction end(std::uint64_t episode) {
  Correction message;
  message.ends = true;
  message.episode = episode;
  return message;
}

class CorrectionRecorderTest : public testing::Test {
 protected:
  std::string errorOf(const Correction& message) {
    try {
      recorder_.add(message);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "";
  }

  CorrectionRecorder recorder_{core::Vocabulary({"mug", "bowl"}), kSize};
};

TEST_F(CorrectionRecorderTest, TheEndReturnsTheStepsOfTheEpisode) {
  Correction pressed = correction(2, 1);
  pressed.person = "COLLECT";
  EXPECT_FALSE(recorder_.add(correction(2, 0)));
  EXPECT_FALSE(recorder_.add(pressed));
  const auto steps = recorder_.add(end(2));
  ASSERT_TRUE(steps);
  ASSERT_EQ(steps->size(), 2u);
  EXPECT_EQ((*steps)[0].policys, core::Action::kPanLeft);
  EXPECT_FALSE((*steps)[0].persons);
  EXPECT_EQ((*steps)[1].persons, core::Action::kCollect);
  EXPECT_EQ((*steps)[1].request, core::Request{1});
  EXPECT_EQ((*steps)[1].frame->back(), 1);
  EXPECT_TRUE(recorder_.add(end(3))->empty());
}

TEST_F(CorrectionRecorderTest, AnEpisodeIsCutBeforeWhatCannotBeUsed) {
  recorder_.add(correction(0, 0));
  EXPECT_NE(errorOf(correction(0, 2)).find("episode 0, step 2: does not follow from the previous step"),
            std::string::npos);
  EXPECT_EQ(errorOf(correction(0, 3)), "") << "told once";
  EXPECT_EQ(recorder_.add(end(0))->size(), 1u);
}

TEST_F(CorrectionRecorderTest, AnEpisodeWithoutItsBeginningIsNotUsed) {
  EXPECT_NE(errorOf(correction(0, 7)), "");
  EXPECT_TRUE(recorder_.add(end(0))->empty());
  recorder_.add(correction(1, 0));
  EXPECT_EQ(recorder_.add(end(1))->size(), 1u);
}

TEST_F(CorrectionRecorderTest, WhatIsWrongIsNamed) {
  Correction message = correction(0, 0);
  message.items = {"anvil"};
  EXPECT_NE(errorOf(message).find("'anvil'"), std::string::npos);
  message = correction(0, 0);
  message.person = "JUMP";
  EXPECT_NE(errorOf(message).find("'JUMP'"), std::string::npos);
  message = correction(0, 0);
  message.frame.width = 5;
  EXPECT_NE(errorOf(message).find("5 x 4 rgb8"), std::string::npos);
  message = correction(0, 0);
  message.frame.header.stamp += ::ros::Duration(0, 1);
  EXPECT_NE(errorOf(message).find("stamp"), std::string::npos);
}

/// The messages of a session with a simulated person, as the correction node publishes them.
std::vector<Correction> messagesOf(std::uint64_t episode, const std::vector<learning::WatchedStep>& steps,
                                   const core::Vocabulary& vocabulary, int size) {
  std::vector<Correction> messages;
  for (const learning::WatchedStep& step : steps) {
    Correction message = correction(episode, static_cast<std::uint32_t>(messages.size()));
    message.items = vocabulary.names(step.request);
    message.policy = core::actionName(step.policys);
    if (step.persons) message.person = core::actionName(*step.persons);
    message.frame.width = message.frame.height = size;
    message.frame.step = 3 * size;
    message.frame.data = *step.frame;
    messages.push_back(message);
  }
  messages.push_back(end(episode));
  return messages;
}

TEST(TrainOnBag, GivesTheWeightsOfTheSessionThatWasRecorded) {
  const learning::SmallCorrection small;
  learning::CorrectionSession live(small.options("live"), small.world);
  const std::string file = small.files.path("session.bag");
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    int seconds = 10;
    for (std::uint64_t episode = 0; episode < 3; ++episode) {
      const auto steps = small.watch(live.trainer(), episode);
      for (const Correction& message :
           messagesOf(episode, steps, live.trainer().vocabulary(), learning::SmallSession::kImageSize)) {
        bag.write("correction", ::ros::Time(seconds++), message);
      }
      bag.write("other", ::ros::Time(seconds++), std_msgs::Empty());
      live.add(steps);
    }
  }
  learning::CorrectionSession later(small.options("later"), small.world);
  std::vector<std::string> lines;
  trainOnBag(later, file, [&](const std::string& line) { lines.push_back(line); });
  EXPECT_TRUE(later.weights().serialize() == live.weights().serialize());
  EXPECT_EQ(lines.size(), 3u);
  EXPECT_GT(later.trainer().round().presses, 0u);
}

TEST(CorrectionsInBag, ABagThatCannotBeUsedIsAnError) {
  const learning::SmallSession files;
  EXPECT_THROW(correctionsInBag(files.path("missing.bag")), core::Error);
  EXPECT_THROW(correctionsInBag(files.task()), core::Error) << "no bag";
  const std::string file = files.path("two.bag");
  rosbag::Bag bag(file, rosbag::bagmode::Write);
  bag.close();
  EXPECT_THROW(correctionsInBag(file), core::Error) << "no corrections";
  bag.open(file, rosbag::bagmode::Append);
  bag.write("a/correction", ::ros::Time(1), end(0));
  bag.write("b/correction", ::ros::Time(2), end(0));
  bag.close();
  try {
    correctionsInBag(file);
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("a/correction, b/correction"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace early_fusion::nodes
