#include <iostream>
#include <memory>

#include "command.h"
#include "early_fusion/core/stop_signals.h"
#include "early_fusion/learning/simulated_correction.h"

namespace early_fusion::cli {

namespace {

void correct(const core::GivenOptions& given) {
  learning::SimulatedCorrectionOptions options;
  options.correction = learning::correctionPreset(given);
  core::OptionSet set = options.options();
  for (const auto& [name, value] : given) set.set(name, value, "command line");
  const core::StopSignals signals;
  try {
    learning::simulateCorrections(
        options, [](const std::string& line) { std::cerr << line << std::endl; }, [&] { signals.check(); });
  } catch (const core::Stopped& stopped) {
    throw core::Stopped(stopped.signal(),
                        "the weights after the last whole episode are in " + options.correction.output);
  }
}

}  // namespace

void addCorrect(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("correct",
                         "Simulate a person who corrects a policy, which learns from it after each episode.\n"
                         "Example: early_fusion correct --from models/medium_c16.safetensors --robot-world scans.yaml "
                         "--output runs/scans");
  const auto given = std::make_shared<core::GivenOptions>();
  addOptionFlags<learning::SimulatedCorrectionOptions>(*command, *given);
  command->get_option("--from")->required();
  command->get_option("--output")->required();
  command->callback([given] { correct(*given); });
}

}  // namespace early_fusion::cli
