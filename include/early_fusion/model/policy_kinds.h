#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/core/vocabulary.h"
#include "early_fusion/model/policy_options.h"
#include "early_fusion/model/trainable_policy.h"

namespace early_fusion::model {

/// A kind of policy: a way to combine the goal with the vision.
struct PolicyKind {
  std::string name;                  ///< PolicyOptions::kind
  std::vector<std::string> options;  ///< the PolicyOptions that its network depends on, without `kind`
  std::unique_ptr<TrainablePolicy> (*make)(const PolicyOptions& options, const core::Vocabulary& vocabulary,
                                           std::uint64_t seed);
};

/// All kinds.
const std::vector<PolicyKind>& policyKinds();
std::vector<std::string> policyKindNames();

/// @throws Error for an unknown name, listing the known ones.
const PolicyKind& policyKind(const std::string& name);

/// A policy of the kind `options.kind` with initial weights drawn from `seed` (PyTorch's default initialisation).
/// @throws Error naming an option whose value is not allowed; if the vocabulary is empty.
std::unique_ptr<TrainablePolicy> makePolicy(const PolicyOptions& options, const core::Vocabulary& vocabulary,
                                            std::uint64_t seed);

}  // namespace early_fusion::model
