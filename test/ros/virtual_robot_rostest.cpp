// The virtual robot, with a test in the place of the nodes that drive it.
#include <actionlib/client/simple_action_client.h>
#include <early_fusion/PickAction.h>
#include <early_fusion/Reset.h>
#include <gtest/gtest.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <map>

#include "early_fusion/ros/shared/topics.h"
#include "early_fusion/ros/virtual_robot/virtual_unit.h"
#include "early_fusion/sim/episode.h"
#include "spin_until.h"

namespace early_fusion::nodes {
namespace {

class VirtualRobotTest : public testing::Test {
 protected:
  explicit VirtualRobotTest(const std::string& name_space = "")
      : world_(world::loadWorld("")), node_(name_space), picker_(node_, kPickAction, false) {
    pan_publisher_ = node_.advertise<std_msgs::Float64>(kPanCommandTopic, 1);
    tilt_publisher_ = node_.advertise<std_msgs::Float64>(kTiltCommandTopic, 1);
    trajectory_publisher_ = node_.advertise<trajectory_msgs::JointTrajectory>(kTrajectoryCommandTopic, 1);
    image_subscriber_ = node_.subscribe<sensor_msgs::Image>(
        kImageTopic, 10, [this](const sensor_msgs::ImageConstPtr& message) { image_ = message; });
    info_subscriber_ = node_.subscribe<sensor_msgs::CameraInfo>(
        kCameraInfoTopic, 10, [this](const sensor_msgs::CameraInfoConstPtr& message) { info_ = message; });
    joint_subscriber_ = node_.subscribe<sensor_msgs::JointState>(
        kJointStatesTopic, 100, [this](const sensor_msgs::JointStateConstPtr& message) {
          sizes_.push_back(message->name.size());
          for (std::size_t i = 0; i < message->name.size(); ++i) joints_[message->name[i]] = message->position[i];
        });
  }

  void SetUp() override {
    ASSERT_TRUE(spinUntil([&] {
      return pan_publisher_.getNumSubscribers() > 0 && tilt_publisher_.getNumSubscribers() > 0 &&
             trajectory_publisher_.getNumSubscribers() > 0 && image_ && info_ && joints_.size() == 2 &&
             picker_.isServerConnected();
    }));
  }

  void begin(std::uint64_t episode) {
    Reset reset;
    reset.request.seed = 5;
    reset.request.episode = episode;
    ASSERT_TRUE(::ros::service::call(node_.resolveName(kResetService), reset));
    ASSERT_TRUE(reset.response.success) << reset.response.message;
  }

  void turnTo(double pan_rad, double tilt_rad) {
    std_msgs::Float64 pan, tilt;
    pan.data = pan_rad;
    tilt.data = tilt_rad;
    pan_publisher_.publish(pan);
    tilt_publisher_.publish(tilt);
  }

  bool standsAt(double pan_rad, double tilt_rad) {
    return std::abs(joints_["pan_joint"] - pan_rad) < 1e-6 && std::abs(joints_["tilt_joint"] - tilt_rad) < 1e-6;
  }

  /// The image after `now`.
  sensor_msgs::ImageConstPtr nextImage() {
    const ::ros::Time now = ::ros::Time::now();
    spinUntil([&] { return image_->header.stamp > now; });
    return image_;
  }

  /// The result of a pick.
  PickResultConstPtr pick(const std::string& action) {
    PickGoal goal;
    goal.action = action;
    goal.item = "something";
    picker_.sendGoal(goal);
    return spinUntil([&] { return picker_.getState().isDone(); }) ? picker_.getResult() : nullptr;
  }

  std::shared_ptr<const world::World> world_;
  ::ros::NodeHandle node_;
  actionlib::SimpleActionClient<PickAction> picker_;
  ::ros::Publisher pan_publisher_, tilt_publisher_, trajectory_publisher_;
  ::ros::Subscriber image_subscriber_, info_subscriber_, joint_subscriber_;
  sensor_msgs::ImageConstPtr image_;
  sensor_msgs::CameraInfoConstPtr info_;
  std::map<std::string, double> joints_;
  std::vector<std::size_t> sizes_;
};

TEST_F(VirtualRobotTest, ShowsItsCameraAsADriverDoes) {
  EXPECT_EQ(image_->width, 160u);
  EXPECT_EQ(image_->height, 120u);
  EXPECT_EQ(image_->encoding, "bayer_rggb8");
  EXPECT_EQ(image_->step, 164u);
  EXPECT_EQ(image_->header.frame_id, "camera_optical_frame");
  EXPECT_NEAR(info_->K[0], 80, 1e-6);  // 90 degrees
  EXPECT_TRUE(spinUntil([&] { return info_->header.stamp == image_->header.stamp; }));
  for (const std::size_t size : sizes_) EXPECT_EQ(size, 1u) << "one joint a message";
}

TEST_F(VirtualRobotTest, TurnsWithItsSpeedToPositionsAndTrajectoriesAndStopsAtLimits) {
  begin(0);
  const world::Orientation start = sim::sampleEpisode(*world_, {sim::loadTask("simple"), 5, 0}).orientation;
  const double pan = start.pan * world::kStepRad, tilt = start.tilt * world::kStepRad;
  ASSERT_TRUE(spinUntil([&] { return standsAt(pan, tilt); }));
  const double to_pan = pan > 0 ? pan - 0.2 : pan + 0.2;
  const ::ros::WallTime began = ::ros::WallTime::now();
  turnTo(to_pan, tilt);
  EXPECT_TRUE(spinUntil([&] { return standsAt(to_pan, tilt); }));
  EXPECT_GT((::ros::WallTime::now() - began).toSec(), 0.9) << "0.2 rad at 0.2 rad/s";

  trajectory_msgs::JointTrajectory trajectory;
  trajectory.joint_names = {"tilt_joint", "pan_joint"};
  trajectory.points.resize(2);
  trajectory.points[0].positions = {tilt, to_pan};
  trajectory.points[1].positions = {0.3, pan};
  trajectory_publisher_.publish(trajectory);
  EXPECT_TRUE(spinUntil([&] { return standsAt(pan, 0.3); }));
  turnTo(pan, 5);
  EXPECT_TRUE(spinUntil([&] { return standsAt(pan, world_->rig.lattice().highest.tilt * world::kStepRad); }));
}

TEST_F(VirtualRobotTest, APickTakesAwayWhatTheCameraPointsAt) {
  const sim::EpisodeKey key{sim::loadTask("simple"), 5, 1};
  const sim::Episode episode(*world_, key);
  begin(1);
  // An orientation with something in the cone and one with nothing.
  const world::Orientation at = episode.cone().orientationsOf(0).front();
  turnTo(at.pan * world::kStepRad, at.tilt * world::kStepRad);
  ASSERT_TRUE(spinUntil([&] { return standsAt(at.pan * world::kStepRad, at.tilt * world::kStepRad); }, 60));
  const sensor_msgs::ImageConstPtr before = nextImage();
  const PickResultConstPtr taken = pick("COLLECT");
  ASSERT_TRUE(taken);
  EXPECT_TRUE(taken->success) << taken->message;
  EXPECT_NE(nextImage()->data, before->data);
  PickResultConstPtr failed = taken;
  for (int others = 0; others < 4 && failed->success; ++others) failed = pick("REMOVE");
  EXPECT_FALSE(failed->success);
  EXPECT_NE(failed->message.find("nothing is within 3 degrees"), std::string::npos) << failed->message;
  EXPECT_NE(pick("JUMP")->message.find("COLLECT"), std::string::npos);
}

class ClumsyRobotTest : public VirtualRobotTest {
 protected:
  ClumsyRobotTest() : VirtualRobotTest("clumsy") {}
};

TEST_F(ClumsyRobotTest, APickFailsAndLeavesTheObject) {
  begin(1);
  const sim::Episode episode(*world_, {sim::loadTask("simple"), 5, 1});
  const world::Orientation at = episode.cone().orientationsOf(0).front();
  turnTo(at.pan * world::kStepRad, at.tilt * world::kStepRad);
  ASSERT_TRUE(spinUntil([&] { return standsAt(at.pan * world::kStepRad, at.tilt * world::kStepRad); }));
  const sensor_msgs::ImageConstPtr before = nextImage();
  const PickResultConstPtr failed = pick("COLLECT");
  ASSERT_TRUE(failed);
  EXPECT_FALSE(failed->success);
  EXPECT_EQ(failed->message, "the gripper slipped (pick_failure)");
  EXPECT_EQ(nextImage()->data, before->data);
}

}  // namespace
}  // namespace early_fusion::nodes

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "virtual_robot_rostest");
  ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
