#include "early_fusion/model/warm_start.h"

#include "error_of.h"
#include "small_networks.h"

namespace early_fusion::model {
namespace {

std::unique_ptr<TrainablePolicy> policyOf(const PolicyOptions& options, const std::vector<std::string>& items,
                                          std::uint64_t seed) {
  return makePolicy(options, core::Vocabulary(items), seed);
}

Eigen::VectorXf tensor(const TrainablePolicy& policy, const std::string& name) {
  for (const nn::TensorSlice& slice : policy.parameters().parameterSlices()) {
    if (slice.name == name) return policy.parameters().values().segment(slice.offset, slice.size);
  }
  ADD_FAILURE() << "no tensor " << name;
  return {};
}

/// The embedding of an item, which is a column of embedding.weight.
Eigen::VectorXf embeddingOf(const TrainablePolicy& policy, const std::string& item) {
  const int items = policy.vocabulary().size();
  const Eigen::VectorXf all = tensor(policy, "embedding.weight");
  const Eigen::Map<const nn::Matrix> weight(all.data(), all.size() / items, items);
  return weight.col(policy.vocabulary().index(item));
}

TEST(WarmStart, KnownItemsKeepTheirEmbeddingAndNewOnesTheirInitialOne) {
  const auto trained = policyOf(smallOptions(), {"mug", "bowl", "plate"}, 1);
  const auto initial = policyOf(smallOptions(), {"plate", "fork", "mug", "knife"}, 2);
  const auto policy = policyOf(smallOptions(), {"plate", "fork", "mug", "knife"}, 2);
  warmStart(*trained, "trained", *policy);
  for (const char* item : {"plate", "mug"}) EXPECT_EQ(embeddingOf(*policy, item), embeddingOf(*trained, item)) << item;
  for (const char* item : {"fork", "knife"}) EXPECT_EQ(embeddingOf(*policy, item), embeddingOf(*initial, item)) << item;
}

TEST(WarmStart, WithTheSameItemsInAnotherOrderAPolicyActsAsTheTrainedOne) {
  for (const PolicyOptions& options : everySmallNetwork()) {
    if (options.precision != "f32") continue;
    SCOPED_TRACE(options.kind);
    const TestBatch batch(6, kSmallImage, kSmallItems, 3);
    const auto trained = makeSmall(options, 1);
    train(*trained, batch, 3);  // changes the running statistics, too
    std::vector<std::string> reversed = trained->vocabulary().names();
    std::reverse(reversed.begin(), reversed.end());
    const auto policy = policyOf(options, reversed, 2);
    warmStart(*trained, "trained", *policy);
    const core::Request one = {1}, the_same = {kSmallItems - 2};
    Observation observation = batch.samples.front().observation;
    observation.request = &one;
    Probabilities expected, probabilities;
    trained->predict({observation}, expected);
    observation.request = &the_same;
    policy->predict({observation}, probabilities);
    EXPECT_EQ(probabilities, expected);
  }
}

TEST(WarmStart, RefusesAnotherNetworkByTheOption) {
  const auto trained = makeSmall(smallOptions());
  const auto errorFor = [&](auto change) {
    PolicyOptions options = smallOptions();
    change(options);
    const auto policy = makeSmall(options);
    return errorOf([&] { warmStart(*trained, "old.safetensors", *policy); });
  };
  EXPECT_EQ(errorFor([](PolicyOptions& options) { options.channels = 32; }),
            "old.safetensors: its channels is 16, not 32; a policy can only start from weights of the same network, so "
            "set channels to 16");
  EXPECT_NE(errorFor([](PolicyOptions& options) { options.kind = "late_fusion"; }).find("its kind is early_fusion"),
            std::string::npos);
  EXPECT_NE(errorFor([](PolicyOptions& options) { options.fusion_block = 2; }).find("its fusion_block is 1"),
            std::string::npos);
  EXPECT_NE(errorFor([](PolicyOptions& options) {
              options.spatial_grid = "true";
            }).find("its spatial_grid is false, not true"),
            std::string::npos);
  EXPECT_NE(errorFor([](PolicyOptions& options) { options.image_size = 64; }).find("its image_size is 32"),
            std::string::npos);
}

}  // namespace
}  // namespace early_fusion::model
