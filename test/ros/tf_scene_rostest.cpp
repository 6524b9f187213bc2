// tf_scene_node, with a test in the place of the tracker, the camera, request_node, the policy and the pick server.
#include <early_fusion/Action.h>
#include <early_fusion/Found.h>
#include <early_fusion/PickActionResult.h>
#include <early_fusion/Press.h>
#include <early_fusion/Request.h>
#include <early_fusion/Scene.h>
#include <early_fusion/SetRequest.h>
#include <gtest/gtest.h>
#include <std_msgs/String.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>

#include "early_fusion/ros/correction/presses.h"
#include "early_fusion/ros/shared/conversions.h"
#include "early_fusion/ros/shared/topics.h"
#include "early_fusion/sim/cone_table.h"
#include "early_fusion/sim/scene.h"
#include "early_fusion/sim/tracked_scene.h"
#include "spin_until.h"

namespace early_fusion::nodes {
namespace {

const std::vector<std::string> kItems = {"mug", "banana", "cracker_box", "apple"};  // of config/tracked_objects.yaml

class TfSceneTest : public testing::Test {
 protected:
  TfSceneTest() : world_(world::loadWorld("")) {
    ::ros::NodeHandle("~").getParam("pick", pick_);
    const core::Vocabulary& vocabulary = world_->objects.vocabulary();
    for (int i = 0; i < 4; ++i) instances_.push_back({vocabulary.index(kItems[i]), 0.8, 0.3 - 0.2 * i, 0.5 * i});
    cone_ = std::make_unique<sim::ConeTable>(*world_, instances_);
    tf_publisher_ = node_.advertise<tf2_msgs::TFMessage>("/tf", 100);
    request_publisher_ = node_.advertise<Request>(kRequestTopic, 10);
    action_publisher_ = node_.advertise<Action>(kActionTopic, 10);
    result_publisher_ = node_.advertise<PickActionResult>(std::string(kPickAction) + "/result", 10);
    found_publisher_ = node_.advertise<Found>(kFoundTopic, 10);
    scene_subscriber_ = node_.subscribe<Scene>(kSceneTopic, 10, [this](const SceneConstPtr& scene) { scene_ = scene; });
    press_subscriber_ = node_.subscribe<Press>(kPressTopic, 10,
                                               [this](const PressConstPtr& press) { presses_.push_back(press->name); });
    put_back_subscriber_ = node_.subscribe<std_msgs::String>(
        kPutBackTopic, 10, [this](const std_msgs::StringConstPtr& asked) { asked_ = asked->data; });
    set_request_server_ = node_.advertiseService(kSetRequestService, &TfSceneTest::onSetRequest, this);
  }

  void SetUp() override {
    ASSERT_TRUE(spinUntil([&] {
      const ::ros::Publisher& taken = pick_ == "server" ? result_publisher_ : found_publisher_;
      return tf_publisher_.getNumSubscribers() > 0 && request_publisher_.getNumSubscribers() > 0 &&
             action_publisher_.getNumSubscribers() > 0 && taken.getNumSubscribers() > 0 && !asked_.empty();
    }));
  }

  bool onSetRequest(SetRequest::Request& request, SetRequest::Response& response) {
    items_ = request.items;
    return response.success = true;
  }

  void publishTransform(const std::string& frame, const Eigen::Isometry3d& pose, const ::ros::Time& stamp) {
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = stamp;
    transform.header.frame_id = world_->rig.worldFrame();
    transform.child_frame_id = frame;
    transform.transform = transformMessage(pose);
    tf2_msgs::TFMessage message;
    message.transforms = {transform};
    tf_publisher_.publish(message);
  }

  void track(const ::ros::Time& stamp, int without = -1) {
    for (int i = 0; i < 4; ++i) {
      if (i != without) {
        publishTransform(kItems[i] + "_1", sim::worldFromObject(*world_, instances_[i]), stamp);
      }
    }
  }

  /// An orientation at which an object is the one that the camera looks at.
  world::Orientation towards(int object) const {
    const world::OrientationLattice& lattice = world_->rig.lattice();
    for (int i = 0; i < lattice.size(); ++i) {
      if (cone_->nearest(lattice.at(i), 0b1111u) == object) return lattice.at(i);
    }
    ADD_FAILURE() << kItems[object] << " is never in the cone";
    return {};
  }

  /// Asks the policy about an image at this stamp. @return the scene of it; null: there was none in time.
  SceneConstPtr ask(world::Orientation orientation, const ::ros::Time& stamp, bool with_camera = true,
                    double timeout_sec = 5) {
    stamp_ = stamp;
    Request request;
    request.header.stamp = stamp;
    request.step = step_++;
    request.items = items_;
    request_publisher_.publish(request);
    spinFor(0.1);  // if the time has jumped back, the node forgets what came before the request
    track(stamp);
    if (with_camera) {
      publishTransform(world_->rig.opticalFrame(), world_->rig.worldFromCamera(orientation), stamp);
    }
    spinUntil([&] { return scene_ && scene_->header.stamp == stamp; }, timeout_sec);
    return scene_ && scene_->header.stamp == stamp ? scene_ : nullptr;
  }

  SceneConstPtr ask(world::Orientation orientation) { return ask(orientation, ::ros::Time::now()); }

  void act(const std::string& name) {
    Action action;
    action.header.stamp = stamp_;
    action.name = name;
    action_publisher_.publish(action);
    spinFor(0.1);
  }

  void endPick(bool success) {
    PickActionResult result;
    result.status.status = actionlib_msgs::GoalStatus::SUCCEEDED;
    result.result.success = success;
    result_publisher_.publish(result);
    spinFor(0.1);
  }

  void announce(const std::string& action) {
    Found found;
    found.action = action;
    found_publisher_.publish(found);
    spinFor(0.1);
  }

  std_srvs::Trigger::Response goOn() {
    std_srvs::Trigger trigger;
    // The node calls set_request meanwhile, so this thread must not wait here.
    ::ros::AsyncSpinner spinner(1);
    spinner.start();
    EXPECT_TRUE(::ros::service::call(node_.resolveName(kContinueService), trigger));
    return trigger.response;
  }

  std::uint32_t presentIn(const Scene& scene) const {
    std::uint32_t mask = 0;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) mask |= std::uint32_t{scene.instances[i].present} << i;
    return mask;
  }

  std::string pick_ = "server";
  std::shared_ptr<const world::World> world_;
  std::vector<sim::Instance> instances_;
  std::unique_ptr<sim::ConeTable> cone_;
  ::ros::NodeHandle node_;
  std::vector<std::string> items_, presses_;
  std::string asked_;
  std::uint32_t step_ = 0;
  ::ros::Time stamp_;
  SceneConstPtr scene_;
  ::ros::Publisher tf_publisher_, request_publisher_, action_publisher_, result_publisher_, found_publisher_;
  ::ros::Subscriber scene_subscriber_, press_subscriber_, put_back_subscriber_;
  ::ros::ServiceServer set_request_server_;
};

TEST_F(TfSceneTest, LeadsThroughEpisodesAndMakesTheirScenes) {
  const bool has_server = pick_ == "server";
  EXPECT_NE(
      asked_.find("put mug (mug_1), banana (banana_1), cracker_box (cracker_box_1), apple (apple_1) on the counter"),
      std::string::npos)
      << asked_;
  std_srvs::Trigger::Response answer = goOn();
  EXPECT_FALSE(answer.success);
  EXPECT_NE(answer.message.find("mug (mug_1)"), std::string::npos) << answer.message;
  track(::ros::Time::now(), 3);
  spinFor(0.2);
  answer = goOn();
  EXPECT_FALSE(answer.success);
  EXPECT_EQ(answer.message, "not seen on the counter: apple (apple_1); put them back");
  track(::ros::Time::now());
  spinFor(0.2);
  answer = goOn();
  ASSERT_TRUE(answer.success) << answer.message;
  ASSERT_EQ(items_.size(), 2u);
  EXPECT_FALSE(goOn().success) << "an episode is being played";

  // 1: the scene is what the frames say.
  const int first = static_cast<int>(std::find(kItems.begin(), kItems.end(), items_[0]) - kItems.begin());
  const world::Orientation at_first = towards(first);
  SceneConstPtr scene = ask(at_first);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->header.frame_id, world_->rig.worldFrame());
  EXPECT_EQ(scene->pan, at_first.pan);
  EXPECT_EQ(scene->tilt, at_first.tilt);
  EXPECT_EQ(scene->request, items_);
  EXPECT_EQ(presentIn(*scene), 0b1111u);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(scene->instances[i].item, kItems[i]);
    EXPECT_NEAR(scene->instances[i].x, instances_[i].x, 1e-9);
    EXPECT_NEAR(scene->instances[i].y, instances_[i].y, 1e-9);
    EXPECT_NEAR(scene->instances[i].theta, instances_[i].theta, 1e-9);
  }
  act("PAN_LEFT");

  // 2: without the camera's pose there is no scene, and what is taken then is not known.
  EXPECT_FALSE(ask(at_first, ::ros::Time::now(), false, 1));
  act("COLLECT");
  has_server ? endPick(true) : announce("COLLECT");
  ASSERT_TRUE(scene = ask(at_first));
  EXPECT_EQ(presentIn(*scene), 0b1111u);

  // 3: a pick that fails, or announces no collection, takes nothing away.
  act(has_server ? "COLLECT" : "REMOVE");
  has_server ? endPick(false) : announce("REMOVE");
  ASSERT_TRUE(scene = ask(at_first));
  EXPECT_EQ(presentIn(*scene), 0b1111u);
  EXPECT_EQ(scene->previous_action, has_server ? "COLLECT" : "REMOVE");

  // 4: a pick that never ends is given up, and its late result does not count.
  act("COLLECT");
  if (has_server) {
    spinFor(2.5);
    endPick(true);
    ASSERT_TRUE(scene = ask(at_first));
    EXPECT_EQ(presentIn(*scene), 0b1111u);
    act("COLLECT");
  }

  // 5: what was collected is gone, although its frame is still seen.
  has_server ? endPick(true) : announce("COLLECT");
  items_.erase(items_.begin());
  ASSERT_TRUE(scene = ask(at_first));
  EXPECT_EQ(presentIn(*scene), 0b1111u & ~(1u << first));
  EXPECT_TRUE(presses_.empty());

  // The last actions end the episode.
  act("PAN_LEFT");
  if (!has_server) {
    ASSERT_TRUE(ask(at_first));
    act("PAN_LEFT");
  }
  EXPECT_TRUE(spinUntil([&] { return presses_ == std::vector<std::string>{kEpisodeDone}; })) << presses_.size();
  EXPECT_TRUE(spinUntil([&] { return asked_.find("put back") == 0; })) << asked_;
  EXPECT_EQ(asked_.find("put back " + kItems[first] + " (" + kItems[first] + "_1), move the objects as you like"), 0u)
      << asked_;
  EXPECT_TRUE(items_.empty()) << "nothing is requested between episodes";

  // The next episode, after the time has jumped back by far more than the tracker's stamps may differ.
  track(::ros::Time::now());
  spinFor(0.2);
  answer = goOn();
  ASSERT_TRUE(answer.success) << answer.message;
  step_ = 0;
  ASSERT_TRUE(scene = ask(at_first));
  EXPECT_EQ(scene->episode, 1u);
  EXPECT_EQ(presentIn(*scene), 0b1111u);
  ASSERT_TRUE(scene = ask(at_first, ::ros::Time::now() - ::ros::Duration(1000)));
  EXPECT_EQ(presentIn(*scene), 0b1111u);
}

}  // namespace
}  // namespace early_fusion::nodes

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "tf_scene_rostest");
  ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
