// A weights file: that it is read, written again as it was, and loaded as a policy.
#include "early_fusion/model/policy_file.h"
#include "early_fusion/nn/weights_file.h"
#include "fuzz_target.h"

using namespace early_fusion;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::allowError([&] {
    const nn::WeightsFile file = nn::WeightsFile::parse({reinterpret_cast<const char*>(data), size}, "input");
    const nn::WeightsFile again = nn::WeightsFile::parse(file.serialize(), "output");
    fuzz::require(again.has_digest && again.metadata.size() == file.metadata.size(), "the metadata changed");
    fuzz::require(again.tensors.size() == file.tensors.size(), "a tensor was lost");
    for (const auto& [name, tensor] : file.tensors) {
      const auto found = again.tensors.find(name);
      if (found == again.tensors.end()) continue;  // the name was not UTF-8
      fuzz::require(found->second.bytes == tensor.bytes, "a tensor's bytes changed");
    }
    model::loadPolicy(file, "input");
  });
  return 0;
}
