#include "command.h"

#include <unistd.h>

namespace early_fusion::cli {

void addCommands(CLI::App& app) {
  addTrain(app);
  addEvaluate(app);
  addExperiment(app);
  addCorrect(app);
  addDifficulty(app);
  addRender(app);
  addRetention(app);
  addInspect(app);
  addExport(app);
  addUrdf(app);
}

void addOptionFlags(CLI::App& command, const std::shared_ptr<core::OptionSet>& set, core::GivenOptions& given) {
  for (const core::Option& option : set->options()) {
    const std::string unit = option.unit.empty() ? "" : " " + option.unit;
    const std::string group = "Options of the " + set->title();
    const auto give = [set, &given, name = option.name](const std::string& value) {
      set->set(name, value, "command line");
      given.emplace_back(name, value);
    };
    if (option.isSwitch()) {
      command
          .add_flag_function(
              option.flag(), [give](std::int64_t count) { give(count > 0 ? "true" : "false"); },
              option.help + " [" + option.initial + "]")
          ->group(group);
      continue;
    }
    command.add_option_function<std::string>(option.flag(), give, option.help + ". " + option.range + unit)
        ->type_name("")
        ->default_str(option.initial)
        ->group(group);
  }
}

bool onTerminal() { return ::isatty(STDERR_FILENO) != 0; }

}  // namespace early_fusion::cli
