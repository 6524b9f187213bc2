// The policy node, with a test in the place of camera and trainer.
#include <early_fusion/Action.h>
#include <early_fusion/LoadWeights.h>
#include <early_fusion/PolicyStatus.h>
#include <early_fusion/Request.h>
#include <early_fusion/SaveWeights.h>
#include <early_fusion/Weights.h>
#include <gtest/gtest.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "early_fusion/core/random.h"
#include "early_fusion/model/policy_file.h"
#include "early_fusion/model/policy_kinds.h"
#include "early_fusion/ros/policy/acting_policy.h"
#include "early_fusion/ros/shared/camera_image.h"
#include "early_fusion/ros/shared/topics.h"
#include "learning/small_session.h"
#include "spin_until.h"

namespace early_fusion::nodes {
namespace {

constexpr int kSize = 32;

class PolicyNodeTest : public testing::Test {
 protected:
  PolicyNodeTest() {
    image_publisher_ = node_.advertise<sensor_msgs::Image>(kImageTopic, 10);
    request_publisher_ = node_.advertise<Request>(kRequestTopic, 10);
    weights_publisher_ = node_.advertise<Weights>(kWeightsTopic, 1, true);
    action_subscriber_ =
        node_.subscribe<Action>(kActionTopic, 10, [this](const ActionConstPtr& m) { actions_.push_back(m); });
    status_subscriber_ =
        node_.subscribe<PolicyStatus>(kPolicyStatusTopic, 10, [this](const PolicyStatusConstPtr& m) { status_ = m; });
    model::PolicyOptions options;
    options.image_size = kSize;
    options.precision = "f32";
    file_ = model::savePolicy(*model::makePolicy(options, core::Vocabulary({"bowl", "mug"}), 3), {});
  }

  void SetUp() override {
    ASSERT_TRUE(spinUntil([&] {
      return image_publisher_.getNumSubscribers() > 1 && request_publisher_.getNumSubscribers() > 1 &&
             weights_publisher_.getNumSubscribers() > 1 && action_subscriber_.getNumPublishers() > 0 && status_;
    }));
  }

  bool publishWeights(const std::string& id, const std::string& mode = "argmax") {
    const std::string bytes = file_.serialize();
    Weights weights;
    weights.id = id;
    weights.mode = mode;
    weights.seed = 11;
    weights.precision = "f32";
    weights.data.assign(bytes.begin(), bytes.end());
    weights_publisher_.publish(weights);
    return spinUntil([&] { return status_->weights == id && status_->mode == mode; });
  }

  static sensor_msgs::Image makeImage(int width, int height, std::uint64_t seed, const std::string& encoding = "rgb8") {
    sensor_msgs::Image image;
    image.header.stamp = ::ros::Time(50, static_cast<std::uint32_t>(seed));
    image.header.frame_id = "camera_optical_frame";
    image.width = width;
    image.height = height;
    image.encoding = encoding;
    image.step = 3 * width;
    image.data.resize(image.step * height);
    core::Random random(seed);
    for (std::uint8_t& value : image.data) value = static_cast<std::uint8_t>(random.below(256));
    return image;
  }

  void ask(const sensor_msgs::Image& image, std::uint64_t episode, std::uint32_t step,
           const std::vector<std::string>& items = {"mug"}) {
    Request request;
    request.header = image.header;
    request.episode = episode;
    request.step = step;
    request.items = items;
    request_publisher_.publish(request);
    image_publisher_.publish(image);
  }

  /// The next action, or nullptr when none comes.
  ActionConstPtr answer(double timeout_sec = 10) {
    if (!spinUntil([&] { return !actions_.empty(); }, timeout_sec)) return nullptr;
    const ActionConstPtr action = actions_.front();
    actions_.erase(actions_.begin());
    return action;
  }

  ::ros::NodeHandle node_;
  ::ros::Publisher image_publisher_, request_publisher_, weights_publisher_;
  ::ros::Subscriber action_subscriber_, status_subscriber_;
  std::vector<ActionConstPtr> actions_;
  PolicyStatusConstPtr status_;
  nn::WeightsFile file_;
  const learning::SmallSession files_;
};

TEST_F(PolicyNodeTest, AnswersWithTheImagesStampAndTheNetworksProbabilities) {
  ASSERT_TRUE(publishWeights("first"));
  EXPECT_EQ(status_->vocabulary, (std::vector<std::string>{"bowl", "mug"}));
  EXPECT_EQ(status_->kind, "early_fusion");
  ActingPolicy expected;
  expected.load(file_, "test", {"argmax", 11, "f32"});
  for (std::uint32_t step = 0; step < 4; ++step) {
    const sensor_msgs::Image image = makeImage(kSize, kSize, 100 + step);
    ask(image, 6, step);
    const ActionConstPtr action = answer();
    ASSERT_TRUE(action);
    EXPECT_EQ(action->header.stamp, image.header.stamp);
    EXPECT_EQ(action->episode, 6u);
    EXPECT_EQ(action->step, step);
    EXPECT_EQ(action->weights, "first");
    EXPECT_EQ(action->mode, "argmax");
    EXPECT_EQ(action->frames, std::min<std::uint32_t>(step + 1, 3));
    core::Image frame(kSize, kSize);
    frame.rgb = image.data;
    const Decision decision = expected.decide(frame, {"mug"}, 6, step);
    EXPECT_EQ(action->name, core::actionName(decision.action));
    EXPECT_EQ(action->probabilities, decision.probabilities);
  }
}

TEST_F(PolicyNodeTest, AnswersAStepThatIsPublishedAgainAsBefore) {
  ASSERT_TRUE(publishWeights("again", "sample"));
  ask(makeImage(kSize, kSize, 200), 7, 0);
  ASSERT_TRUE(answer());
  const sensor_msgs::Image second = makeImage(kSize, kSize, 201);
  ask(second, 7, 1);
  const ActionConstPtr once = answer();
  ask(second, 7, 1);
  const ActionConstPtr twice = answer();
  ASSERT_TRUE(once && twice);
  EXPECT_EQ(once->name, twice->name);
  EXPECT_EQ(once->probabilities, twice->probabilities);
  EXPECT_EQ(twice->frames, 2);
}

TEST_F(PolicyNodeTest, SaysWhichRequestedItemACollectOrRemoveIsFor) {
  ASSERT_TRUE(publishWeights("named", "sample"));
  ActingPolicy expected;
  expected.load(file_, "test", {"sample", 11, "f32"});
  int picks = 0, others = 0;
  for (std::uint32_t step = 0; picks == 0 || others == 0; ++step) {
    ASSERT_LT(step, 200u);
    const sensor_msgs::Image image = makeImage(kSize, kSize, 800 + step);
    ask(image, 30, step, {"mug", "bowl"});
    const ActionConstPtr action = answer();
    ASSERT_TRUE(action);
    core::Image frame(kSize, kSize);
    frame.rgb = image.data;
    expected.decide(frame, {"mug", "bowl"}, 30, step);
    if (action->name == "COLLECT" || action->name == "REMOVE") {
      ++picks;
      const LikelyItem item = expected.likeliestItem(core::actionFromName(action->name));
      EXPECT_EQ(action->item, item.name);
      EXPECT_EQ(action->item_probability, item.probability);
    } else {
      ++others;
      EXPECT_EQ(action->item, "");
      EXPECT_EQ(action->item_probability, 0);
    }
  }
}

TEST_F(PolicyNodeTest, NamesTheItemOfACollectAtEveryStepIfToldTo) {
  std::vector<ActionConstPtr> always;
  const ::ros::Subscriber subscriber =
      node_.subscribe<Action>("always/action", 10, [&](const ActionConstPtr& m) { always.push_back(m); });
  ASSERT_TRUE(spinUntil([&] { return subscriber.getNumPublishers() > 0; }));
  ASSERT_TRUE(publishWeights("always", "sample"));
  spinFor(0.3);  // until the other node has them, too
  ActingPolicy expected;
  expected.load(file_, "test", {"sample", 11, "f32"});
  for (std::uint32_t step = 0; step < 8; ++step) {
    const sensor_msgs::Image image = makeImage(kSize, kSize, 850 + step);
    ask(image, 31, step, {"mug", "bowl"});
    ASSERT_TRUE(spinUntil([&] { return always.size() > step; }));
    core::Image frame(kSize, kSize);
    frame.rgb = image.data;
    expected.decide(frame, {"mug", "bowl"}, 31, step);
    const bool removes = always.back()->name == "REMOVE";
    const LikelyItem item = expected.likeliestItem(removes ? core::Action::kRemove : core::Action::kCollect);
    EXPECT_EQ(always.back()->item, item.name);
    EXPECT_EQ(always.back()->item_probability, item.probability);
  }
}

TEST_F(PolicyNodeTest, TakesACamerasImageOfAnySizeAndOrderOfColours) {
  ASSERT_TRUE(publishWeights("camera"));
  ActingPolicy expected;
  expected.load(file_, "test", {"argmax", 11, "f32"});
  std::uint64_t episode = 20;
  for (const auto& [width, height, crop] : {std::array{640, 480, 480}, {100, 300, 100}, {20, 24, 20}}) {
    const sensor_msgs::Image rgb = makeImage(width, height, 300 + ++episode);
    sensor_msgs::Image bgr = rgb;
    bgr.encoding = "bgr8";
    for (std::size_t i = 0; i < bgr.data.size(); i += 3) std::swap(bgr.data[i], bgr.data[i + 2]);
    const core::Image seen = policyImage(rgb, {(width - crop) / 2, (height - crop) / 2, crop, crop, ""}, kSize);
    for (sensor_msgs::Image image : {rgb, bgr}) {
      image.header.stamp.nsec = 2000 + ++episode;
      ask(image, episode, 0);
      const ActionConstPtr action = answer();
      ASSERT_TRUE(action) << image.encoding;
      EXPECT_EQ(action->probabilities, expected.decide(seen, {"mug"}, episode, 0).probabilities)
          << width << " x " << height << ", " << image.encoding;
    }
  }
}

TEST_F(PolicyNodeTest, UnusableImagesAndUnknownItemsAreDroppedAndTheNextIsAnswered) {
  ASSERT_TRUE(publishWeights("robust"));
  sensor_msgs::Image truncated = makeImage(kSize, kSize, 400);
  truncated.data.resize(10);
  ask(truncated, 8, 0);
  ask(makeImage(kSize, kSize, 401, "nonsense"), 8, 0);
  ask(makeImage(kSize, kSize, 402), 8, 0, {"anvil"});
  EXPECT_FALSE(answer(0.5));
  ask(makeImage(kSize, kSize, 403), 8, 0);
  const ActionConstPtr action = answer();
  ASSERT_TRUE(action);
  EXPECT_EQ(action->header.stamp.nsec, 403u);
}

TEST_F(PolicyNodeTest, AnImageWithoutARequestOfItsStampIsNotAnswered) {
  ASSERT_TRUE(publishWeights("pairs"));
  image_publisher_.publish(makeImage(kSize, kSize, 500));
  Request request;
  request.header.stamp = ::ros::Time(50, 501);
  request.items = {"mug"};
  request_publisher_.publish(request);
  EXPECT_FALSE(answer(0.5));
}

TEST_F(PolicyNodeTest, GoesOnWhenTheTimeJumpsBack) {
  ASSERT_TRUE(publishWeights("loop"));
  for (std::uint32_t i = 0; i < 40; ++i) {  // images that nobody asks about, more than any queue
    sensor_msgs::Image image = makeImage(kSize, kSize, i);
    image.header.stamp = ::ros::Time(1000, i);
    image_publisher_.publish(image);
    spinFor(0.002);
  }
  for (std::uint32_t step = 0; step < 3; ++step) {
    sensor_msgs::Image image = makeImage(kSize, kSize, 510 + step);
    image.header.stamp = ::ros::Time(10, step);
    ask(image, 0, step);
    const ActionConstPtr action = answer();
    ASSERT_TRUE(action) << step;
    EXPECT_EQ(action->frames, step + 1);
  }
}

TEST_F(PolicyNodeTest, AnswersImagesWhoseStampsAreAllZero) {
  ASSERT_TRUE(publishWeights("zero"));
  for (std::uint32_t step = 0; step < 3; ++step) {
    sensor_msgs::Image image = makeImage(kSize, kSize, 520 + step);
    image.header.stamp = ::ros::Time();
    ask(image, 11, step);
    const ActionConstPtr action = answer();
    ASSERT_TRUE(action) << step;
    EXPECT_EQ(action->step, step);
  }
}

TEST_F(PolicyNodeTest, DecidesAnewForAnotherRequestWithTheSameStamp) {
  ASSERT_TRUE(publishWeights("another"));
  sensor_msgs::Image image = makeImage(kSize, kSize, 1);
  image.header.stamp = ::ros::Time();
  ask(image, 4, 0, {"mug"});
  const ActionConstPtr mug = answer();
  ASSERT_TRUE(mug);
  ask(image, 4, 0, {"bowl"});
  const ActionConstPtr bowl = answer();
  ASSERT_TRUE(bowl);
  EXPECT_NE(bowl->probabilities, mug->probabilities);
}

TEST_F(PolicyNodeTest, BrokenWeightsLeaveTheOldOnesActing) {
  ASSERT_TRUE(publishWeights("good"));
  Weights broken;
  broken.id = "broken";
  broken.mode = "argmax";
  broken.data = {1, 2, 3};
  weights_publisher_.publish(broken);
  spinFor(0.3);
  EXPECT_EQ(status_->weights, "good");
  ask(makeImage(kSize, kSize, 600), 9, 0);
  const ActionConstPtr action = answer();
  ASSERT_TRUE(action);
  EXPECT_EQ(action->weights, "good");
}

TEST_F(PolicyNodeTest, SavesAndLoadsWeights) {
  ASSERT_TRUE(publishWeights("kept"));
  SaveWeights save;
  save.request.path = files_.path("folder/weights.safetensors");
  ASSERT_TRUE(::ros::service::call(kSaveWeightsService, save));
  EXPECT_TRUE(save.response.success) << save.response.message;
  EXPECT_EQ(nn::WeightsFile::read(save.request.path).serialize(), file_.serialize());

  LoadWeights load;
  load.request.path = save.request.path;
  ASSERT_TRUE(::ros::service::call(kLoadWeightsService, load));
  EXPECT_TRUE(load.response.success) << load.response.message;
  EXPECT_TRUE(spinUntil([&] { return status_->weights == save.request.path; })) << status_->weights;

  load.request.path = files_.path("missing.safetensors");
  ASSERT_TRUE(::ros::service::call(kLoadWeightsService, load));
  EXPECT_FALSE(load.response.success);
  EXPECT_NE(load.response.message.find("missing.safetensors"), std::string::npos);
}

TEST_F(PolicyNodeTest, ServicesUseNoFilesOutsideOfTheFolder) {
  ASSERT_TRUE(publishWeights("kept"));
  LoadWeights load;
  load.request.path = "/etc/passwd";
  ASSERT_TRUE(::ros::service::call(kLoadWeightsService, load));
  EXPECT_FALSE(load.response.success);
  EXPECT_EQ(load.response.message.find("path: '/etc/passwd' is not a file in /tmp; "), 0u) << load.response.message;
  SaveWeights save;
  save.request.path = "../home/weights.safetensors";
  ASSERT_TRUE(::ros::service::call(kSaveWeightsService, save));
  EXPECT_FALSE(save.response.success) << save.response.message;
}

TEST_F(PolicyNodeTest, PublishesWhatItSawForWhoListensAlsoWithARepeatedAnswer) {
  ASSERT_TRUE(publishWeights("seen"));
  std::vector<sensor_msgs::ImageConstPtr> frames;
  const ::ros::Subscriber subscriber = node_.subscribe<sensor_msgs::Image>(
      kFrameTopic, 10, [&](const sensor_msgs::ImageConstPtr& m) { frames.push_back(m); });
  ASSERT_TRUE(spinUntil([&] { return subscriber.getNumPublishers() > 0; }));
  spinFor(0.2);  // until the other side knows of the subscriber, too
  const sensor_msgs::Image image = makeImage(64, 48, 710);
  for (std::size_t times = 1; times <= 2; ++times) {
    ask(image, 12, 0);
    ASSERT_TRUE(answer());
    ASSERT_TRUE(spinUntil([&] { return frames.size() == times; }));
    EXPECT_EQ(frames.back()->header.stamp, image.header.stamp);
    EXPECT_EQ(frames.back()->encoding, "rgb8");
    EXPECT_EQ(frames.back()->data, policyImage(image, largestSquare(image), kSize).rgb);
  }
}

TEST_F(PolicyNodeTest, DrawsAnAnnotatedImageForWhoLooks) {
  ASSERT_TRUE(publishWeights("drawn"));
  sensor_msgs::ImageConstPtr annotated;
  const ::ros::Subscriber subscriber = node_.subscribe<sensor_msgs::Image>(
      kAnnotatedImageTopic, 10, [&](const sensor_msgs::ImageConstPtr& m) { annotated = m; });
  ASSERT_TRUE(spinUntil([&] { return subscriber.getNumPublishers() > 0; }));
  spinFor(0.2);  // until the other side knows of the subscriber, too
  const sensor_msgs::Image image = makeImage(kSize, kSize, 700);
  ask(image, 10, 0);
  ASSERT_TRUE(spinUntil([&] { return annotated != nullptr; }));
  EXPECT_EQ(annotated->header.stamp, image.header.stamp);
  EXPECT_EQ(annotated->width, 3u * kSize);
  EXPECT_EQ(annotated->encoding, "rgb8");
}

/// The warnings of the policy node.
class PolicyNodeWarnings : public PolicyNodeTest {
 protected:
  PolicyNodeWarnings() {
    log_subscriber_ = node_.subscribe<rosgraph_msgs::Log>("/rosout", 100, [this](const rosgraph_msgs::LogConstPtr& m) {
      if (m->level == rosgraph_msgs::Log::WARN) warnings_.push_back(m->msg);
    });
  }

  int countOf(const std::string& text) const {
    return std::count_if(warnings_.begin(), warnings_.end(),
                         [&](const std::string& warning) { return warning.find(text) != std::string::npos; });
  }

  ::ros::Subscriber log_subscriber_;
  std::vector<std::string> warnings_;
};

TEST_F(PolicyNodeWarnings, AMissingCameraInfoIsNamedWithTheTopicsThatLookLikeIt) {
  const ::ros::Publisher other = node_.advertise<sensor_msgs::CameraInfo>("usb_cam/camera_info", 1);
  ASSERT_TRUE(publishWeights("waits"));
  ask(makeImage(kSize, kSize, 800), 30, 0);
  ASSERT_TRUE(answer());
  EXPECT_TRUE(spinUntil([&] { return countOf("no camera_info on /camera/camera_info") > 0; }, 40));
  EXPECT_GT(countOf("/usb_cam/camera_info (by " + ::ros::this_node::getName()), 0);
}

// The last test, because the node keeps the camera_info.
TEST_F(PolicyNodeWarnings, TheCropFollowsCameraInfoAndANarrowViewIsToldOnce) {
  ::ros::Publisher publisher = node_.advertise<sensor_msgs::CameraInfo>(kCameraInfoTopic, 1, true);
  ASSERT_TRUE(publishWeights("crop"));
  ActingPolicy expected;
  expected.load(file_, "test", {"argmax", 11, "f32"});
  std::uint64_t episode = 40;
  for (const auto& [focal_length, edge] : {std::pair(300, 346), std::pair(772, 480)}) {
    sensor_msgs::CameraInfo info;
    info.width = 640;
    info.height = 480;
    info.K = {1.0 * focal_length, 0, 319.5, 0, 1.0 * focal_length, 239.5, 0, 0, 1};
    publisher.publish(info);
    ASSERT_TRUE(spinUntil([&] { return publisher.getNumSubscribers() > 0; }));
    spinFor(0.3);  // until the node has it
    for (int repeat = 0; repeat < 3; ++repeat) {
      const sensor_msgs::Image image = makeImage(640, 480, 900 + ++episode);
      ask(image, episode, 0);
      const ActionConstPtr action = answer();
      ASSERT_TRUE(action);
      const core::Image seen = policyImage(image, {(640 - edge) / 2, (480 - edge) / 2, edge, edge, ""}, kSize);
      EXPECT_EQ(action->probabilities, expected.decide(seen, {"mug"}, episode, 0).probabilities) << focal_length;
    }
  }
  EXPECT_TRUE(spinUntil([&] { return countOf("35 degrees") > 0; }));
  spinFor(0.3);
  EXPECT_EQ(countOf("35 degrees"), 1);
}

}  // namespace
}  // namespace early_fusion::nodes

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "policy_node_rostest");
  ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
