#include "early_fusion/sim/task.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"

namespace early_fusion::sim {

namespace fs = std::filesystem;

namespace {

std::string fileOf(const std::string& name_or_file) {
  const fs::path path(name_or_file);
  if (path.extension() == ".yaml" || path.extension() == ".yml" || path.has_parent_path()) return name_or_file;
  const fs::path folder = fs::path(core::shareFolder()) / "config" / "tasks";
  const fs::path file = folder / (name_or_file + ".yaml");
  if (!name_or_file.empty() && fs::exists(file)) return file.string();
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  std::string known;
  for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
  throw core::Error("unknown task '" + name_or_file + "'; known are " + known + " (" + folder.string() +
                    "), or give a .yaml file");
}

}  // namespace

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
  const std::string file = fileOf(name_or_file);
  Task task;
  task.name = fs::path(file).stem().string();
  task.options().setFromYamlFile(file);
  task.validate(file);
  return task;
}

}  // namespace early_fusion::sim
