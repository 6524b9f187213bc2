// The nodes between a real pan-tilt camera and the policy. The test replaces both.
#include <early_fusion/Action.h>
#include <early_fusion/Request.h>
#include <early_fusion/SetRequest.h>
#include <gtest/gtest.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64.h>

#include <optional>

#include "early_fusion/core/file.h"
#include "early_fusion/ros/shared/topics.h"
#include "early_fusion/world/camera_rig.h"
#include "spin_until.h"

namespace early_fusion::nodes {
namespace {

class RealCameraTest : public testing::Test {
 protected:
  RealCameraTest() {
    image_publisher_ = node_.advertise<sensor_msgs::Image>(kImageTopic, 10);
    action_publisher_ = node_.advertise<Action>(kActionTopic, 10);
    joint_publisher_ = node_.advertise<sensor_msgs::JointState>(kJointStatesTopic, 10);
    request_subscriber_ =
        node_.subscribe<Request>(kRequestTopic, 10, [this](const RequestConstPtr& m) { requests_.push_back(m); });
    pan_subscriber_ = node_.subscribe<std_msgs::Float64>(
        "pan_position_controller/command", 10, [this](const std_msgs::Float64ConstPtr& m) { pan_ = m->data; });
    tilt_subscriber_ = node_.subscribe<std_msgs::Float64>(
        "tilt_position_controller/command", 10, [this](const std_msgs::Float64ConstPtr& m) { tilt_ = m->data; });
  }

  void SetUp() override {
    ASSERT_TRUE(spinUntil([&] {
      return image_publisher_.getNumSubscribers() > 0 && action_publisher_.getNumSubscribers() > 1 &&
             joint_publisher_.getNumSubscribers() > 0 && request_subscriber_.getNumPublishers() > 0 &&
             pan_subscriber_.getNumPublishers() > 0 && tilt_subscriber_.getNumPublishers() > 0;
    }));
  }

  /// Sends images, as a camera does, until one of them has a request.
  RequestConstPtr nextRequest() {
    requests_.clear();
    static std::uint32_t stamp = 0;
    const bool asked = spinUntil([&] {
      sensor_msgs::Image image;
      image.header.stamp = ::ros::Time(60, ++stamp);
      image_publisher_.publish(image);
      return !requests_.empty();
    });
    return asked ? requests_.front() : nullptr;
  }

  void act(const std::string& name, const std_msgs::Header& header) {
    Action action;
    action.header = header;
    action.name = name;
    action_publisher_.publish(action);
  }

  ::ros::NodeHandle node_;
  ::ros::Publisher image_publisher_, action_publisher_, joint_publisher_;
  ::ros::Subscriber request_subscriber_, pan_subscriber_, tilt_subscriber_;
  std::vector<RequestConstPtr> requests_;
  std::optional<double> pan_, tilt_;
};

TEST_F(RealCameraTest, AnImageIsAskedAboutAndTheNextStepFollowsTheAction) {
  const RequestConstPtr first = nextRequest();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->episode, 0u);
  EXPECT_EQ(first->items, (std::vector<std::string>{"mug", "bowl"}));
  act("IDLE", first->header);
  const RequestConstPtr second = nextRequest();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->step, first->step + 1);
  EXPECT_GT(second->header.stamp, first->header.stamp);
}

TEST_F(RealCameraTest, WithoutAnAnswerTheSameStepIsAskedAgainAboutANewImage) {
  const RequestConstPtr first = nextRequest();
  const RequestConstPtr second = nextRequest();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(second->step, first->step);
  EXPECT_GT(second->header.stamp, first->header.stamp);
  act("IDLE", second->header);
}

TEST_F(RealCameraTest, ATimeThatJumpsBackBeginsANewEpisode) {
  const RequestConstPtr first = nextRequest();
  ASSERT_TRUE(first);
  act("IDLE", first->header);
  const RequestConstPtr second = nextRequest();
  ASSERT_TRUE(second);
  EXPECT_GT(second->step, 0u);
  requests_.clear();
  sensor_msgs::Image earlier;
  earlier.header.stamp = ::ros::Time(10);
  ASSERT_TRUE(spinUntil([&] {
    image_publisher_.publish(earlier);
    return !requests_.empty();
  }));
  EXPECT_EQ(requests_.front()->step, 0u);
  act("IDLE", requests_.front()->header);
}

TEST_F(RealCameraTest, TheServiceChangesWhatIsAskedFor) {
  SetRequest call;
  call.request.items = {"apple"};
  ASSERT_TRUE(::ros::service::call(kSetRequestService, call));
  EXPECT_TRUE(call.response.success);
  const RequestConstPtr request = nextRequest();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->items, (std::vector<std::string>{"apple"}));
  act("IDLE", request->header);
  call.request.items = {"mug", "bowl"};
  ::ros::service::call(kSetRequestService, call);
}

TEST_F(RealCameraTest, MovesAreCommandsOfTwoDegreesFromWhereTheJointsAreWithinTheirLimits) {
  const auto rig = world::CameraRig::load(core::shareFolder() + "/urdf/pan_tilt_camera.urdf", "pan_joint", "tilt_joint",
                                          "camera_optical_frame");
  std_msgs::Header header;
  act("PAN_LEFT", header);
  spinFor(0.2);
  EXPECT_FALSE(pan_) << "commanded before it was known how the joints stand";

  // The joints may be in any order, among others; the pan joint stands one step from its limit.
  sensor_msgs::JointState states;
  states.name = {"elbow", "tilt_joint", "pan_joint"};
  states.position = {1.0, (rig.lattice().lowest.tilt + 3) * world::kStepRad + 0.001,
                     (rig.lattice().highest.pan - 1) * world::kStepRad - 0.001};
  joint_publisher_.publish(states);
  spinFor(0.2);
  act("TILT_DOWN", header);
  ASSERT_TRUE(spinUntil([&] { return tilt_ && pan_; }));
  EXPECT_NEAR(*tilt_, (rig.lattice().lowest.tilt + 4) * world::kStepRad, 1e-9);
  act("PAN_LEFT", header);
  const double limit = rig.lattice().highest.pan * world::kStepRad;
  ASSERT_TRUE(spinUntil([&] { return std::abs(*pan_ - limit) < 1e-9; }));
  for (const char* name : {"PAN_LEFT", "COLLECT", "JUMP"}) act(name, header);
  spinFor(0.2);
  EXPECT_NEAR(*pan_, limit, 1e-9);
  act("PAN_RIGHT", header);
  EXPECT_TRUE(spinUntil([&] { return std::abs(*pan_ - limit + world::kStepRad) < 1e-9; }));

  // An action that arrives after the next request is dropped. The action for the next request is carried out.
  const RequestConstPtr first = nextRequest();
  const RequestConstPtr second = nextRequest();
  ASSERT_TRUE(first && second);
  const double tilt = *tilt_;
  spinFor(0.5);  // the driver has the requests over a connection of its own
  act("TILT_DOWN", first->header);
  act("PAN_RIGHT", second->header);
  EXPECT_TRUE(spinUntil([&] { return std::abs(*pan_ - limit + 2 * world::kStepRad) < 1e-9; }));
  EXPECT_NEAR(*tilt_, tilt, 1e-9);
}

}  // namespace
}  // namespace early_fusion::nodes

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "real_camera_rostest");
  ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
