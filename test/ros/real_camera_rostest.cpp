// The request node, with a test in the place of camera, policy, unit and robot.
#include <visualization_msgs/MarkerArray.h>

#include "real_camera_fixture.h"

namespace early_fusion::nodes {
namespace {
/// A second node that publishes the camera's pose, with stamps of long ago, as a bag does.
void publishOldTransforms(int argc, char** argv) {
  ros::init(argc, argv, kOldTransforms);
  ros::NodeHandle node;
  tf2_ros::TransformBroadcaster broadcaster;
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "base_link";
  transform.child_frame_id = "camera_optical_frame";
  transform.transform.rotation.w = 1;
  for (int i = 0; ros::ok(); ++i) {
    transform.header.stamp = ros::Time(100 + 0.02 * i);
    broadcaster.sendTransform(transform);
    ros::WallDuration(0.02).sleep();
  }
}

TEST_F(RealCameraTest, AnImageIsAskedAboutAndTheNextStepFollowsTheAction) {
  const RequestConstPtr first = nextRequest();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->episode, 0u);
  EXPECT_EQ(first->step, 0u);
  EXPECT_EQ(first->items, (Items{"mug", "bowl"}));
  act("IDLE", first->header);
  spinFor(0.1);
  const RequestConstPtr second = nextRequest();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->step, 1u);
  EXPECT_GT(second->header.stamp, first->header.stamp);
}

TEST_F(RealCameraTest, WithoutAnAnswerTheSameStepIsAskedAgainAboutANewImage) {
  const RequestConstPtr first = nextRequest();
  const RequestConstPtr second = nextRequest();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(second->step, first->step);
  EXPECT_GT(second->header.stamp, first->header.stamp);
}

TEST_F(RealCameraTest, ATimeThatJumpsBackBeginsANewEpisode) {
  const RequestConstPtr first = nextRequest();
  ASSERT_TRUE(first);
  act("IDLE", first->header);
  const RequestConstPtr second = nextRequest();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->step, first->step + 1);
  // As a bag that is played in a loop: images and transforms are from an hour ago.
  ago_ = ::ros::Duration(3600);
  const RequestConstPtr earlier = nextRequest();
  ASSERT_TRUE(earlier);
  EXPECT_LT(earlier->header.stamp, second->header.stamp);
  EXPECT_EQ(earlier->step, 0u);
  const PickGoalConstPtr goal = goalOf("COLLECT", "mug");
  ASSERT_TRUE(goal) << "tf takes transforms from before the jump";
  EXPECT_EQ(goal->pose.header.frame_id, "base_link");
  answer(true);
}

TEST_F(RealCameraTest, TheServiceChangesWhatIsAskedForAndBeginsAnEpisode) {
  const RequestConstPtr first = nextRequest();
  ASSERT_TRUE(first);
  act("IDLE", first->header);
  spinFor(0.1);
  EXPECT_FALSE(request({"banana", ""})) << "an item without a name";
  ASSERT_TRUE(request({"apple"}));
  const RequestConstPtr second = nextRequest();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->items, Items{"apple"});
  EXPECT_EQ(second->step, 0u);
}

TEST_F(RealCameraTest, OneItemAfterTheOtherIsHandedOverAndTakenOffTheRequest) {
  const PickGoalConstPtr mug = goalOf("COLLECT", "mug");
  ASSERT_TRUE(mug);
  EXPECT_EQ(mug->action, "COLLECT");
  EXPECT_EQ(mug->item, "mug");
  EXPECT_EQ(mug->item_probability, 0.75);
  EXPECT_FALSE(nextRequest(0.4)) << "the robot is busy";
  answer(true);
  EXPECT_EQ(nextItems(), Items{"bowl"});
  ASSERT_TRUE(goalOf("COLLECT", "bowl"));
  answer(true);
  EXPECT_FALSE(nextRequest(0.4)) << "nothing is left";
  EXPECT_TRUE(isLogged("collected bowl; still requested: nothing"));
}

TEST_F(RealCameraTest, TheGoalSaysWhereTheOpticalAxisMeetsTheSurface) {
  visualization_msgs::MarkerArrayConstPtr markers;
  const auto subscriber = node_.subscribe<visualization_msgs::MarkerArray>(
      kFoundMarkersTopic, 10, [&](const visualization_msgs::MarkerArrayConstPtr& m) { markers = m; });
  const PickGoalConstPtr goal = goalOf("COLLECT", "mug");
  ASSERT_TRUE(goal);
  EXPECT_EQ(goal->pose.header.frame_id, "base_link");
  const geometry_msgs::Pose& pose = goal->pose.pose;
  EXPECT_NEAR(pose.position.x, 0.1 + std::sqrt(0.75), 1e-6);
  EXPECT_NEAR(pose.position.y, 0.2, 1e-6);
  EXPECT_NEAR(pose.position.z, 0.9, 1e-6);
  EXPECT_NEAR(std::abs(pose.orientation.y), std::sin(M_PI / 12), 1e-6) << "x points 30 degrees downwards";
  ASSERT_TRUE(found_);
  EXPECT_EQ(found_->item, "mug");
  EXPECT_EQ(found_->pose, goal->pose);
  EXPECT_EQ(found_->header.stamp, goal->pose.header.stamp) << "of the image";
  ASSERT_TRUE(spinUntil([&] { return markers != nullptr; }));
  EXPECT_EQ(markers->markers[0].header.frame_id, "base_link");
  EXPECT_EQ(markers->markers[0].pose, pose);
  answer(true);
}

TEST_F(RealCameraTest, AFailureKeepsTheItemAndTooManyInARowGiveItUp) {
  ASSERT_TRUE(goalOf("COLLECT", "mug"));
  answer(false, "it slipped");
  EXPECT_EQ(nextItems(), (Items{"mug", "bowl"}));
  EXPECT_TRUE(isLogged("COLLECT of mug failed: it slipped"));
  ASSERT_TRUE(goalOf("REMOVE", "mug"));
  server_->setAborted(PickResult(), "out of reach");
  EXPECT_EQ(nextItems(), Items{"bowl"});
  EXPECT_TRUE(isLogged("gave up mug after 2 failures in a row (~max_failures); still requested: bowl"));
}

TEST_F(RealCameraTest, ARemovedObjectLeavesTheRequestAlone) {
  const PickGoalConstPtr goal = goalOf("REMOVE", "mug");
  ASSERT_TRUE(goal);
  EXPECT_EQ(goal->action, "REMOVE");
  answer(true);
  EXPECT_EQ(nextItems(), (Items{"mug", "bowl"}));
}

TEST_F(RealCameraTest, APickThatTakesTooLongHasFailed) {
  ASSERT_TRUE(goalOf("COLLECT", "mug"));
  EXPECT_EQ(nextItems(), (Items{"mug", "bowl"}));
  EXPECT_TRUE(isLogged("the pick server did not finish within ~pick_timeout"));
  EXPECT_TRUE(spinUntil([&] { return !server_->isActive(); })) << "the goal is cancelled";
}

TEST_F(RealCameraTest, ANewRequestCancelsThePickOfTheOldOne) {
  ASSERT_TRUE(goalOf("COLLECT", "mug"));
  ASSERT_TRUE(request({"mug"}));
  EXPECT_EQ(said_, "requesting mug; the current pick is cancelled");
  EXPECT_TRUE(spinUntil([&] { return !server_->isActive(); }));
  EXPECT_EQ(nextItems(), Items{"mug"});
}

TEST_F(RealCameraTest, ANewRequestWaitsForTheEndOfTheOldGoalWhoseResultDoesNotCount) {
  ends_when_cancelled_ = false;
  ASSERT_TRUE(goalOf("COLLECT", "mug"));
  ASSERT_TRUE(request({"mug", "bowl"}));
  EXPECT_TRUE(spinUntil([&] { return server_->isPreemptRequested(); }));
  EXPECT_FALSE(nextRequest(1.5)) << "longer than pick_timeout";
  EXPECT_TRUE(isLogged("the pick server /pick has not ended the goal that was cancelled"));
  answer(true);
  EXPECT_EQ(nextItems(), (Items{"mug", "bowl"}));
  EXPECT_TRUE(isLogged("the cancelled COLLECT of mug has ended: it succeeded nevertheless, but does not count"));
}

TEST_F(RealCameraTest, AnItemThatIsNotRequestedIsNotPicked) {
  const RequestConstPtr asked = nextRequest();
  ASSERT_TRUE(asked);
  act("COLLECT", asked->header, "");
  EXPECT_TRUE(isLogged("set ~name_items of policy_node"));
  EXPECT_FALSE(goal_);
  EXPECT_EQ(nextItems(), (Items{"mug", "bowl"}));
}

TEST_F(RealCameraTest, AnImageThatIsTakenWhileTheUnitMovesIsNotAskedAbout) {
  const RequestConstPtr first = nextRequest();
  ASSERT_TRUE(first);
  act("TILT_DOWN", first->header);
  requests_.clear();
  for (int i = 0; i < 50; ++i) {
    tilt_ += 0.006;
    publishAll();
    spinFor(0.01);
  }
  EXPECT_TRUE(requests_.empty());
  const ::ros::Time still = ::ros::Time::now();
  const RequestConstPtr second = nextRequest();
  ASSERT_TRUE(second);
  EXPECT_GE(second->header.stamp, still);
}

class AloneTest : public RealCameraTest {
 protected:
  AloneTest() : RealCameraTest("alone") {}
};

TEST_F(AloneTest, FoundItemsAreAnnouncedAndTakenOff) {
  const RequestConstPtr asked = nextRequest();
  ASSERT_TRUE(asked);
  act("COLLECT", asked->header, "bowl");
  ASSERT_TRUE(publishUntil([&] { return found_ != nullptr; }));
  EXPECT_EQ(found_->action, "COLLECT");
  EXPECT_EQ(found_->item, "bowl");
  EXPECT_EQ(found_->header.stamp, asked->header.stamp);
  EXPECT_EQ(found_->pose.header.frame_id, "") << "no position is wanted";
  EXPECT_EQ(nextItems(), Items{"mug"});
  EXPECT_FALSE(goal_);
}

TEST_F(AloneTest, NobodyRemovesWhatIsInTheWay) {
  const RequestConstPtr asked = nextRequest();
  ASSERT_TRUE(asked);
  act("REMOVE", asked->header, "bowl");
  EXPECT_TRUE(isLogged("REMOVE of bowl failed: with pick:=none nobody removes what is in the way"));
  EXPECT_EQ(nextItems(), Items{"mug"}) << "one failure is enough here";
}

}  // namespace
}  // namespace early_fusion::nodes

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == early_fusion::nodes::kOldTransforms) {
    early_fusion::nodes::publishOldTransforms(argc, argv);
    return 0;
  }
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "real_camera_rostest");
  ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
