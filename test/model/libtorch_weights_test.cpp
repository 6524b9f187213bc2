// A policy from a network that was trained in PyTorch: its state_dict, in a safetensors file with our metadata.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "early_fusion/model/policy_file.h"
#include "error_of.h"
#include "parity_case.h"
#include "torch_network.h"

namespace early_fusion::model {
namespace {

/// The metadata that docs/export.md lists.
nlohmann::json metadataOf(const ParityCase& network) {
  nlohmann::json metadata = {
      {"format", "early_fusion/3"},
      {"kind", network.kind},
      {"channels", std::to_string(network.channels)},
      {"spatial_grid", network.spatial_grid},
      {"dropout", "0"},
      {"image_size", std::to_string(network.image_size)},
      {"horizontal_fov_deg", "60"},
      {"vocabulary", R"(["item_0", "item_1", "item_2", "item_3", "item_4"])"},
      {"actions", R"(["PAN_LEFT", "PAN_RIGHT", "TILT_UP", "TILT_DOWN", "COLLECT", "REMOVE", "IDLE"])"}};
  if (network.kind == std::string("early_fusion")) metadata["fusion_block"] = std::to_string(network.fusion_block);
  return metadata;
}

/// The bytes that save_file() of the Python package safetensors writes for a state_dict: without a digest, and with the
/// counts of batches of PyTorch's batch norms.
std::string savedStateDict(const torch::nn::Module& network, const nlohmann::json& metadata) {
  nlohmann::json header = {{"__metadata__", metadata}};
  std::string data;
  const auto add = [&](const std::string& name, const torch::Tensor& tensor) {
    const torch::Tensor values = tensor.contiguous();
    const std::size_t begin = data.size();
    data.append(static_cast<const char*>(values.data_ptr()), values.nbytes());
    header[name] = {{"dtype", values.dtype() == torch::kLong ? "I64" : "F32"},
                    {"shape", values.sizes().vec()},
                    {"data_offsets", {begin, data.size()}}};
  };
  for (const auto& buffer : network.named_buffers()) add(buffer.key(), buffer.value());
  for (const auto& parameter : network.named_parameters()) add(parameter.key(), parameter.value());
  const std::string text = header.dump();
  std::string length;
  for (int i = 0; i < 8; ++i) length += static_cast<char>(text.size() >> (8 * i) & 0xff);
  return length + text + data;
}

class LibtorchWeights : public testing::TestWithParam<ParityCase> {
 protected:
  LibtorchWeights() : options(parityOptions(GetParam())) {
    torch::manual_seed(11);
    network = std::make_shared<TorchNetwork>(options, kParityItems);
    torch::NoGradGuard guard;
    const TestBatch batch(8, options.image_size, kParityItems, 6);
    const TorchBatch inputs(batch.samples, options.image_size, kParityItems);
    for (int step = 0; step < 5; ++step) network->forward(inputs.images, inputs.counts);  // moves the statistics
    network->eval();
  }

  PolicyOptions options;
  std::shared_ptr<TorchNetwork> network;
};

TEST_P(LibtorchWeights, LoadAsAPolicyWithTheSameProbabilities) {
  const std::string bytes = savedStateDict(*network, metadataOf(GetParam()));
  const nn::WeightsFile file = nn::WeightsFile::parse(bytes, "torch.safetensors");
  ASSERT_EQ(file.tensors.count("block1.norm.num_batches_tracked"), 1u);
  const auto policy = loadPolicy(file, "torch.safetensors", "f32");
  EXPECT_EQ(policy->vocabulary(), testVocabulary(kParityItems));
  const TestBatch batch(5, options.image_size, kParityItems, 2);
  Probabilities probabilities;
  policy->predict(batch.observations(), probabilities);
  const TorchBatch inputs(batch.samples, options.image_size, kParityItems);
  torch::NoGradGuard guard;
  const torch::Tensor expected = torch::softmax(network->forward(inputs.images, inputs.counts), 1);
  for (int i = 0; i < 5; ++i) {
    for (int k = 0; k < core::kActionCount; ++k) {
      EXPECT_NEAR(probabilities(i, k), expected[i][k].item<float>(), 1e-5) << "row " << i << ", action " << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Networks, LibtorchWeights, testing::ValuesIn(kParityCases), parityName);

TEST(LibtorchWeightsErrors, NameTheMetadataThatIsMissingAndACopiedDigest) {
  const ParityCase& early = kParityCases[1];
  TorchNetwork network(parityOptions(early), kParityItems);
  const auto error = [&](const nlohmann::json& metadata) {
    return errorOf([&] {
      loadPolicy(nn::WeightsFile::parse(savedStateDict(network, metadata), "torch.safetensors"), "torch.safetensors");
    });
  };
  const nlohmann::json complete = metadataOf(early);
  EXPECT_EQ(error(complete), "no error");
  for (const auto& [key, value] : complete.items()) {
    nlohmann::json metadata = complete;
    metadata.erase(key);
    EXPECT_EQ(error(metadata).rfind("torch.safetensors: metadata '" + key + "' is missing", 0), 0u) << error(metadata);
  }
  nlohmann::json copied = complete;
  copied["digest"] = "xxh3-128:00112233445566778899aabbccddeeff";
  EXPECT_NE(error(copied).find("let that program drop the metadata key 'digest'"), std::string::npos) << error(copied);
}

}  // namespace
}  // namespace early_fusion::model
