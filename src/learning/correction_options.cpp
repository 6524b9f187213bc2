#include "early_fusion/learning/correction_options.h"

#include "early_fusion/core/file.h"
#include "early_fusion/model/policy_options.h"

namespace early_fusion::learning {

core::OptionSet CorrectionOptions::options() {
  core::OptionSet set("corrections");
  set.add("from", from, "the weights file to start from");
  set.add("preset", preset, "default, or a YAML file; its values replace the defaults of the other options");
  set.add("world", world, "the world of the rehearsal, a YAML file; empty: config/world.yaml of the package");
  set.add("task", task, "the task of the rehearsal: simple, medium, hard, or a task's YAML file");
  set.add("seed", seed, "determines the rehearsal's episodes and every other random draw");
  set.add("output", output, "run folder for the weights and the table of the episodes");
  set.add("items", items,
          "new items, which neither the weights nor the rehearsal's world know: names, separated by commas");
  set.addChoice("precision", precision, model::precisionNames(),
                "arithmetic; auto: bf16 if the processor computes faster in it, else f32");
  set.add("rehearsal_share", rehearsal_share, 0, 0.95, "",
          "share of the frames that a round trains on which are the rehearsal's; the others are the person's");
  set.add("unpressed_weight", unpressed_weight, 0, 1, "",
          "weight of the policy's own action as the label of a step at which the person did not press; 0: no label");
  set.include(training.options());
  return set;
}

CorrectionOptions correctionPreset(const core::GivenOptions& given) {
  CorrectionOptions options;
  for (const auto& [name, value] : given) {
    if (name == "preset") options.preset = value;
  }
  options.options().setFromYamlFile(core::findConfig("corrections", options.preset));
  return options;
}

}  // namespace early_fusion::learning
