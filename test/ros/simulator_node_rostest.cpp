// The simulator node, played against by a test in the policy's place.
#include <actionlib/client/simple_action_client.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <early_fusion/Action.h>
#include <early_fusion/EpisodeResult.h>
#include <early_fusion/Reset.h>
#include <early_fusion/RunEpisodesAction.h>
#include <early_fusion/SetRequest.h>
#include <gtest/gtest.h>
#include <image_transport/image_transport.h>
#include <visualization_msgs/MarkerArray.h>

#include <map>

#include "early_fusion/render/rasterizer.h"
#include "early_fusion/ros/shared/conversions.h"
#include "early_fusion/ros/shared/topics.h"
#include "learning/small_session.h"
#include "spin_until.h"

namespace early_fusion::nodes {
namespace {

class SimulatorNodeTest : public testing::Test {
 protected:
  SimulatorNodeTest() {
    scene_subscriber_ =
        node_.subscribe<Scene>(kSceneTopic, 100, [this](const SceneConstPtr& m) { scenes_.push_back(m); });
    request_subscriber_ = node_.subscribe<Request>(
        kRequestTopic, 100, [this](const RequestConstPtr& m) { requests_[m->header.stamp] = m; });
    image_subscriber_ = node_.subscribe<sensor_msgs::Image>(
        kImageTopic, 100, [this](const sensor_msgs::ImageConstPtr& m) { images_[m->header.stamp] = m; });
    info_subscriber_ = node_.subscribe<sensor_msgs::CameraInfo>(
        kCameraInfoTopic, 100, [this](const sensor_msgs::CameraInfoConstPtr& m) { infos_[m->header.stamp] = m; });
    joint_subscriber_ = node_.subscribe<sensor_msgs::JointState>(
        kJointStatesTopic, 100, [this](const sensor_msgs::JointStateConstPtr& m) { joints_[m->header.stamp] = m; });
    result_subscriber_ = node_.subscribe<EpisodeResult>(
        kEpisodeTopic, 100, [this](const EpisodeResultConstPtr& m) { results_.push_back(m); });
    action_publisher_ = node_.advertise<Action>(kActionTopic, 100);
  }

  void SetUp() override {
    ASSERT_TRUE(::ros::service::waitForService(kResetService, 20000));
    ASSERT_TRUE(spinUntil([&] {
      return action_publisher_.getNumSubscribers() > 0 && scene_subscriber_.getNumPublishers() > 0 &&
             request_subscriber_.getNumPublishers() > 0 && image_subscriber_.getNumPublishers() > 0 &&
             info_subscriber_.getNumPublishers() > 0 && joint_subscriber_.getNumPublishers() > 0;
    }));
    // Connections of this test's predecessor may linger: only what is published from here on counts.
    ASSERT_TRUE(reset(3, 5));
    ASSERT_TRUE(awaitStep(5, 0));
  }

  bool reset(std::uint64_t seed, std::uint64_t episode, const std::string& task = "simple") {
    Reset call;
    call.request.task = task;
    call.request.seed = seed;
    call.request.episode = episode;
    const bool called = ::ros::service::call(kResetService, call);
    message_ = call.response.message;
    return called && call.response.success;
  }

  /// Waits until a step has been published, with all its messages.
  bool awaitStep(std::uint64_t episode, std::uint32_t step) {
    return spinUntil([&] {
      if (scenes_.empty() || scenes_.back()->episode != episode || scenes_.back()->step != step) return false;
      const ::ros::Time stamp = scenes_.back()->header.stamp;
      return images_.count(stamp) && infos_.count(stamp) && requests_.count(stamp) && joints_.count(stamp);
    });
  }

  Action answer(const std::string& name) const {
    Action action;
    action.header.stamp = scenes_.back()->header.stamp;
    action.episode = scenes_.back()->episode;
    action.step = scenes_.back()->step;
    action.name = name;
    return action;
  }

  ::ros::NodeHandle node_;
  ::ros::Subscriber scene_subscriber_, request_subscriber_, image_subscriber_, info_subscriber_, joint_subscriber_,
      result_subscriber_;
  ::ros::Publisher action_publisher_;
  std::vector<SceneConstPtr> scenes_;
  std::map<::ros::Time, RequestConstPtr> requests_;
  std::map<::ros::Time, sensor_msgs::ImageConstPtr> images_;
  std::map<::ros::Time, sensor_msgs::CameraInfoConstPtr> infos_;
  std::map<::ros::Time, sensor_msgs::JointStateConstPtr> joints_;
  std::vector<EpisodeResultConstPtr> results_;
  std::string message_;
  const learning::SmallSession files_;
  const std::shared_ptr<const world::World> world_ = world::loadWorld("");
};

TEST_F(SimulatorNodeTest, AStepIsOneStampOnFiveTopicsInTheRightFrames) {
  const Scene scene = *scenes_.back();
  const ::ros::Time stamp = scene.header.stamp;
  EXPECT_EQ(scene.header.frame_id, "world");
  EXPECT_EQ(scene.task, "simple");
  EXPECT_EQ(scene.seed, 3u);
  EXPECT_EQ(scene.steps, 48u);
  EXPECT_EQ(scene.instances.size(), 4u);
  EXPECT_EQ(scene.previous_action, "");

  const sensor_msgs::Image& image = *images_[stamp];
  EXPECT_EQ(image.header.frame_id, "camera_optical_frame");
  EXPECT_EQ(image.width, 128u);
  EXPECT_EQ(image.height, 128u);
  EXPECT_EQ(image.encoding, "rgb8");

  const sensor_msgs::CameraInfo& info = *infos_[stamp];
  EXPECT_EQ(info.header.frame_id, "camera_optical_frame");
  EXPECT_NEAR(info.K[0], 64 / std::tan(M_PI / 6), 1e-9);
  EXPECT_DOUBLE_EQ(info.K[2], 63.5);

  EXPECT_EQ(requests_[stamp]->episode, 5u);
  EXPECT_EQ(requests_[stamp]->items, scene.request);
  EXPECT_EQ(joints_[stamp]->name, (std::vector<std::string>{"pan_joint", "tilt_joint"}));
  EXPECT_NEAR(joints_[stamp]->position[0], scene.pan * world::kStepRad, 1e-12);
  EXPECT_NEAR(joints_[stamp]->position[1], scene.tilt * world::kStepRad, 1e-12);
}

TEST_F(SimulatorNodeTest, TheImageIsTheRasterizersOfThatEpisode) {
  const sim::Task task = sim::loadTask("simple");
  const sim::Episode episode(*world_, {task, 3, 5});
  render::Rasterizer rasterizer(*world_, 128);
  core::Image expected;
  rasterizer.setObjects(sim::presentObjects(*world_, episode.setup().instances, episode.state().present));
  rasterizer.render(world_->rig.worldFromCamera(episode.state().orientation), expected);
  EXPECT_EQ(images_[scenes_.back()->header.stamp]->data, expected.rgb);
}

TEST_F(SimulatorNodeTest, TheNextStepComesWithTheActionAndNotBefore) {
  spinFor(0.1);
  EXPECT_EQ(scenes_.back()->step, 0u);
  const int pan = scenes_.back()->pan;
  const ::ros::Time before = scenes_.back()->header.stamp;
  // One of the two moves is possible at any joint angle.
  const std::string move = pan > 0 ? "PAN_RIGHT" : "PAN_LEFT";
  action_publisher_.publish(answer(move));
  ASSERT_TRUE(awaitStep(5, 1));
  EXPECT_EQ(scenes_.back()->previous_action, move);
  EXPECT_EQ(scenes_.back()->pan, pan > 0 ? pan - 1 : pan + 1);
  EXPECT_GT(scenes_.back()->header.stamp, before);
}

TEST_F(SimulatorNodeTest, StaleRepeatedAndUnknownActionsChangeNothing) {
  const Action first = answer("IDLE");
  action_publisher_.publish(first);
  ASSERT_TRUE(awaitStep(5, 1));
  Action of_another_episode = answer("IDLE");
  of_another_episode.episode = 77;
  Action of_another_image = answer("IDLE");
  of_another_image.header.stamp += ::ros::Duration(1);
  for (const Action& bad : {first, of_another_episode, of_another_image, answer("JUMP"), answer("")}) {
    action_publisher_.publish(bad);
  }
  spinFor(0.2);
  EXPECT_EQ(scenes_.back()->step, 1u);
  action_publisher_.publish(answer("IDLE"));
  EXPECT_TRUE(awaitStep(5, 2));
}

TEST_F(SimulatorNodeTest, DroppedActionsAreCountedInDiagnostics) {
  std::map<std::string, std::string> values;
  int warnings = 0;
  const ::ros::Subscriber subscriber = node_.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 100, [&](const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
        for (const diagnostic_msgs::DiagnosticStatus& status : array->status) {
          if (status.name != "simulator: status") continue;
          warnings += status.level == diagnostic_msgs::DiagnosticStatus::WARN;
          for (const diagnostic_msgs::KeyValue& value : status.values) values[value.key] = value.value;
        }
      });
  ASSERT_TRUE(spinUntil([&] { return values.count("steps") != 0; }));
  warnings = 0;
  action_publisher_.publish(answer("JUMP"));
  EXPECT_TRUE(spinUntil([&] { return std::atoi(values["dropped: unknown action"].c_str()) > 0 && warnings > 0; }));
}

TEST_F(SimulatorNodeTest, AnUnansweredStepIsPublishedAgainAsItWas) {
  const Scene first = *scenes_.back();
  scenes_.clear();
  images_.clear();
  ASSERT_TRUE(spinUntil([&] { return !scenes_.empty() && !images_.empty(); }));
  EXPECT_EQ(scenes_.back()->header.stamp, first.header.stamp);
  EXPECT_EQ(images_.begin()->first, first.header.stamp);
  EXPECT_EQ(scenes_.back()->step, 0u);
}

TEST_F(SimulatorNodeTest, ARequestByHandIsAskedAtOnce) {
  const std::string item = scenes_.back()->instances.back().item;
  SetRequest call;
  call.request.items = {item};
  ASSERT_TRUE(::ros::service::call(kSetRequestService, call));
  EXPECT_TRUE(call.response.success) << call.response.message;
  EXPECT_TRUE(spinUntil([&] { return scenes_.back()->request == std::vector<std::string>{item}; }));

  call.request.items = {"anvil"};
  ASSERT_TRUE(::ros::service::call(kSetRequestService, call));
  EXPECT_FALSE(call.response.success);
  EXPECT_NE(call.response.message.find("anvil"), std::string::npos);
}

TEST_F(SimulatorNodeTest, AResetWithAnUnknownTaskIsRefused) {
  EXPECT_FALSE(reset(1, 1, "impossible"));
  EXPECT_NE(message_.find("impossible"), std::string::npos);
  EXPECT_FALSE(reset(1, 1, "/etc/passwd"));
  EXPECT_EQ(message_.find("root"), std::string::npos) << "shows what is in a file: " << message_;
}

TEST_F(SimulatorNodeTest, AGoalPlaysItsEpisodesInOrder) {
  actionlib::SimpleActionClient<RunEpisodesAction> client(node_, kRunEpisodesAction, false);
  ASSERT_TRUE(spinUntil([&] { return client.isServerConnected(); }));
  RunEpisodesGoal goal;
  goal.task = sim::taskText(sim::loadTask(files_.task()));
  goal.seed = 9;
  goal.max_instances = 6;
  goal.first_episode = 20;
  goal.episodes = 2;
  client.sendGoal(goal);
  for (std::uint64_t episode : {20, 21}) {
    for (int step = 0; step < learning::SmallSession::kSteps; ++step) {
      ASSERT_TRUE(awaitStep(episode, step)) << episode << " " << step;
      EXPECT_FALSE(reset(1, 1)) << "a goal is being played";
      const sim::Task task = sim::withUpTo(6, sim::loadTask(files_.task()));
      EXPECT_EQ(scenes_.back()->instances.size(), sim::sampleEpisode(*world_, {task, 9, episode}).instances.size());
      action_publisher_.publish(answer("IDLE"));
    }
  }
  ASSERT_TRUE(spinUntil([&] { return client.getState().isDone() && results_.size() == 2; }));
  EXPECT_EQ(client.getState(), actionlib::SimpleClientGoalState::SUCCEEDED);
  EXPECT_EQ(client.getResult()->episodes, 2u);
  EXPECT_EQ(results_[0]->episode, 20u);
  EXPECT_EQ(results_[1]->episode, 21u);
  EXPECT_EQ(results_[1]->task, "short");
  EXPECT_EQ(results_[1]->steps, static_cast<std::uint32_t>(learning::SmallSession::kSteps));
  EXPECT_EQ(results_[1]->collected, 0u);
}

TEST_F(SimulatorNodeTest, TheExpertDrivesTheStepsThatAGoalGivesIt) {
  actionlib::SimpleActionClient<RunEpisodesAction> client(node_, kRunEpisodesAction, false);
  ASSERT_TRUE(spinUntil([&] { return client.isServerConnected(); }));
  RunEpisodesGoal goal;
  goal.task = sim::taskText(sim::loadTask(files_.task()));
  goal.seed = 9;
  goal.first_episode = 30;
  goal.episodes = 2;
  goal.expert_share = 0.5;
  goal.training_expert = "searching";
  client.sendGoal(goal);
  const learning::ExpertDrive drive = expertDrive(goal);
  int driven = 0;
  for (std::uint64_t number : {30, 31}) {
    sim::Episode episode(*world_, {sim::loadTask(files_.task()), 9, number});
    std::vector<int> pans;
    for (int step = 0; step < learning::SmallSession::kSteps; ++step) {
      ASSERT_TRUE(awaitStep(number, step)) << number << " " << step;
      const sim::EpisodeState& state = episode.state();
      EXPECT_EQ(scenes_.back()->pan, state.orientation.pan);
      EXPECT_EQ(scenes_.back()->tilt, state.orientation.tilt);
      pans.push_back(state.orientation.pan);
      action_publisher_.publish(answer("TILT_UP"));
      const bool expert_drives = drive.drives(9, number, step);
      driven += expert_drives;
      episode.step(expert_drives
                       ? expert::searchingLabel(episode.cone(), episode.setup().instances, state.present,
                                                state.orientation, expert::panDirectionOver(pans), state.request)
                             .action
                       : core::Action::kTiltUp);
    }
  }
  ASSERT_TRUE(spinUntil([&] { return client.getState().isDone(); }));
  EXPECT_GT(driven, 0);
  EXPECT_LT(driven, 2 * learning::SmallSession::kSteps);
}

TEST_F(SimulatorNodeTest, AGoalThatCannotBePlayedIsAbortedWithTheReason) {
  actionlib::SimpleActionClient<RunEpisodesAction> client(node_, kRunEpisodesAction, false);
  ASSERT_TRUE(spinUntil([&] { return client.isServerConnected(); }));
  RunEpisodesGoal goal;
  goal.task = "impossible";
  goal.episodes = 1;
  client.sendGoal(goal);
  ASSERT_TRUE(spinUntil([&] { return client.getState().isDone(); }));
  EXPECT_EQ(client.getState(), actionlib::SimpleClientGoalState::ABORTED);
  EXPECT_NE(client.getState().getText().find("impossible"), std::string::npos);
  goal.task = "simple";
  goal.episodes = 0;
  client.sendGoal(goal);
  ASSERT_TRUE(spinUntil([&] { return client.getState().isDone(); }));
  EXPECT_EQ(client.getState(), actionlib::SimpleClientGoalState::ABORTED);
  EXPECT_NE(client.getState().getText().find("episodes is 0"), std::string::npos);
  goal.episodes = 1;
  goal.max_instances = 4000000000u;
  client.sendGoal(goal);
  ASSERT_TRUE(spinUntil([&] { return client.getState().isDone(); }));
  EXPECT_EQ(client.getState(), actionlib::SimpleClientGoalState::ABORTED);
  EXPECT_NE(client.getState().getText().find("max_instances is 4000000000"), std::string::npos);
  goal.max_instances = 0;
  goal.expert_share = -1;
  client.sendGoal(goal);
  ASSERT_TRUE(spinUntil([&] { return client.getState().isDone(); }));
  EXPECT_EQ(client.getState(), actionlib::SimpleClientGoalState::ABORTED);
  EXPECT_NE(client.getState().getText().find("expert_share is -1"), std::string::npos);
}

TEST_F(SimulatorNodeTest, MarkersShowTheObjectsToWhoLooks) {
  visualization_msgs::MarkerArrayConstPtr markers;
  const ::ros::Subscriber subscriber = node_.subscribe<visualization_msgs::MarkerArray>(
      kMarkersTopic, 10, [&](const visualization_msgs::MarkerArrayConstPtr& m) { markers = m; });
  ASSERT_TRUE(spinUntil([&] { return subscriber.getNumPublishers() > 0; }));
  ASSERT_TRUE(spinUntil([&] {
    if (!markers) reset(3, 5);
    spinFor(0.1);
    return markers != nullptr;
  }));
  EXPECT_GE(markers->markers.size(), 5u);
  EXPECT_EQ(markers->markers[1].header.frame_id, "world");
}

}  // namespace
}  // namespace early_fusion::nodes

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "simulator_node_rostest");
  ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
