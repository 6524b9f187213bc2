// Whole sessions through roslaunch: that they end by themselves, learn what the command line learns, bit for bit, and
// survive the death of any node.
#include <gtest/gtest.h>
#include <signal.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <thread>

#include "child_process.h"
#include "early_fusion/core/file.h"
#include "early_fusion/learning/training_session.h"
#include "early_fusion/model/policy_file.h"
#include "learning/small_session.h"
#include "own_master.h"

namespace early_fusion::nodes {
namespace {

namespace fs = std::filesystem;

constexpr double kSessionSec = 90;  // far more than a session takes: a limit for one that hangs

/// A master of its own, and the same small session trained in this process to compare with.
class SessionTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    files_ = new learning::SmallSession();
    trainHere(given("reference"));
  }
  static void TearDownTestSuite() { delete files_; }

  static std::vector<std::pair<std::string, std::string>> given(const std::string& output) {
    return {{"task", files_->task()},
            {"world", files_->world()},
            {"preset", files_->preset()},
            {"output", files_->path(output)},
            {"evaluation_episodes", std::to_string(learning::SmallSession::kEvaluationEpisodes)}};
  }

  static void trainHere(const std::vector<std::pair<std::string, std::string>>& given_options) {
    const learning::SessionOptions options = learning::resolveSessionOptions(given_options, "test");
    learning::TrainingSession session(options, world::loadWorld(options.world));
    learning::runSession(session, [](const learning::Progress&) {});
  }

  void SetUp() override {
    for (const char* program : {"roscore", "roslaunch", "rosbag", "rostopic"}) {
      if (!isOnPath(program)) GTEST_SKIP() << "there is no " << program << " on the PATH";
    }
    master_.emplace(files_->path(""));
    ASSERT_TRUE(master_->starts()) << master_->output();
  }

  std::unique_ptr<ChildProcess> launch(const std::string& file, const std::vector<std::string>& arguments) {
    return master_->launch(file, arguments);
  }

  std::unique_ptr<ChildProcess> launchTraining(const std::string& output, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments;
    for (const auto& [name, value] : given(output)) arguments.push_back(name + ":=" + value);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return launch("train.launch", arguments);
  }

  static std::string weights(const std::string& output) {
    return core::readFile(files_->path(output + "/weights.safetensors"));
  }
  static nlohmann::json result(const std::string& output) {
    return nlohmann::json::parse(core::readFile(files_->path(output + "/result.json")));
  }
  static bool exists(const std::string& name) { return fs::exists(files_->path(name)); }

  /// The processes of a node, one a worker, that this test's launches have started.
  static std::vector<int> processesOf(const std::string& node) {
    return processesWith({node + "_node", "__log:=" + files_->path("ros_home/log")});
  }

  static learning::SmallSession* files_;
  std::optional<OwnMaster> master_;
};

learning::SmallSession* SessionTest::files_ = nullptr;

TEST_F(SessionTest, TrainsTheWeightsOfTheCommandLineAndEndsByItself) {
  const auto session = launchTraining("run");
  ASSERT_TRUE(session->ends(kSessionSec)) << session->output();
  ASSERT_TRUE(exists("run/result.json")) << session->output();
  EXPECT_TRUE(weights("run") == weights("reference")) << session->output();
  const nlohmann::json one = result("run"), other = result("reference");
  EXPECT_EQ(one["per_episode"], other["per_episode"]);
  EXPECT_EQ(one["weights_id"], other["weights_id"]);
  // A line for each round, with what a person wants to know.
  const std::string total = std::to_string(learning::SmallSession::kTrajectories);
  EXPECT_NE(session->output().find("2/" + total), std::string::npos) << session->output();
  EXPECT_NE(session->output().find(total + "/" + total + " (100%)"), std::string::npos) << session->output();
}

TEST_F(SessionTest, KilledNodesComeBackAndTheWeightsAreTheSame) {
  const auto session = launchTraining("killed", {"separate:=true", "rate:=12", "respawn_delay:=0", "stall_timeout:=2"});
  // Each in the middle of a rollout, some time after everything has begun.
  ASSERT_TRUE(waitFor([] { return exists("killed/checkpoint.safetensors"); })) << session->output();
  for (const std::string node : {"policy", "simulator", "trainer"}) {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    const std::vector<int> before = processesOf(node);
    ASSERT_EQ(before.size(), node == "trainer" ? 1u : 2u) << session->output();
    const int victim = node == "policy" ? before.front() : before.back();
    ASSERT_FALSE(exists("killed/result.json")) << "too fast to be killed in between";
    ::kill(victim, SIGKILL);
    ASSERT_TRUE(waitFor([&] {
      const std::vector<int> now = processesOf(node);
      return now.size() == before.size() && std::count(now.begin(), now.end(), victim) == 0;
    })) << session->output();
  }
  ASSERT_TRUE(session->ends(kSessionSec)) << session->output();
  ASSERT_TRUE(exists("killed/result.json")) << session->output();
  EXPECT_TRUE(weights("killed") == weights("reference")) << session->output();
  EXPECT_EQ(result("killed")["per_episode"], result("reference")["per_episode"]);
}

TEST_F(SessionTest, AKilledProcessOfAllNodesComesBackAndTheWeightsAreTheSame) {
  const auto session = launchTraining("killed_whole", {"rate:=12", "respawn_delay:=0"});
  ASSERT_TRUE(waitFor([] { return exists("killed_whole/checkpoint.safetensors"); })) << session->output();
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_TRUE(processesOf("policy").empty() && processesOf("simulator").empty());
  const std::vector<int> before = processesOf("trainer");
  ASSERT_EQ(before.size(), 1u) << session->output();
  ASSERT_FALSE(exists("killed_whole/result.json")) << "too fast to be killed in between";
  ::kill(before[0], SIGKILL);
  ASSERT_TRUE(session->ends(kSessionSec)) << session->output();
  ASSERT_TRUE(exists("killed_whole/result.json")) << session->output();
  EXPECT_TRUE(weights("killed_whole") == weights("reference")) << session->output();
  EXPECT_EQ(result("killed_whole")["per_episode"], result("reference")["per_episode"]);
}

TEST_F(SessionTest, AnyNumberOfWorkersTrainsTheSameWeights) {
  // A round has two trajectories: the third worker has nothing to do in it.
  for (const std::string separate : {"true", "false"}) {
    for (const std::string workers : {"1", "3"}) {
      const std::string run = "workers" + workers + separate;
      const auto session = launchTraining(run, {"workers:=" + workers, "separate:=" + separate});
      ASSERT_TRUE(session->ends(kSessionSec)) << session->output();
      ASSERT_TRUE(exists(run + "/result.json")) << session->output();
      EXPECT_TRUE(weights(run) == weights("reference"));
    }
  }
}

TEST_F(SessionTest, ScoresOnTheWayAsTheCommandLineDoes) {
  auto scored = given("scored_here");
  scored.emplace_back("score_every", "3");
  trainHere(scored);
  const auto session = launchTraining("scored", {"options:={score_every: 3}"});
  ASSERT_TRUE(session->ends(kSessionSec)) << session->output();
  ASSERT_TRUE(exists("scored/result.json")) << session->output();
  EXPECT_TRUE(weights("scored") == weights("reference"));
  const auto scores = [](const std::string& output) {
    const std::string file = files_->path(output + "/scores.csv");
    return std::regex_replace(core::readFile(file), std::regex(R"((\n\d+,)[^,]*)"), "$1");  // without the minutes
  };
  EXPECT_EQ(scores("scored"), scores("scored_here"));
  EXPECT_EQ(result("scored")["per_episode"], result("reference")["per_episode"]);
}

TEST_F(SessionTest, AWorkerOfItsOwnEndsWithTheSession) {
  const std::vector<std::string> worker = {"__ns:=away/worker_5", "session:=/away", "world:=" + files_->world(),
                                           "timeout:=2"};
  const auto first = launch("worker.launch", worker);
  const auto session = launchTraining("away", {"__ns:=away", "private_tf:=true", "workers:=5"});
  ASSERT_TRUE(first->ends(kSessionSec)) << first->output() << session->output();
  EXPECT_NE(first->output().find("the session is finished: F1"), std::string::npos) << first->output();
  ASSERT_TRUE(session->ends(kSessionSec)) << session->output();
  EXPECT_TRUE(weights("away") == weights("reference")) << session->output();
}

TEST_F(SessionTest, AWorkerOfItsOwnEndsWhenTrainerOrMasterIsGone) {
  const std::vector<std::string> worker = {"__ns:=worker_5", "world:=" + files_->world(), "timeout:=2"};
  const auto trainerLess = launch("worker.launch", worker);
  const auto session = launchTraining("stopped", {"rate:=1"});
  ASSERT_TRUE(waitFor([&] { return trainerLess->output().find("a trainer publishes /progress") != std::string::npos; }))
      << trainerLess->output() << session->output();
  session->signal(SIGKILL);  // roslaunch; then nobody starts the trainer again, and nobody tells the master
  for (const int trainer : processesOf("trainer")) ::kill(trainer, SIGKILL);
  ASSERT_TRUE(trainerLess->ends(kSessionSec)) << trainerLess->output();
  EXPECT_NE(trainerLess->output().find("no trainer has published /progress for 2 s"), std::string::npos)
      << trainerLess->output();
  for (const char* left : {"session_monitor_node", "state_publisher"}) {
    for (const int process : processesWith({left, "__log:=" + files_->path("ros_home/log")})) ::kill(process, SIGKILL);
  }

  const auto masterLess = launch("worker.launch", worker);
  ASSERT_TRUE(waitFor([&] { return processesOf("session_monitor").size() == 1; })) << masterLess->output();
  std::this_thread::sleep_for(std::chrono::seconds(2));
  master_.reset();
  ASSERT_TRUE(masterLess->ends(kSessionSec)) << masterLess->output();
  EXPECT_NE(masterLess->output().find("has not answered for 2 s"), std::string::npos) << masterLess->output();
}

TEST_F(SessionTest, TwoSessionsOfTwoKindsSideBySideInTheirNamespaces) {
  const std::string kind = "softmax_attention_map";
  const auto left = launchTraining("left", {"__ns:=left", "private_tf:=true"});
  const auto right = launchTraining("right", {"__ns:=right", "private_tf:=true", "kind:=" + kind});
  ASSERT_TRUE(left->ends(kSessionSec)) << left->output();
  ASSERT_TRUE(right->ends(kSessionSec)) << right->output();
  ASSERT_TRUE(exists("left/result.json")) << left->output();
  ASSERT_TRUE(exists("right/result.json")) << right->output();
  EXPECT_TRUE(weights("left") == weights("reference"));
  auto attending = given("attending");
  attending.emplace_back("kind", kind);
  trainHere(attending);
  EXPECT_TRUE(weights("right") == weights("attending"));
  EXPECT_FALSE(weights("right") == weights("reference"));
}

/// The expert drives in the simulator, which knows the state; each round has a new policy and draws frames again.
TEST_F(SessionTest, ADaggerSessionWithAnExpertThatDrivesTrainsTheWeightsOfTheCommandLine) {
  const auto session = launchTraining(
      "dagger", {"options:={expert_share: 0.8, final_expert_share: 0.2, training_expert: searching, window: 0, "
                 "window_memory: 0, restart_policy: true, randomisation: real_camera}"});
  ASSERT_TRUE(session->ends(kSessionSec)) << session->output();
  ASSERT_TRUE(exists("dagger/result.json")) << session->output();
  auto here = given("dagger_here");
  for (const auto& [name, value] : core::GivenOptions{{"expert_share", "0.8"},
                                                      {"final_expert_share", "0.2"},
                                                      {"training_expert", "searching"},
                                                      {"window", "0"},
                                                      {"restart_policy", "true"},
                                                      {"randomisation", "real_camera"}}) {
    here.emplace_back(name, value);
  }
  trainHere(here);
  EXPECT_TRUE(weights("dagger") == weights("dagger_here"));
  EXPECT_FALSE(weights("dagger") == weights("reference"));
}

TEST_F(SessionTest, ASessionThatCannotRunEndsWithTheReason) {
  const auto session = launchTraining("never", {"seed:=lucky"});
  ASSERT_TRUE(session->ends(30)) << session->output();
  EXPECT_NE(session->output().find("the session cannot go on"), std::string::npos) << session->output();
  EXPECT_NE(session->output().find("'lucky'"), std::string::npos) << session->output();
}

TEST_F(SessionTest, ARunFolderIsNotOverwrittenUnlessResumed) {
  const std::string before = weights("reference");
  const auto refused = launchTraining("reference");
  ASSERT_TRUE(refused->ends(30)) << refused->output();
  EXPECT_NE(refused->output().find("holds a training session; resume it"), std::string::npos) << refused->output();
  const auto resumed = launchTraining("reference", {"resume:=true"});
  ASSERT_TRUE(resumed->ends(kSessionSec)) << resumed->output();
  EXPECT_TRUE(weights("reference") == before);
}

TEST_F(SessionTest, EvaluatesAsTheCommandLineDoes) {
  const std::string path = files_->path("reference/weights.safetensors");
  const auto launched = launch("evaluate.launch", {"weights:=" + path, "task:=" + files_->task(), "episodes:=5",
                                                   "world:=" + files_->world(), "precision:=f32", "pairs:=held_out",
                                                   "held_out_pairs:=0.5", "result:=" + files_->path("scores.json")});
  ASSERT_TRUE(launched->ends(kSessionSec)) << launched->output();
  ASSERT_TRUE(exists("scores.json")) << launched->output();
  EXPECT_NE(launched->output().find("agreement"), std::string::npos);

  const auto world = world::loadWorld(files_->world());
  const auto policy = model::loadPolicy(nn::WeightsFile::read(path), path, "f32");
  const auto agent = learning::makePolicyAgent(*policy, model::ActionChoice::kArgmax, learning::kHeldOutSeed);
  const sim::Task task = sim::withPairs("held_out", {0.5, 1}, sim::loadTask(files_->task()));
  learning::RolloutRunner runner(*world, task, learning::kHeldOutSeed);
  const auto expected = nlohmann::json::parse(learning::evaluate(runner, *agent, 5, path).toJson());
  const auto scores = nlohmann::json::parse(core::readFile(files_->path("scores.json")));
  EXPECT_EQ(scores["per_episode"], expected["per_episode"]);
  EXPECT_EQ(scores["f1"], expected["f1"]);
  EXPECT_EQ(scores["pairs"], "held_out");
}

TEST_F(SessionTest, ADemoIsRecordedAndTheBagPlaysToItsEnd) {
  const auto demo = launch("demo.launch", {"weights:=" + files_->path("reference/weights.safetensors"),
                                           "task:=" + files_->task(), "world:=" + files_->world(), "rate:=20"});
  const auto record = launch("record.launch", {"bag:=" + files_->path("demo.bag")});
  // rosbag subscribes, and then opens its file.
  ASSERT_TRUE(waitFor([&] { return fs::exists(files_->path("demo.bag.active")); }, kSessionSec)) << record->output();
  ChildProcess episodes({"rostopic", "echo", "-n", "3", "episode"}, master_->environment(),
                        files_->path("episodes.log"));
  ASSERT_TRUE(episodes.ends(kSessionSec)) << episodes.output();
  record->signal(SIGINT);
  ASSERT_TRUE(record->ends(kSessionSec)) << record->output();
  ChildProcess info({"rosbag", "info", files_->path("demo.bag")}, master_->environment(), files_->path("info.log"));
  ASSERT_TRUE(info.ends(60));
  // Topics keep their relative names, so that the bag plays in any namespace.
  for (const char* topic :
       {" camera/image_raw ", " camera/camera_info ", " camera/image_annotated ", " request ", " scene ", " action ",
        " episode ", " joint_states ", " markers ", " policy_status ", " /tf ", " /tf_static "}) {
    EXPECT_NE(info.output().find(topic), std::string::npos) << topic << "is not in\n" << info.output();
  }
  const auto timed = launch("record.launch", {"bag:=" + files_->path("timed.bag"), "duration:=1"});
  EXPECT_TRUE(timed->ends(kSessionSec)) << timed->output();
  const auto view = launch("view.launch", {"bag:=" + files_->path("demo.bag"), "rviz:=false", "speed:=4"});
  ASSERT_TRUE(view->ends(kSessionSec)) << view->output();
  // roslaunch's number for a node depends on whether it started the master too.
  EXPECT_TRUE(std::regex_search(view->output(), std::regex(R"(\[play-\d+\] has died!\nprocess has finished cleanly)")))
      << view->output();
  ChildProcess clock({"rosparam", "get", "/use_sim_time"}, master_->environment(), files_->path("clock.log"));
  ASSERT_TRUE(clock.ends(60));
  EXPECT_EQ(clock.output(), "false\n") << "time would stand still for whoever comes next";
}

}  // namespace
}  // namespace early_fusion::nodes
