#include "early_fusion/model/warm_start.h"

#include <algorithm>

#include "early_fusion/core/error.h"
#include "early_fusion/model/policy_kinds.h"

namespace early_fusion::model {

namespace {

// These do not change the network's tensors, or may change with the room.
bool mayDiffer(const std::string& option) { return option == "dropout" || option == "precision"; }

void checkSameNetwork(PolicyOptions trained, const std::string& source, PolicyOptions wanted) {
  const core::OptionSet before = trained.options(), now = wanted.options();
  std::vector<std::string> compared = policyKind(wanted.kind).options;
  compared.insert(compared.begin(), "kind");
  for (std::size_t i = 0; i < before.options().size(); ++i) {
    const core::Option &old_option = before.options()[i], &new_option = now.options()[i];
    if (mayDiffer(new_option.name) || old_option.get() == new_option.get()) continue;
    if (std::find(compared.begin(), compared.end(), new_option.name) == compared.end()) continue;
    throw core::Error(source + ": its " + new_option.name + " is " + old_option.get() + ", not " + new_option.get() +
                      "; a policy can only start from weights of the same network, so set " + new_option.name + " to " +
                      old_option.get());
  }
}

/// Copies the columns of embedding.weight (channels, items) by the items' names.
void copyEmbedding(const TrainablePolicy& trained, const nn::TensorSlice& from, const nn::TensorSlice& to,
                   TrainablePolicy& policy) {
  const std::vector<std::string>&known = trained.vocabulary().names(), &wanted = policy.vocabulary().names();
  for (std::size_t item = 0; item < wanted.size(); ++item) {
    const auto found = std::find(known.begin(), known.end(), wanted[item]);
    if (found == known.end()) continue;
    for (int channel = 0; channel < policy.options().channels; ++channel) {
      policy.parameters().values()[to.offset + channel * wanted.size() + item] =
          trained.parameters().values()[from.offset + channel * known.size() + (found - known.begin())];
    }
  }
}

}  // namespace

void warmStart(const TrainablePolicy& trained, const std::string& source, TrainablePolicy& policy) {
  checkSameNetwork(trained.options(), source, policy.options());
  const std::vector<nn::TensorSlice>& from = trained.parameters().parameterSlices();
  const std::vector<nn::TensorSlice>& to = policy.parameters().parameterSlices();
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (to[i].name == "embedding.weight") {
      copyEmbedding(trained, from[i], to[i], policy);
    } else {
      policy.parameters().values().segment(to[i].offset, to[i].size) =
          trained.parameters().values().segment(from[i].offset, from[i].size);
    }
  }
  policy.parameters().buffers() = trained.parameters().buffers();
  policy.parametersChanged();
}

}  // namespace early_fusion::model
