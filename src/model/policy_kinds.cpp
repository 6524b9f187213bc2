#include "early_fusion/model/policy_kinds.h"

#include "early_fusion/core/error.h"
#include "early_fusion/core/names.h"
#include "early_fusion/model/attention_map.h"
#include "early_fusion/model/early_fusion.h"
#include "early_fusion/model/late_fusion.h"

namespace early_fusion::model {

namespace {

template <class Policy>
std::unique_ptr<TrainablePolicy> make(const PolicyOptions& options, const core::Vocabulary& vocabulary,
                                      std::uint64_t seed) {
  return std::make_unique<Policy>(options, vocabulary, seed);
}

}  // namespace

const std::vector<PolicyKind>& policyKinds() {
  static const std::vector<PolicyKind> kinds = {
      {"early_fusion", {"channels", "fusion_block", "spatial_grid", "dropout", "image_size"}, make<EarlyFusion>},
      {"late_fusion", {"channels", "spatial_grid", "dropout", "image_size"}, make<LateFusion>},
      {"attention_map", {"channels", "spatial_grid", "dropout", "image_size"}, make<AttentionMap>},
      {"softmax_attention_map", {"channels", "spatial_grid", "dropout", "image_size"}, make<SoftmaxAttentionMap>},
  };
  return kinds;
}

std::vector<std::string> policyKindNames() {
  std::vector<std::string> names;
  for (const PolicyKind& kind : policyKinds()) names.push_back(kind.name);
  return names;
}

const PolicyKind& policyKind(const std::string& name) {
  return policyKinds()[core::indexOf(name, policyKindNames(), "kind of policy")];
}

std::unique_ptr<TrainablePolicy> makePolicy(const PolicyOptions& options, const core::Vocabulary& vocabulary,
                                            std::uint64_t seed) {
  PolicyOptions checked = options;
  checked.options().validate("policy");
  if (vocabulary.size() == 0) throw core::Error("policy: the vocabulary is empty; it must have at least one item");
  return policyKind(options.kind).make(options, vocabulary, seed);
}

}  // namespace early_fusion::model
