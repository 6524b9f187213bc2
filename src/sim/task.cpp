#include "early_fusion/sim/task.h"

#include <filesystem>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"

namespace early_fusion::sim {

core::OptionSet Task::options() {
  core::OptionSet set("task");
  set.add("name", name, "what the task is called in logs and metadata; the file's name when left out");
  set.add("instances", instances, 1, kMaxInstances, "", "objects on the counter, types drawn with repetition");
  set.add("requested", requested, 1, kMaxInstances, "", "how many of the instances are requested");
  set.add("steps", steps, 1, 100000, "", "actions in an episode");
  return set;
}

void Task::validate(const std::string& source) const {
  if (requested <= instances) return;
  throw core::Error(source + ": requested is " + std::to_string(requested) + "; it must be at most instances, " +
                    std::to_string(instances));
}

Task loadTask(const std::string& name_or_file) {
  const std::string file = core::findConfig("tasks", name_or_file);
  Task task;
  task.name = std::filesystem::path(file).stem().string();
  task.options().setFromYamlFile(file);
  task.validate(file);
  return task;
}

Task withUpTo(std::int64_t most, Task task) {
  if (most > kMaxInstances) {
    throw core::Error("max_instances is " + std::to_string(most) + "; there may be " + std::to_string(kMaxInstances) +
                      " at most");
  }
  if (most > task.maxInstances()) task.max_instances = static_cast<int>(most);
  return task;
}

}  // namespace early_fusion::sim
