// A task's YAML file, and a task as a message names it.
#include "early_fusion/sim/task.h"
#include "fuzz_target.h"

using namespace early_fusion;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto check = [](const sim::Task& task) {
    fuzz::require(task.requested >= 1 && task.requested <= task.instances, "the number of requested objects");
    fuzz::require(task.instances <= sim::kMaxInstances && task.steps >= 1, "the number of objects or steps");
  };
  fuzz::allowError([&] { check(sim::loadTask(folder.write("task.yaml", text))); });
  fuzz::allowError([&] { check(sim::parseTask(text)); });
  return 0;
}
