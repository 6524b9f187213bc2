#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "early_fusion/model/trainable_policy.h"
#include "early_fusion/nn/weights_file.h"

namespace early_fusion::model {

/// Reads a policy from a weights file's contents (see nn/weights_file.h), which may hold more: a checkpoint does.
/// @param source names the file in errors. @param precision overrides the option when not empty.
/// @throws Error naming source and the tensor or metadata key that is missing or not allowed; when the file's actions
/// are not this program's; when it does not say the field of view.
std::unique_ptr<TrainablePolicy> loadPolicy(const nn::WeightsFile& file, const std::string& source,
                                            const std::string& precision = "");

/// The policy's parameters with the metadata that loadPolicy() needs: format, kind, the kind's options, vocabulary,
/// actions and field of view. `extra` is merged in.
nn::WeightsFile savePolicy(const TrainablePolicy& policy,
                           const std::vector<std::pair<std::string, std::string>>& extra);

}  // namespace early_fusion::model
