#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/core/vocabulary.h"
#include "early_fusion/model/policy_options.h"
#include "early_fusion/model/trainable_policy.h"

namespace early_fusion::model {

/// A way in which goal and vision meet.
struct PolicyKind {
  std::string name;                  ///< PolicyOptions::kind
  std::vector<std::string> options;  ///< names of the others of PolicyOptions that its network depends on
  std::unique_ptr<TrainablePolicy> (*make)(const PolicyOptions& options, const core::Vocabulary& vocabulary,
                                           std::uint64_t seed);
};

/// All there are.
const std::vector<PolicyKind>& policyKinds();
std::vector<std::string> policyKindNames();

/// @throws Error when there is none of this name, listing those there are.
const PolicyKind& policyKind(const std::string& name);

/// A policy of the kind that the options name, with fresh weights drawn from `seed` (PyTorch's default initialisation).
/// @throws Error naming an option whose value is not allowed, or when the vocabulary is empty.
std::unique_ptr<TrainablePolicy> makePolicy(const PolicyOptions& options, const core::Vocabulary& vocabulary,
                                            std::uint64_t seed);

}  // namespace early_fusion::model
