// A weights message: mode, seed, precision and the weights file, and the policy node's decisions with what was loaded.
#include <cmath>

#include "early_fusion/ros/policy/acting_policy.h"
#include "fuzz_target.h"
#include "safetensors_input.h"

using namespace early_fusion;

namespace {

void decide(nodes::ActingPolicy& policy, std::uint32_t step) {
  const core::Image frame(policy.imageSize(), policy.imageSize());
  const std::vector<std::string>& items = policy.policy().vocabulary().names();
  const nodes::Decision decision = policy.decide(frame, {items.front(), items.back()}, 1, step);
  fuzz::require(decision.probabilities.size() == core::kActionCount, "the number of probabilities");
  fuzz::require(decision.frames == static_cast<int>(step) + 1, "the number of frames");
  policy.likeliestItem(decision.action);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Reader input(data, size);
  const nodes::Acting acting{input.text(), input.number<std::uint64_t>(), input.text()};
  nodes::ActingPolicy policy;
  fuzz::allowError([&] {
    policy.load(nn::WeightsFile::parse(fuzz::safetensorsFile(input.rest()), "message"), "message", acting);
    if (policy.imageSize() > 64) return;  // a decision would take too long
    decide(policy, 0);
    decide(policy, 1);
  });
  return 0;
}
