// What is missing or wrong about a real camera is named, and costs no item: the request node, as in
// real_camera_rostest.cpp.
#include <early_fusion/PolicyStatus.h>

#include <optional>

#include "child_process.h"
#include "real_camera_fixture.h"

namespace early_fusion::nodes {
namespace {

TEST_F(RealCameraTest, AnUnknownItemIsRefusedAndTheKnownOnesAreNamed) {
  ::ros::Publisher status_publisher = node_.advertise<PolicyStatus>(kPolicyStatusTopic, 1, true);
  PolicyStatus status;
  status.vocabulary = {"mug", "bowl"};
  status_publisher.publish(status);
  ASSERT_TRUE(spinUntil([&] { return !request({"mug", "baanana"}); })) << "the request node knows what is known";
  EXPECT_NE(said_.find("unknown item 'baanana'; known are mug, bowl; the request stays "), std::string::npos) << said_;
  ASSERT_TRUE(request({"bowl"}));
  EXPECT_FALSE(request({"baanana"}));
  EXPECT_EQ(nextItems(), Items{"bowl"});
  status.vocabulary = {"apple"};  // other weights
  status_publisher.publish(status);
  EXPECT_TRUE(isLogged("the policy's weights do not know what is requested: unknown item 'bowl'; known are apple"));
  status.vocabulary.clear();  // unknown again, for the tests that follow
  status_publisher.publish(status);
  EXPECT_TRUE(spinUntil([&] { return request({"baanana"}); }));
}

TEST_F(RealCameraTest, WithoutAPositionAPickIsNotTriedAndNoItemIsGivenUp) {
  camera_behind_ = ::ros::Duration(100);
  for (int i = 0; i < 3; ++i) {  // more than max_failures
    const RequestConstPtr asked = nextRequest();
    ASSERT_TRUE(asked);
    act("COLLECT", asked->header, "mug");
    EXPECT_TRUE(isLogged("COLLECT of mug is not tried, and counts as no failure: its position is not known: "));
  }
  EXPECT_TRUE(isLogged("the stamp of the image is 100.")) << log_;
  EXPECT_NE(log_.find(" s behind now: check the clock of the machine"), std::string::npos) << log_;
  EXPECT_EQ(nextItems(), (Items{"mug", "bowl"}));
  EXPECT_FALSE(goal_);
}

TEST_F(RealCameraTest, LateJointStatesDoNotHideAMotion) {
  joint_delay_sec_ = 0.5;
  ASSERT_TRUE(publishUntil([&] { return late_joints_.size() > 20; }));
  const RequestConstPtr first = nextRequest();
  ASSERT_TRUE(first);
  act("TILT_DOWN", first->header);
  requests_.clear();
  for (int i = 0; i < 40; ++i) {
    tilt_ += 0.006;
    publishAll();
    spinFor(0.01);
  }
  const ::ros::Time still = ::ros::Time::now();
  EXPECT_TRUE(requests_.empty()) << "what is known is from before the action";
  const RequestConstPtr second = nextRequest();
  ASSERT_TRUE(second);
  EXPECT_GE(second->header.stamp, still);
}

TEST_F(RealCameraTest, JointStatesThatStopAreNamed) {
  ASSERT_TRUE(nextRequest());
  publishes_joints_ = false;
  EXPECT_TRUE(isLogged("the newest joint states of 'pan_joint' and 'tilt_joint' on /joint_states are "));
  EXPECT_TRUE(isLogged("no joint states on /joint_states for ", kSilenceSec)) << log_;
}

TEST_F(RealCameraTest, ImagesThatStopAreNamed) {
  ASSERT_TRUE(nextRequest());
  EXPECT_TRUE(
      spinUntil([&] { return log_.find("no image on /camera/image_raw for ") != std::string::npos; }, kSilenceSec))
      << log_;
}

TEST_F(RealCameraTest, WithoutATransformNothingIsAskedAndTheFramesAreNamed) {
  // The image's frame is another one now: this is how a camera that is not in tf looks.
  image_frame_ = "webcam";
  EXPECT_FALSE(nextRequest(0.4));
  EXPECT_TRUE(isLogged("there is no transform from ~target_frame 'base_link' to the camera's frame 'webcam'"));
}

TEST_F(RealCameraTest, WithoutAPickServerNothingIsAskedAndItIsNamed) {
  server_.reset();
  spinFor(0.5);
  EXPECT_FALSE(nextRequest(0.4));
  // It is told from others by its type.
  actionlib::SimpleActionServer<PickAction> other(node_, "arm/take", false);
  other.start();
  EXPECT_TRUE(
      isLogged("there is no action server /pick (early_fusion/Pick); these have its type: /arm/take (of "
               "/real_camera"));
  startServer();
  EXPECT_TRUE(nextRequest());
}

TEST_F(RealCameraTest, ASecondPublisherOfOlderTransformsIsNamedAndLeftOut) {
  const ChildProcess other({"/proc/self/exe", kOldTransforms}, {}, testing::TempDir() + "old_transforms.log");
  EXPECT_TRUE(isLogged("/old_transforms publish the transform of 'camera_optical_frame' with stamps ")) << log_;
  const PickGoalConstPtr goal = goalOf("COLLECT", "mug");
  ASSERT_TRUE(goal);
  EXPECT_NEAR(goal->pose.pose.position.z, 0.9, 1e-6) << "by the newer transforms";
  answer(true);
}

class DepthTest : public RealCameraTest {
 protected:
  DepthTest() : RealCameraTest("depth") {
    depth_publisher_ = node_.advertise<sensor_msgs::Image>(kDepthImageTopic, 10);
  }

  void publishAll() override {
    RealCameraTest::publishAll();
    if (!depth_size_) return;
    sensor_msgs::Image depth;
    depth.header.stamp = ::ros::Time::now() - depth_behind_;
    depth.width = depth.height = *depth_size_;
    depth.encoding = "32FC1";
    depth.step = 4 * *depth_size_;
    depth.data.resize(depth.step * depth.height);
    for (std::size_t i = 0; i < depth.data.size(); i += sizeof(metres_)) {
      std::memcpy(&depth.data[i], &metres_, sizeof(metres_));
    }
    depth_publisher_.publish(depth);
  }

  ::ros::Publisher depth_publisher_;
  std::optional<std::uint32_t> depth_size_ = 5;  // px; none: no depth images
  float metres_ = 0.5f;
  ::ros::Duration depth_behind_;
};

TEST_F(DepthTest, TheDepthAtTheCentreSaysWhere) {
  const RequestConstPtr asked = nextRequest();
  ASSERT_TRUE(asked);
  act("COLLECT", asked->header, "mug");
  ASSERT_TRUE(publishUntil([&] { return found_ != nullptr; }));
  EXPECT_NEAR(found_->pose.pose.position.z, 1.4 - 0.25, 1e-6);
}

TEST_F(DepthTest, ASilentDepthTopicIsNamedAndNothingIsAskedUntilItComes) {
  depth_size_.reset();
  spinFor(5.5);  // until the depth images of other tests are old
  EXPECT_FALSE(nextRequest(1));
  EXPECT_TRUE(isLogged("no depth image comes on /depth/camera/depth/image_raw; start the depth camera"));
  EXPECT_TRUE(isLogged("no depth image on /depth/camera/depth/image_raw for ", kSilenceSec));
  depth_size_ = 5;
  EXPECT_TRUE(nextRequest());
}

TEST_F(DepthTest, AnEmptyDepthImageIsNamed) {
  depth_size_ = 0;
  EXPECT_TRUE(isLogged("has too few bytes (/depth/camera/depth/image_raw)"));
}

TEST_F(DepthTest, WithoutADepthThePickIsNotTriedAndTheItemIsNotGivenUp) {
  metres_ = NAN;
  for (int i = 0; i < 4; ++i) {  // more than max_failures
    const RequestConstPtr asked = nextRequest();
    ASSERT_TRUE(asked);
    act("COLLECT", asked->header, "mug");
    EXPECT_TRUE(
        isLogged("COLLECT of mug is not tried, and counts as no failure: the depth image knows no depth at its "
                 "centre (/depth/camera/depth/image_raw)"));
  }
  EXPECT_EQ(nextItems(), (Items{"mug", "bowl"}));
}

TEST_F(DepthTest, ADepthImageOfAnotherTimeIsNotUsed) {
  depth_behind_ = ::ros::Duration(30);
  spinFor(5);  // warnings of a kind have this distance
  const RequestConstPtr asked = nextRequest();
  ASSERT_TRUE(asked);
  act("COLLECT", asked->header, "mug");
  EXPECT_TRUE(isLogged("no depth image of that time on /depth/camera/depth/image_raw: the newest is ")) << log_;
  EXPECT_NE(log_.find("check the clock of the machine that stamps it"), std::string::npos);
  EXPECT_FALSE(found_);
}

class TwoCamerasTest : public RealCameraTest {
 protected:
  TwoCamerasTest() : RealCameraTest("two_cameras") {}
};

TEST_F(TwoCamerasTest, ASilentPolicyIsNamedByItsTopic) {
  EXPECT_TRUE(isLogged("no action on /two_cameras/action for ", kSilenceSec)) << log_;
}

TEST_F(TwoCamerasTest, ASecondPublisherOfOlderImagesIsNamedAndIgnored) {
  const ChildProcess other({"rostopic", "pub", "-r", "50", "/two_cameras/camera/image_raw", "sensor_msgs/Image",
                            "{header: {stamp: {secs: 5}}}"},
                           {}, testing::TempDir() + "second_camera.log");
  EXPECT_TRUE(isLogged("2 nodes publish image on /two_cameras/camera/image_raw: /")) << log_;
  RequestConstPtr asked = nextRequest();
  ASSERT_TRUE(asked);
  for (int i = 0; i < 5; ++i) {
    const std::uint32_t step = asked->step;
    act("IDLE", asked->header);
    asked = nextRequest();
    ASSERT_TRUE(asked);
    EXPECT_EQ(asked->step, step + 1) << "no new episode";
  }
}

TEST_F(DepthTest, TfTellsWhetherTheCameraStandsStill) {
  ASSERT_TRUE(nextRequest());
  spinFor(2);  // longer than answer_timeout, without images
  requests_.clear();
  for (int i = 0; i < 50; ++i) {
    tilt_ += 0.006;
    publishAll();
    spinFor(0.01);
  }
  EXPECT_LE(requests_.size(), 1u) << "the first image still belongs to the rest before";
  EXPECT_TRUE(nextRequest());
}

}  // namespace
}  // namespace early_fusion::nodes
