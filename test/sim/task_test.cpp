#include "early_fusion/sim/task.h"

#include <gtest/gtest.h>

#include "world/test_world.h"

namespace early_fusion::sim {
namespace {

std::string errorOfTask(const std::string& yaml) {
  const world::TestFolder folder;
  const std::string file = folder.write("mine.yaml", yaml);
  return world::errorOf([&] { loadTask(file); });
}

bool mentions(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

struct Expected {
  const char* name;
  int instances, requested;
};

class ShippedTask : public testing::TestWithParam<Expected> {};

TEST_P(ShippedTask, IsThePapers) {
  const Task task = loadTask(GetParam().name);
  EXPECT_EQ(task.name, GetParam().name);
  EXPECT_EQ(task.instances, GetParam().instances);
  EXPECT_EQ(task.requested, GetParam().requested);
  EXPECT_EQ(task.steps, 48);
}

INSTANTIATE_TEST_SUITE_P(AllThree, ShippedTask,
                         testing::Values(Expected{"simple", 4, 1}, Expected{"medium", 8, 2}, Expected{"hard", 12, 3}),
                         [](const auto& info) { return info.param.name; });

TEST(Task, TheDefaultsAreThoseOfSimple) {
  Task simple = loadTask("simple"), defaults;
  defaults.name = simple.name;
  EXPECT_EQ(simple.options().toYaml(), defaults.options().toYaml());
}

TEST(Task, TakesItsNameFromTheFileWhenNoneIsGiven) {
  const world::TestFolder folder;
  EXPECT_EQ(loadTask(folder.write("crowded.yaml", "instances: 20\n")).name, "crowded");
  EXPECT_EQ(loadTask(folder.write("crowded.yaml", "name: full\ninstances: 20\n")).name, "full");
}

TEST(Task, ListsTheKnownOnesForAnUnknownName) {
  const std::string error = world::errorOf([] { loadTask("harder"); });
  EXPECT_TRUE(mentions(error, "'harder' is neither a name in config/tasks (hard, medium, simple, three_of_eight) nor"))
      << error;
  EXPECT_TRUE(mentions(world::errorOf([] { loadTask(""); }), "'' is neither a name in config/tasks"));
}

TEST(Task, NamesFileKeyAndValueOfAMistake) {
  EXPECT_TRUE(mentions(world::errorOf([] { loadTask("/no/such.yaml"); }), "/no/such.yaml"));
  const std::pair<std::string, std::string> mistakes[] = {{"instances", "33"}, {"requested", "-1"}, {"steps", "0"}};
  for (const auto& [key, value] : mistakes) {
    const std::string error = errorOfTask(key + ": " + value + "\n");
    EXPECT_TRUE(mentions(error, "mine.yaml:1") && mentions(error, key) && mentions(error, "'" + value + "'")) << error;
  }
  const std::string unknown = errorOfTask("object: 4\n");
  EXPECT_TRUE(mentions(unknown, "mine.yaml:1") && mentions(unknown, "'object'")) << unknown;
  EXPECT_TRUE(mentions(errorOfTask("instances: [4\n"), "mine.yaml"));
}

TEST(Task, AMessageHasTheWholeTaskAndNamesNoFile) {
  const world::TestFolder folder;
  const std::string file = folder.write("odd.yaml", "{name: 'a, {b}: c', instances: 7, requested: 2, steps: 9}");
  Task task = loadTask(file), parsed = parseTask(taskText(task));
  EXPECT_EQ(parsed.name, "a, {b}: c");
  EXPECT_EQ(parsed.options().toYaml(), task.options().toYaml());
  EXPECT_EQ(parseTask("hard").instances, 12);
  EXPECT_EQ(parseTask("{instances: 6}").instances, 6);
  for (const std::string& path : {file, std::string("odd.yaml"), std::string("/etc/shadow"), std::string("../x")}) {
    EXPECT_TRUE(mentions(world::errorOf([&] { parseTask(path); }), "task: '" + path + "' names a file; messages name"));
  }
  EXPECT_TRUE(mentions(world::errorOf([] { parseTask("{instances: 99}"); }), "instances: '99' is out of range"));
  EXPECT_TRUE(mentions(world::errorOf([] { parseTask("{instances: 2, requested: 3}"); }), "requested is 3"));
  EXPECT_TRUE(mentions(world::errorOf([] { parseTask("{instances: 2"); }), "is not valid YAML"));
}
TEST(Task, CannotRequestMoreThanThereIs) {
  const std::string error = errorOfTask("instances: 2\nrequested: 3\n");
  EXPECT_TRUE(mentions(error, "mine.yaml: requested is 3; it must be at most instances, 2")) << error;
}

TEST(Task, WithUpToSoManyInstancesHasNoFewerThanBefore) {
  EXPECT_EQ(withUpTo(12, loadTask("simple")).instances, 4);
  EXPECT_EQ(withUpTo(12, loadTask("simple")).maxInstances(), 12);
  EXPECT_EQ(withUpTo(12, withUpTo(20, loadTask("simple"))).maxInstances(), 20);
  EXPECT_EQ(withUpTo(5, loadTask("hard")).maxInstances(), 12);
}

TEST(Task, WithPairsNamesWhatDoesNotFit) {
  const Task medium = loadTask("medium");
  EXPECT_EQ(withPairs("held_out", {0.5, 7}, medium).pairs, PairChoice::kHeldOut);
  EXPECT_EQ(withPairs("held_out", {0.5, 7}, medium).pair_split.held_out_pairs_seed, 7u);
  EXPECT_EQ(withPairs("all", {0, 1}, loadTask("simple")).pairs, PairChoice::kAll);
  const auto error = [](const std::string& choice, double share, const Task& task) {
    return world::errorOf([&] { withPairs(choice, {share, 1}, task); });
  };
  EXPECT_TRUE(mentions(error("held_out", 0, medium), "'held_out' needs held-out pairs"));
  EXPECT_TRUE(mentions(error("trained", 0, medium), "'trained' needs held-out pairs"));
  EXPECT_TRUE(mentions(error("trained", 0.95, medium), "task 'medium': held_out_pairs: '0.95' is out of range"));
  EXPECT_TRUE(mentions(error("trained", 0.5, loadTask("simple")), "task 'simple' requests one instance"));
  EXPECT_TRUE(mentions(error("some", 0.5, medium), "'some'"));
}

}  // namespace
}  // namespace early_fusion::sim
