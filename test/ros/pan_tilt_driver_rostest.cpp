// The pan-tilt driver node, with a test in the place of the policy, the joints and their controllers.
#include <early_fusion/Action.h>
#include <early_fusion/Request.h>
#include <gtest/gtest.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <optional>

#include "early_fusion/core/file.h"
#include "early_fusion/ros/shared/topics.h"
#include "early_fusion/world/camera_rig.h"
#include "spin_until.h"

namespace early_fusion::nodes {
namespace {

using world::kStepRad;

class PanTiltDriverTest : public testing::Test {
 protected:
  explicit PanTiltDriverTest(const std::string& name_space = "") : node_(name_space) {
    action_publisher_ = node_.advertise<Action>(kActionTopic, 10);
    request_publisher_ = node_.advertise<Request>(kRequestTopic, 10);
    joint_publisher_ = node_.advertise<sensor_msgs::JointState>(kJointStatesTopic, 10);
    pan_subscriber_ = node_.subscribe<std_msgs::Float64>(
        kPanCommandTopic, 10, [this](const std_msgs::Float64ConstPtr& m) { pan_ = m->data; });
    tilt_subscriber_ = node_.subscribe<std_msgs::Float64>(
        kTiltCommandTopic, 10, [this](const std_msgs::Float64ConstPtr& m) { tilt_ = m->data; });
    log_subscriber_ = node_.subscribe<rosgraph_msgs::Log>(
        "/rosout", 100, [this](const rosgraph_msgs::LogConstPtr& m) { log_ += m->msg + "\n"; });
  }

  void SetUp() override {
    ASSERT_TRUE(spinUntil([&] {
      return action_publisher_.getNumSubscribers() > 0 && request_publisher_.getNumSubscribers() > 0 &&
             joint_publisher_.getNumSubscribers() > 0 && pan_subscriber_.getNumPublishers() > 0 &&
             tilt_subscriber_.getNumPublishers() > 0 && log_subscriber_.getNumPublishers() > 1;
    }));
    spinFor(0.2);  // until the node knows of its subscribers, too
  }

  void act(const std::string& name, ::ros::Time stamp = {}) {
    Action action;
    action.header.stamp = stamp;
    action.name = name;
    action_publisher_.publish(action);
  }

  void publishStates(const std::vector<std::string>& names, const std::vector<double>& positions,
                     ::ros::Time stamp = {}) {
    sensor_msgs::JointState states;
    states.header.stamp = stamp;
    states.name = names;
    states.position = positions;
    joint_publisher_.publish(states);
    spinFor(0.2);
  }

  bool panBecomes(double angle) {
    return spinUntil([&] { return pan_ && std::abs(*pan_ - angle) < 1e-9; });
  }

  /// Acts until a warning says why it is refused; warnings of a kind have a minimum distance.
  bool isRefused(const std::string& reason) {
    return spinUntil([&] {
      act("PAN_LEFT");
      spinFor(0.2);
      return log_.find(reason) != std::string::npos;
    });
  }

  bool isLogged(const std::string& text) {
    return spinUntil([&] { return log_.find(text) != std::string::npos; });
  }

  ::ros::NodeHandle node_;
  ::ros::Publisher action_publisher_, request_publisher_, joint_publisher_;
  ::ros::Subscriber pan_subscriber_, tilt_subscriber_, log_subscriber_;
  std::optional<double> pan_, tilt_;
  std::string log_;
};

TEST_F(PanTiltDriverTest, BeforeTheJointsAreKnownNothingIsCommanded) {
  publishStates({"elbow", "wrist"}, {1, 2});
  EXPECT_TRUE(isRefused("there are no joint states of 'pan_joint' yet; /joint_states has elbow, wrist")) << log_;
  EXPECT_FALSE(pan_ || tilt_);
}

TEST_F(PanTiltDriverTest, MovesAreCommandsOfTwoDegreesFromWhereTheJointsAreWithinTheirLimits) {
  const auto rig = world::CameraRig::load(core::shareFolder() + "/urdf/pan_tilt_camera.urdf", "pan_joint", "tilt_joint",
                                          "camera_optical_frame");
  const double limit = rig.lattice().highest.pan * kStepRad;
  // The joints may be in any order, among others; the pan joint stands one step from its limit.
  const double pan = limit - kStepRad - 0.001, tilt = 0.3;
  publishStates({"elbow", "tilt_joint", "pan_joint", "half a message"}, {1, tilt, pan});
  act("TILT_DOWN");
  ASSERT_TRUE(spinUntil([&] { return tilt_.has_value(); }));
  EXPECT_NEAR(*tilt_, tilt + kStepRad, 1e-9);
  EXPECT_FALSE(pan_) << "only the joint that turns is commanded";
  act("PAN_LEFT");
  EXPECT_TRUE(panBecomes(pan + kStepRad));
  for (const char* name : {"PAN_LEFT", "COLLECT", "JUMP"}) act(name);
  spinFor(0.2);
  EXPECT_NEAR(*pan_, pan + kStepRad, 1e-9);
  act("PAN_RIGHT");
  EXPECT_TRUE(panBecomes(pan));
}

TEST_F(PanTiltDriverTest, JointsMayComeOneAMessageAndCountFromZeroToTwoPi) {
  publishStates({"pan_joint"}, {6.2});
  publishStates({"tilt_joint"}, {0.3});
  publishStates({"pan_joint"}, {std::nan("")});
  act("PAN_LEFT");
  EXPECT_TRUE(panBecomes(6.2 - 2 * M_PI + kStepRad)) << *pan_;
}

TEST_F(PanTiltDriverTest, AUnitThatWasMovedByHandIsGoneOnFromThere) {
  publishStates({"pan_joint", "tilt_joint"}, {0.5, 0.3});
  act("PAN_LEFT");
  EXPECT_TRUE(panBecomes(0.5 + kStepRad));
  publishStates({"pan_joint"}, {-0.5});
  act("PAN_LEFT");
  EXPECT_TRUE(panBecomes(-0.5 + kStepRad));
  EXPECT_TRUE(isLogged("'pan_joint' stands at -0.500 rad and not at its last command")) << log_;
}

TEST_F(PanTiltDriverTest, AnActionThatArrivesAfterTheNextRequestIsDropped) {
  publishStates({"pan_joint", "tilt_joint"}, {0.1, 0.3});
  Request request;
  request.header.stamp = ::ros::Time(60, 2);
  request_publisher_.publish(request);
  spinFor(0.2);
  act("TILT_DOWN", ::ros::Time(60, 1));
  act("PAN_LEFT", ::ros::Time(60, 2));
  EXPECT_TRUE(panBecomes(0.1 + kStepRad));
  EXPECT_FALSE(tilt_);
}

TEST_F(PanTiltDriverTest, OldJointStatesAreNotMovedFrom) {
  publishStates({"pan_joint", "tilt_joint"}, {0.1, 0.3});
  spinFor(2.1);
  EXPECT_TRUE(isRefused("the newest joint state of 'pan_joint' is ")) << log_;
  EXPECT_FALSE(pan_);
}

TEST_F(PanTiltDriverTest, JointStatesAreOldByTheirStampAndNotByWhenTheyCome) {
  spinFor(1.6);  // until the joint states of other tests are older
  publishStates({"pan_joint", "tilt_joint"}, {0.6, 0.3}, ::ros::Time::now() - ::ros::Duration(1.5));
  act("PAN_LEFT");
  EXPECT_TRUE(panBecomes(0.6 + kStepRad)) << "within joint_state_timeout";
  pan_.reset();
  spinFor(0.7);  // it came 1 s ago, but was measured 2.5 s ago
  act("PAN_LEFT");
  spinFor(0.2);
  EXPECT_FALSE(pan_);
  EXPECT_TRUE(isRefused("the newest joint state of 'pan_joint' is ")) << log_;
  publishStates({"pan_joint", "tilt_joint"}, {0.6, 0.3}, ::ros::Time::now() - ::ros::Duration(100));
  EXPECT_TRUE(isLogged("that of 'pan_joint' from /")) << log_;
  EXPECT_NE(log_.find("the stamp of the joint states is 100."), std::string::npos) << log_;
  publishStates({"pan_joint", "tilt_joint"}, {-0.5, 0.3}, ::ros::Time::now() + ::ros::Duration(100));
  act("PAN_LEFT");
  EXPECT_TRUE(panBecomes(-0.5 + kStepRad)) << "a clock that is ahead: as if it came without a stamp";
}

TEST_F(PanTiltDriverTest, WithoutAControllerNothingIsCommandedAndItsTopicIsNamed) {
  publishStates({"pan_joint", "tilt_joint"}, {0.1, 0.3});
  pan_subscriber_.shutdown();
  spinFor(0.2);
  EXPECT_TRUE(isRefused("nobody subscribes to /pan_position_controller/command")) << log_;
}

TEST(PanTiltDriver, TakesTheUnitOfTheRobotDescriptionAndCommandsATrajectory) {
  ::ros::NodeHandle node("trajectory");
  trajectory_msgs::JointTrajectoryConstPtr command;
  const auto subscriber = node.subscribe<trajectory_msgs::JointTrajectory>(
      kTrajectoryCommandTopic, 10, [&](const trajectory_msgs::JointTrajectoryConstPtr& m) { command = m; });
  ::ros::Publisher actions = node.advertise<Action>(kActionTopic, 10);
  ::ros::Publisher joints = node.advertise<sensor_msgs::JointState>(kJointStatesTopic, 10);
  ASSERT_TRUE(spinUntil([&] {
    return subscriber.getNumPublishers() > 0 && actions.getNumSubscribers() > 0 && joints.getNumSubscribers() > 0;
  }));
  spinFor(0.2);
  sensor_msgs::JointState states;
  states.name = {"torso_lift_joint", "head_pan_joint", "head_tilt_joint"};
  states.position = {0.2, 6.27, -0.4};
  joints.publish(states);
  spinFor(0.2);
  Action action;
  action.name = "PAN_RIGHT";
  actions.publish(action);
  ASSERT_TRUE(spinUntil([&] { return command != nullptr; }));
  EXPECT_EQ(command->joint_names, (std::vector<std::string>{"head_pan_joint", "head_tilt_joint"}));
  ASSERT_EQ(command->points.size(), 1u);
  EXPECT_NEAR(command->points[0].positions[0], 6.27 + kStepRad, 1e-9) << "positive to the right, without limits";
  EXPECT_NEAR(command->points[0].positions[1], -0.4, 1e-9);
  EXPECT_EQ(command->points[0].velocities, (std::vector<double>{0, 0}));
  EXPECT_EQ(command->points[0].time_from_start, ::ros::Duration(0.4));
  EXPECT_TRUE(command->header.stamp.isZero()) << "at once";
  action.name = "TILT_UP";
  command.reset();
  actions.publish(action);
  ASSERT_TRUE(spinUntil([&] { return command != nullptr; }));
  EXPECT_NEAR(command->points[0].positions[1], -0.4 + kStepRad, 1e-9) << "positive upwards";
}

TEST(PanTiltDriver, AUnitWithoutEncodersTurnsToTheMiddleWhenItsControllersCome) {
  ::ros::NodeHandle node("blind");
  std::optional<double> pan, tilt;
  const auto pan_subscriber = node.subscribe<std_msgs::Float64>(
      kPanCommandTopic, 10, [&](const std_msgs::Float64ConstPtr& m) { pan = m->data; });
  const auto tilt_subscriber = node.subscribe<std_msgs::Float64>(
      kTiltCommandTopic, 10, [&](const std_msgs::Float64ConstPtr& m) { tilt = m->data; });
  ASSERT_TRUE(spinUntil([&] { return pan && tilt; }));
  EXPECT_NEAR(*pan, 0, 1e-9);
  EXPECT_NEAR(*tilt, (0.034906 + 0.767945) / 2, 1e-9);
}

}  // namespace
}  // namespace early_fusion::nodes

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "pan_tilt_driver_rostest");
  ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
