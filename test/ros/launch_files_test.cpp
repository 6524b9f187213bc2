// Launch files agree with the options of the nodes that they start, and set the right parameters.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>

#include "child_process.h"
#include "early_fusion/core/file.h"
#include "early_fusion/learning/training_session.h"
#include "early_fusion/ros/correction/correction_node.h"
#include "early_fusion/ros/correction/correction_trainer_node.h"
#include "early_fusion/ros/correction/keyboard_node.h"
#include "early_fusion/ros/correction/simulated_person_node.h"
#include "early_fusion/ros/policy/policy_node.h"
#include "early_fusion/ros/robot/pan_tilt_driver_node.h"
#include "early_fusion/ros/robot/request_node.h"
#include "early_fusion/ros/robot/tf_scene_node.h"
#include "early_fusion/ros/simulator/simulator_node.h"
#include "early_fusion/ros/trainer/evaluator_node.h"
#include "early_fusion/ros/trainer/session_monitor_node.h"
#include "early_fusion/ros/trainer/trainer_node.h"
#include "early_fusion/ros/virtual_robot/virtual_robot_node.h"
#include "learning/small_session.h"

namespace early_fusion::nodes {
namespace {

namespace fs = std::filesystem;

constexpr double kLaunchSec = 60;  // far more than reading a launch file takes: a limit for one that hangs

template <class Node>
std::vector<core::Option> optionsOf() {
  static typename Node::Options options;
  return options.options().options();
}

const std::vector<core::Option>& optionsOfNode(const std::string& type) {
  static const std::map<std::string, std::vector<core::Option>> known = {
      {"correction_node", optionsOf<CorrectionNode>()},
      {"correction_trainer_node", optionsOf<CorrectionTrainerNode>()},
      {"evaluator_node", optionsOf<EvaluatorNode>()},
      {"keyboard_node", optionsOf<KeyboardNode>()},
      {"pan_tilt_driver_node", optionsOf<PanTiltDriverNode>()},
      {"policy_node", optionsOf<PolicyNode>()},
      {"request_node", optionsOf<RequestNode>()},
      {"session_monitor_node", optionsOf<SessionMonitorNode>()},
      {"tf_scene_node", optionsOf<TfSceneNode>()},
      {"simulated_person_node", optionsOf<SimulatedPersonNode>()},
      {"simulator_node", optionsOf<SimulatorNode>()},
      {"trainer_node", optionsOf<TrainerNode>()},
      {"virtual_robot_node", optionsOf<VirtualRobotNode>()}};
  return known.at(type);
}

struct Tag {
  std::string name;  ///< "/node" at its end
  std::map<std::string, std::string> attributes;
  bool empty;  ///< "<node .../>"
};

std::vector<Tag> tagsOf(const fs::path& file) {
  const std::string text = std::regex_replace(core::readFile(file), std::regex("<!--[^>]*-->"), "");
  const std::regex tag(R"re(<(/?[a-z]+)((?:\s+[a-z_-]+="[^"]*")*)\s*(/?)>)re"),
      attribute(R"re(([a-z_-]+)="([^"]*)")re");
  std::vector<Tag> tags;
  for (std::sregex_iterator found(text.begin(), text.end(), tag), end; found != end; ++found) {
    Tag& added = tags.emplace_back(Tag{(*found)[1], {}, (*found)[3].length() > 0});
    const std::string attributes = (*found)[2];
    for (std::sregex_iterator a(attributes.begin(), attributes.end(), attribute); a != end; ++a) {
      added.attributes[(*a)[1]] = (*a)[2];
    }
  }
  return tags;
}

/// A parameter that a launch file gives to one of the package's nodes.
struct GivenParameter {
  std::string node, name, value;
};

std::vector<GivenParameter> parametersGivenIn(const std::vector<Tag>& tags) {
  std::vector<GivenParameter> given;
  std::string node;
  for (const Tag& tag : tags) {
    if (tag.name == "node" && !tag.empty && tag.attributes.at("pkg") == "early_fusion")
      node = tag.attributes.at("type");
    if (tag.name == "/node") node.clear();
    if (tag.name == "param" && !node.empty()) {
      given.push_back({node, tag.attributes.at("name"), tag.attributes.at("value")});
    }
  }
  return given;
}

class LaunchFile : public testing::TestWithParam<std::string> {
 protected:
  fs::path file() const { return fs::path(core::shareFolder()) / "launch" / GetParam(); }
};

TEST_P(LaunchFile, GivesNodesTheParametersThatTheyHaveAndSaysTheirRanges) {
  const std::vector<Tag> tags = tagsOf(file());
  std::map<std::string, std::string> docs;
  for (const Tag& tag : tags) {
    if (tag.name == "arg" && tag.attributes.count("doc")) docs[tag.attributes.at("name")] = tag.attributes.at("doc");
  }
  for (const GivenParameter& given : parametersGivenIn(tags)) {
    const std::vector<core::Option>& options = optionsOfNode(given.node);
    const auto option = std::find_if(options.begin(), options.end(),
                                     [&](const core::Option& candidate) { return candidate.name == given.name; });
    ASSERT_NE(option, options.end()) << given.node << " has no parameter " << given.name;
    std::smatch argument;
    if (option->range == "text" || !std::regex_match(given.value, argument, std::regex(R"(\$\(arg (.*)\))"))) continue;
    EXPECT_NE(docs[argument[1]].find(option->range), std::string::npos)
        << "the argument " << argument[1] << " does not say " << option->range;
  }
}

std::vector<std::string> launchFiles() {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(fs::path(core::shareFolder()) / "launch")) {
    files.push_back(entry.path().filename());
  }
  std::sort(files.begin(), files.end());
  return files;
}

INSTANTIATE_TEST_SUITE_P(All, LaunchFile, testing::ValuesIn(launchFiles()),
                         [](const auto& info) { return fs::path(info.param).stem().string(); });

/// What roslaunch would do, without a master.
class Launch : public testing::Test {
 protected:
  /// What is printed in place of starting `file`.
  std::string dump(const std::string& file, const std::vector<std::string>& arguments) const {
    std::vector<std::string> command = {"roslaunch", "--dump-params", "early_fusion", file};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const ChildProcess::Environment environment = {
        {"EARLY_FUSION_SHARE", core::shareFolder()}, {"ROS_LOG_DIR", files_.path("log")}, {"USER", "somebody"}};
    ChildProcess roslaunch(command, environment, files_.path("dump"));
    EXPECT_TRUE(roslaunch.ends(kLaunchSec));
    return roslaunch.output();
  }
  std::string parameter(const std::string& name, const std::string& dumped) const {
    const YAML::Node value = YAML::Load(dumped)[name];
    return value ? value.as<std::string>() : "(none)";
  }
  std::string write(const std::string& name, const std::string& text) const {
    core::writeFileAtomically(files_.path(name), text);
    return files_.path(name);
  }

  const learning::SmallSession files_;
};

TEST_F(Launch, TrainReachesEveryOptionOfTrainingThroughOptions) {
  TrainerNode::Options options;
  const core::OptionSet set = options.options();
  std::string given;
  for (const core::Option& option : set.options()) given += option.name + ": 'given', ";
  for (const char* file : {"train.launch", "distributed.launch"}) {
    const std::string dumped = dump(file, {"output:=/tmp/run", "channels:=32", "options:={" + given + "}"});
    for (const core::Option& option : set.options()) {
      EXPECT_EQ(parameter("/trainer/" + option.name, dumped), "given") << file;
    }
  }
}

TEST_F(Launch, TrainLeavesToThePresetWhatIsNotGiven) {
  const std::string dumped = dump("train.launch", {"output:=/tmp/run", "channels:=32", "kind:=late_fusion"});
  EXPECT_EQ(parameter("/trainer/channels", dumped), "32");
  EXPECT_EQ(parameter("/trainer/kind", dumped), "late_fusion");
  const std::string defaults = dump("train.launch", {"output:=/tmp/run"});
  EXPECT_EQ(parameter("/trainer/kind", defaults), "(none)");
  for (const char* name : {"trajectories", "precision", "window", "dropout"}) {
    EXPECT_EQ(parameter(std::string("/trainer/") + name, dumped), "(none)");
  }
}

const std::pair<std::string, std::vector<std::string>> kWithUrdfs[] = {
    {"train.launch", {"output:=/tmp/run"}},
    {"evaluate.launch", {"weights:=/tmp/weights", "tf:=true"}},
    {"demo.launch", {}},
    {"view.launch", {"bag:=/tmp/bag"}},
    {"robot.launch", {}}};

TEST_F(Launch, TheUrdfsAreThoseOfTheWorldFile) {
  const std::string camera = write("other camera.urdf", "<robot name=\"other\"><link name=\"world\"/></robot>");
  const std::string kitchen = write("room.urdf", "<robot name=\"room\"><link name=\"world\"/></robot>");
  const std::string world = write("other world.yaml", "{camera_urdf: 'other camera.urdf', kitchen_urdf: room.urdf}");
  for (auto [file, arguments] : kWithUrdfs) {
    const std::string shipped = dump(file, arguments);
    const std::string urdf = core::shareFolder() + "/urdf/";
    EXPECT_EQ(parameter("/robot_description", shipped), core::readFile(urdf + "pan_tilt_camera.urdf")) << file;
    EXPECT_EQ(parameter("/kitchen_description", shipped), core::readFile(urdf + "kitchen.urdf")) << file;
    arguments.push_back("world:=" + world);
    const std::string other = dump(file, arguments);
    EXPECT_EQ(parameter("/robot_description", other), core::readFile(camera)) << file;
    EXPECT_EQ(parameter("/kitchen_description", other), core::readFile(kitchen)) << file;
  }
}

TEST_F(Launch, AWorldFileThatCannotBeReadEndsItAtOnceWithTheReason) {
  const std::string world = write("bad.yaml", "camera: mine.urdf");
  const std::string output = dump("demo.launch", {"world:=" + world});
  EXPECT_EQ(output.find("/simulator/task"), std::string::npos) << output;
  EXPECT_NE(output.find(world + ":1: unknown world option 'camera'; known are objects"), std::string::npos) << output;
}

struct WrongChoice {
  std::string file;
  std::vector<std::string> arguments;
  std::string error;
};

TEST_F(Launch, AValueThatIsNoChoiceEndsItAtOnceAndTheChoicesAreNamed) {
  const std::vector<WrongChoice> wrong = {
      {"real_camera.launch", {"robot:=Virtual"}, "robot is Virtual; it must be real or virtual"},
      {"real_camera.launch", {"pan_tilt:=maybe"}, "maybe is not a 'bool' type"},
      {"correct.launch", {"output:=/tmp/run", "robot:=real"}, "robot is real; it must be simulator or none"},
      {"correct.launch", {"output:=/tmp/run", "person:=tracked"}, "person:=tracked needs robot:=none"},
      {"correct.launch",
       {"output:=/tmp/run", "person:=me"},
       "person is me; it must be keyboard, simulated, tracked or none"},
      {"train.launch", {"output:=/tmp/run", "separate:=maybe"}, "maybe is not a 'bool' type"},
      {"view.launch", {"bag:=/tmp/bag", "loop:=maybe"}, "maybe is not a 'bool' type"},
      {"record.launch", {"bag:=/tmp/bag", "annotated:=maybe"}, "maybe is not a 'bool' type"}};
  for (const WrongChoice& choice : wrong) {
    const std::string output = dump(choice.file, choice.arguments);
    EXPECT_NE(output.find(choice.error), std::string::npos) << choice.file << ": " << output;
  }
}

TEST_F(Launch, ARealCameraGivesPositionsInTheFrameOfItsRobot) {
  EXPECT_EQ(parameter("/request/target_frame", dump("real_camera.launch", {})), "base_link");
  const std::string virtual_robot = dump("real_camera.launch", {"robot:=virtual"});
  EXPECT_EQ(parameter("/request/target_frame", virtual_robot), "world");
  EXPECT_EQ(parameter("/virtual_robot/task", virtual_robot), "medium");
}

}  // namespace
}  // namespace early_fusion::nodes
