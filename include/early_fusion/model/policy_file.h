#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "early_fusion/model/trainable_policy.h"
#include "early_fusion/nn/weights_file.h"

namespace early_fusion::model {

/// Reads a policy from the contents of a weights file (see nn/weights_file.h). Other contents, as in a checkpoint, are
/// ignored. @param source names the file in errors. @param precision overrides the option if it is not empty.
/// @throws Error naming source and the tensor or metadata key that is missing or not allowed; if the format is older,
/// if the actions are not this program's, or if the field of view is missing.
std::unique_ptr<TrainablePolicy> loadPolicy(const nn::WeightsFile& file, const std::string& source,
                                            const std::string& precision = "");

/// The policy's parameters with the metadata that loadPolicy() needs: format, kind, the kind's options, vocabulary,
/// actions and field of view. `extra` is merged in.
nn::WeightsFile savePolicy(const TrainablePolicy& policy,
                           const std::vector<std::pair<std::string, std::string>>& extra);

}  // namespace early_fusion::model
