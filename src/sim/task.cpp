#include "early_fusion/sim/task.h"

#include <filesystem>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/file.h"

namespace early_fusion::sim {

core::OptionSet Task::options() {
  core::OptionSet set("task");
  set.add("name", name, "name in logs and metadata; if absent, the file's name");
  set.add("instances", instances, 1, kMaxInstances, "",
          "number of objects on the counter; items are drawn with repetition");
  set.add("requested", requested, 1, kMaxInstances, "", "number of requested instances");
  set.add("steps", steps, 1, 100000, "", "number of actions in an episode");
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

Task parseTask(const std::string& text) {
  Task task;
  if (!text.empty() && text.front() == '{') {
    task.options().setFromYamlText(text, "task");
    task.validate("task");
    return task;
  }
  if (text.find_first_of("./") != std::string::npos) {
    throw core::Error("task: '" + core::excerpt(text) +
                      "' names a file; messages name a task (simple, medium, hard) or its options, such as "
                      "{instances: 6, requested: 2}");
  }
  return loadTask(text);
}

std::string taskText(Task task) { return task.options().toYamlLine(); }

Task withUpTo(std::int64_t most, Task task) {
  if (most > kMaxInstances) {
    throw core::Error("max_instances is " + std::to_string(most) + "; it must be at most " +
                      std::to_string(kMaxInstances));
  }
  if (most > task.maxInstances()) task.max_instances = static_cast<int>(most);
  return task;
}

Task withRandomisation(const std::string& name_or_file, Task task) {
  task.randomisation = loadRandomisation(name_or_file);
  return task;
}

Task withPairs(const std::string& choice, PairSplit split, Task task) {
  split.options().validate("task '" + task.name + "'");
  task.pairs = pairChoiceFromName(choice);
  task.pair_split = split;
  if (task.pairs == PairChoice::kAll) return task;
  if (split.held_out_pairs == 0) {
    throw core::Error("pairs: '" + choice +
                      "' needs held-out pairs, but held_out_pairs is 0; set it above 0, or choose all");
  }
  if (task.requested < 2) {
    throw core::Error("held_out_pairs: task '" + task.name +
                      "' requests one instance, so it has no pairs; choose a task that requests more");
  }
  return task;
}

}  // namespace early_fusion::sim
