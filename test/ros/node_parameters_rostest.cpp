// A node with a wrong parameter must end with exit code 1 and name the parameter.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/node_handle.h>
#include <ros/param.h>

#include <algorithm>

#include "child_process.h"
#include "early_fusion/ros/policy/policy_node.h"
#include "early_fusion/ros/robot/pan_tilt_driver_node.h"
#include "early_fusion/ros/robot/request_node.h"
#include "early_fusion/ros/shared/topics.h"
#include "early_fusion/ros/simulator/simulator_node.h"
#include "early_fusion/ros/trainer/evaluator_node.h"
#include "early_fusion/ros/trainer/session_monitor_node.h"
#include "early_fusion/ros/trainer/trainer_node.h"
#include "early_fusion/ros/virtual_robot/virtual_robot_node.h"
#include "learning/small_session.h"

namespace early_fusion::nodes {
namespace {

struct Case {
  std::string node;
  std::vector<std::string> arguments;
  std::vector<std::string> words;  ///< that the message must hold
};

std::ostream& operator<<(std::ostream& stream, const Case& c) { return stream << c.node << " " << c.arguments[0]; }

class NodeParameters : public testing::TestWithParam<Case> {};

TEST_P(NodeParameters, AMistakeIsNamedAndTheNodeEnds) {
  const learning::SmallSession files;
  std::vector<std::string> command = {std::string(EARLY_FUSION_NODES) + "/" + GetParam().node};
  for (const std::string& argument : GetParam().arguments) command.push_back(argument);
  // A node of a name of its own: the master keeps parameters.
  static int count = 0;
  command.push_back("__name:=" + GetParam().node + std::to_string(++count));
  ChildProcess node(command, {}, files.path("log"));
  ASSERT_TRUE(node.ends(20)) << node.output();
  EXPECT_EQ(node.exitCode(), 1) << node.output();
  for (const std::string& word : GetParam().words) {
    EXPECT_NE(node.output().find(word), std::string::npos) << "expected '" << word << "' in:\n" << node.output();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Nodes, NodeParameters,
    testing::Values(
        Case{"simulator_node", {"_rate:=-3"}, {"rate", "-3", "[0, 10000] Hz"}},
        Case{"simulator_node", {"_free_run:=perhaps"}, {"free_run", "perhaps", "true | false"}},
        Case{"simulator_node", {"_tusk:=hard"}, {"tusk", "unknown", "task"}},
        Case{"simulator_node", {"_task:=impossible"}, {"impossible", "hard, medium, simple, three_of_eight"}},
        Case{"simulator_node", {"_world:=/nowhere.yaml"}, {"/nowhere.yaml"}},
        Case{"policy_node", {"_weights:=/nowhere.safetensors"}, {"/nowhere.safetensors"}},
        Case{"policy_node", {"_mode:=guess"}, {"mode", "guess", "argmax | sample"}},
        Case{"policy_node", {"_annotated_scale:=2.5"}, {"annotated_scale", "2.5", "[1, 16]"}},
        Case{"trainer_node", {"_preset:=fast"}, {"output", "folder"}},
        Case{"trainer_node", {"_output:=/tmp/x", "_channels:=7"}, {"channels", "7"}},
        Case{"trainer_node", {"_output:=/tmp/x", "_chanels:=32"}, {"'chanels'", "known are", "channels"}},
        Case{"trainer_node", {"_output:=/tmp/x", "_preset:=slow"}, {"slow", "fast"}},
        Case{"evaluator_node", {"_episodes:=0"}, {"episodes", "0", "[1, 1000000]"}},
        Case{"request_node", {"_rate:=often"}, {"rate", "often"}},
        Case{"pan_tilt_driver_node", {"_pan_joint:=neck"}, {"neck", "pan_joint"}},
        Case{"virtual_robot_node", {"_encoding:=jpeg"}, {"encoding", "jpeg", "bgr8 | rgb8"}},
        Case{"correction_node", {"_patience:=-1"}, {"patience", "-1", "[0, 3600] s"}},
        Case{"correction_node", {"_collect_button:=101"}, {"collect_button", "101", "[-1, 100]"}},
        Case{"correction_trainer_node", {"_output:=/tmp/x"}, {"from", "weights file"}},
        Case{"correction_trainer_node", {"_output:=/tmp/x", "_from:=/nowhere.safetensors"}, {"/nowhere.safetensors"}},
        Case{"correction_trainer_node", {"_preset:=slow"}, {"slow", "default"}},
        Case{"simulated_person_node", {"_errors:=0"}, {"errors", "0", "[1, 1000] steps"}},
        Case{"keyboard_node", {"_terminal:=/dev/null"}, {"terminal", "/dev/null is no terminal"}},
        Case{"session_monitor_node", {"_period:=0"}, {"period", "[0.05, 60] s"}}));

TEST(NodeFailure, IsNotedOnlyByTheNodesOfASession) {
  ::ros::init(::ros::M_string(), "node_parameters");
  const learning::SmallSession files;
  for (const bool in_session : {false, true}) {
    ::ros::param::set(kFailureParameter, "");
    ChildProcess::Environment environment;
    if (in_session) environment.emplace_back(kSessionVariable, "1");
    ChildProcess node({std::string(EARLY_FUSION_NODES) + "/policy_node", "__name:=failing", "_mode:=guess"},
                      environment, files.path("log"));
    ASSERT_TRUE(node.ends(20)) << node.output();
    std::string noted;
    ASSERT_TRUE(::ros::param::get(kFailureParameter, noted));
    EXPECT_EQ(noted.find("guess") != std::string::npos, in_session) << noted;
  }
  ::ros::param::del(kFailureParameter);
}

TEST(NodeStart, LeavesGroupsOfParametersToThePluginsThatKeepThemThere) {
  ::ros::init(::ros::M_string(), "node_parameters");
  ::ros::param::set("/plugged/compressed/mode", "any");
  const learning::SmallSession files;
  ChildProcess node({std::string(EARLY_FUSION_NODES) + "/request_node", "__name:=plugged"}, {}, files.path("log"));
  const auto is_up = [] {
    ::ros::master::V_TopicInfo topics;
    ::ros::master::getTopics(topics);
    return std::any_of(topics.begin(), topics.end(),
                       [](const ::ros::master::TopicInfo& topic) { return topic.name == "/request"; });
  };
  while (!is_up()) ASSERT_FALSE(node.ends(0.05)) << node.output();
}

TEST(NodeStart, SaysThatSimulatedTimeStandsStillAndReportsOn) {
  ::ros::init(::ros::M_string(), "node_parameters");
  ::ros::start();  // before the parameter is set: this process goes by wall time, and stays up after its handle
  const learning::SmallSession files;
  ::ros::param::set("/use_sim_time", true);
  ChildProcess node({std::string(EARLY_FUSION_NODES) + "/pan_tilt_driver_node", "__name:=timeless"}, {},
                    files.path("log"));
  while (node.output().find("/use_sim_time is true") == std::string::npos) {
    ASSERT_FALSE(node.ends(0.1)) << node.output();
  }
  // Its diagnostics go on.
  int reports = 0;
  ::ros::NodeHandle handle;
  const ::ros::Subscriber subscriber = handle.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10, [&](const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
        reports += array->status.at(0).name == "timeless: status";
      });
  while (reports < 2) {
    ::ros::getGlobalCallbackQueue()->callAvailable(::ros::WallDuration(0.1));
    ASSERT_FALSE(node.ends(0)) << node.output();
  }
  ::ros::param::del("/use_sim_time");
}

/// Checks the --help of the program `name` against the options that its node has.
template <class Node>
void expectHelp(const std::string& name) {
  const learning::SmallSession files;
  ChildProcess program({std::string(EARLY_FUSION_NODES) + "/" + name, "--help"}, {}, files.path("log"));
  ASSERT_TRUE(program.ends(20)) << name;
  EXPECT_EQ(program.exitCode(), 0) << name;
  const std::string help = program.output();
  typename Node::Options defaults;
  const core::OptionSet set = defaults.options();
  EXPECT_FALSE(set.options().empty()) << name;
  for (const core::Option& option : set.options()) {
    const std::size_t begin = help.find("  _" + option.name + ":=");
    ASSERT_NE(begin, std::string::npos) << option.name << " is not in\n" << help;
    const std::string line = help.substr(begin, help.find('\n', begin) - begin);
    EXPECT_NE(line.find(":=" + (option.initial.empty() ? "\"\"" : option.initial) + " "), std::string::npos) << line;
    EXPECT_NE(line.find(" " + option.range), std::string::npos) << line;
    EXPECT_EQ(line.substr(line.size() - option.unit.size()), option.unit) << line;
  }
}

TEST(NodeHelp, ListsEveryParameterOfEveryNodeWithRangeUnitAndDefault) {
  expectHelp<SimulatorNode>("simulator_node");
  expectHelp<PolicyNode>("policy_node");
  expectHelp<TrainerNode>("trainer_node");
  expectHelp<EvaluatorNode>("evaluator_node");
  expectHelp<RequestNode>("request_node");
  expectHelp<PanTiltDriverNode>("pan_tilt_driver_node");
  expectHelp<SessionMonitorNode>("session_monitor_node");
  expectHelp<VirtualRobotNode>("virtual_robot_node");
}

}  // namespace
}  // namespace early_fusion::nodes
