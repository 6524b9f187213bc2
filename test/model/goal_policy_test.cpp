#include "early_fusion/model/goal_policy.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "early_fusion/core/error.h"
#include "early_fusion/nn/adam.h"
#include "early_fusion/nn/convolution.h"
#include "policy_batches.h"

namespace early_fusion::model {
namespace {

constexpr int kItems = 6;

PolicyOptions smallOptions(const std::string& precision = "f32") {
  PolicyOptions options;
  options.image_size = 32;
  options.precision = precision;
  return options;
}

std::unique_ptr<GoalPolicy> makeSmall(const PolicyOptions& options, std::uint64_t seed = 1) {
  return makePolicy(options, testVocabulary(kItems), seed);
}

void train(GoalPolicy& policy, const TestBatch& batch, int steps, double rate = 1e-3) {
  nn::Adam adam(policy.parameters().values().size(), {});
  for (int step = 0; step < steps; ++step) {
    policy.lossAndGradients(batch.samples, step);
    adam.step(policy.parameters().values(), policy.parameters().gradients(), rate);
    policy.parametersChanged();
  }
}

std::string errorOf(const std::function<void()>& work) {
  try {
    work();
  } catch (const core::Error& error) {
    return error.what();
  }
  return "no error";
}

void expectError(const std::function<void()>& work, const std::string& part) {
  const std::string error = errorOf(work);
  EXPECT_NE(error.find(part), std::string::npos) << error;
}

class EveryPrecision : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (GetParam() == "bf16" && !nn::processorHasBfloat16()) GTEST_SKIP() << "no native bfloat16 here";
  }
};

TEST_P(EveryPrecision, ARowDependsNeitherOnTheOthersNorOnTheirNumber) {
  for (int fusion_block : {0, 1, 3}) {
    PolicyOptions options = smallOptions(GetParam());
    options.fusion_block = fusion_block;
    const auto policy = makeSmall(options);
    const TestBatch batch(7, 32, kItems, 3);
    train(*policy, batch, 3);
    const std::vector<Observation> observations = batch.observations();
    Probabilities all, some, one;
    policy->predict(observations, all);
    policy->predict({observations[4], observations[2]}, some);
    EXPECT_EQ(some.row(0), all.row(4));
    EXPECT_EQ(some.row(1), all.row(2));
    for (int i = 0; i < 7; ++i) {
      policy->predict({observations[i]}, one);
      EXPECT_EQ(one.row(0), all.row(i)) << "observation " << i;
      EXPECT_NEAR(one.sum(), 1, 1e-5);
    }
    EXPECT_NE(all.row(0), all.row(1));
  }
}

TEST_P(EveryPrecision, LearnsTheSameBitsTwiceAndOnAnyNumberOfThreads) {
  const TestBatch batch(37, 32, kItems, 3);
  const int threads = omp_get_max_threads();
  for (const int channels : {16, 96}) {
    PolicyOptions options = smallOptions(GetParam());
    options.channels = channels;
    std::vector<Eigen::VectorXf> values, buffers;
    for (int count : {2, 2, 1, 3}) {
      omp_set_num_threads(count);
      const auto policy = makeSmall(options);
      train(*policy, batch, 3);
      values.push_back(policy->parameters().values());
      buffers.push_back(policy->parameters().buffers());
    }
    for (std::size_t i = 1; i < values.size(); ++i) {
      EXPECT_EQ(values[i], values[0]) << channels << " channels";
      EXPECT_EQ(buffers[i], buffers[0]) << channels << " channels";
    }
  }
  omp_set_num_threads(threads);
}

TEST_P(EveryPrecision, LearnsABatchByHeart) {
  PolicyOptions options = smallOptions(GetParam());
  options.dropout = 0;
  const auto policy = makeSmall(options);
  TestBatch batch(12, 32, kItems, 3);
  for (std::size_t i = 0; i < batch.samples.size(); ++i) {
    batch.samples[i].target.fill(0);
    batch.samples[i].target[i % core::kActionCount] = 1;
    batch.samples[i].unlikelihood.fill(0);
  }
  train(*policy, batch, 150, 3e-3);
  EXPECT_LT(policy->lossAndGradients(batch.samples, 0), 0.1);
}

TEST_P(EveryPrecision, TakesBatchesOfAnySizeInAnyOrder) {
  PolicyOptions options = smallOptions(GetParam());
  const auto fresh = makeSmall(options), used = makeSmall(options);
  const TestBatch large(9, 32, kItems, 3), small(2, 32, kItems, 4), one(1, 32, kItems, 5);
  for (const TestBatch* batch : {&large, &one, &small}) {
    EXPECT_TRUE(std::isfinite(used->lossAndGradients(batch->samples, 1)));
    EXPECT_TRUE(used->parameters().gradients().allFinite());
  }
  fresh->lossAndGradients(small.samples, 1);
  EXPECT_EQ(fresh->parameters().gradients(), used->parameters().gradients()) << "a step must not remember the last one";
}

TEST_P(EveryPrecision, SavesAndLoadsTheSamePolicy) {
  PolicyOptions options = smallOptions(GetParam());
  options.fusion_block = 2;
  options.dropout = 0.25;
  const auto policy = makeSmall(options, 5);
  const TestBatch batch(4, 32, kItems, 3);
  train(*policy, batch, 2);
  nn::WeightsFile file = savePolicy(*policy, {{"preset", "fast"}});
  EXPECT_EQ(file.metadata.at("preset"), "fast");
  file.tensors["adam.first_moment"] = {"U8", {1}, "x"};  // a checkpoint holds more than the policy
  const auto loaded = loadPolicy(nn::WeightsFile::parse(file.serialize(), "memory"), "memory", GetParam());
  EXPECT_EQ(loaded->options().fusion_block, 2);
  EXPECT_EQ(loaded->options().dropout, 0.25);
  EXPECT_EQ(loaded->options().image_size, 32);
  EXPECT_EQ(loaded->vocabulary(), policy->vocabulary());
  Probabilities before, after;
  policy->predict(batch.observations(), before);
  loaded->predict(batch.observations(), after);
  EXPECT_EQ(before, after);
  EXPECT_EQ(policy->lossAndGradients(batch.samples, 9), loaded->lossAndGradients(batch.samples, 9));
}

INSTANTIATE_TEST_SUITE_P(GoalPolicy, EveryPrecision, testing::Values("f32", "bf16"));

TEST(GoalPolicy, InBfloat16PredictsAndLearnsAlmostTheSame) {
  if (!nn::processorHasBfloat16()) GTEST_SKIP() << "no native bfloat16 here";
  PolicyOptions options = smallOptions();
  options.dropout = 0;
  const auto full = makeSmall(options);
  TestBatch batch(32, 32, kItems, 3);
  for (Sample& sample : batch.samples) sample.unlikelihood.fill(0);
  train(*full, batch, 20);
  const auto half = loadPolicy(savePolicy(*full, {}), "memory", "bf16");
  Probabilities expected, found;
  full->predict(batch.observations(), expected);
  half->predict(batch.observations(), found);
  EXPECT_LT((expected - found).cwiseAbs().maxCoeff(), 0.05f);
  EXPECT_NEAR(full->lossAndGradients(batch.samples, 0), half->lossAndGradients(batch.samples, 0), 0.02);
  const Eigen::VectorXf& a = full->parameters().gradients();
  const Eigen::VectorXf& b = half->parameters().gradients();
  EXPECT_GT(a.dot(b), 0.97f * a.norm() * b.norm());
  EXPECT_NEAR(b.norm() / a.norm(), 1, 0.1);
}

TEST(GoalPolicy, GradientsAreTheSlopeOfTheLoss) {
  PolicyOptions options = smallOptions();
  options.dropout = 0.3;
  const auto policy = makeSmall(options);
  const TestBatch batch(6, 32, kItems, 3);
  policy->lossAndGradients(batch.samples, 4);
  const Eigen::VectorXf values = policy->parameters().values(), gradients = policy->parameters().gradients();
  const auto lossAt = [&](const Eigen::VectorXf& changed) {
    policy->parameters().values() = changed;
    policy->parametersChanged();
    return policy->lossAndGradients(batch.samples, 4);
  };
  // Of each tensor by itself: a gradient that is lost leaves the slope along the others' what it was.
  for (const nn::TensorSlice& slice : policy->parameters().parameterSlices()) {
    Eigen::VectorXf direction = Eigen::VectorXf::Zero(values.size());
    direction.segment(slice.offset, slice.size) = gradients.segment(slice.offset, slice.size);
    const float norm = direction.norm();
    ASSERT_GT(norm, 1e-4f) << slice.name;
    direction /= norm;
    const float step = 2e-4f / norm;
    const double slope = (lossAt(values + step * direction) - lossAt(values - step * direction)) / (2 * step);
    EXPECT_NEAR(slope / norm, 1, 0.02) << slice.name;
  }
}

/// Every view of the batch with three requests of the batch, side by side.
std::vector<Sample> withThreeRequests(const TestBatch& batch) {
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < batch.samples.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      Sample sample = batch.samples[(i + 2 * k) % batch.samples.size()];
      sample.observation.frames = batch.samples[i].observation.frames;
      samples.push_back(sample);
    }
  }
  return samples;
}

TEST_P(EveryPrecision, SharingAViewBetweenRequestsChangesNothing) {
  const TestBatch batch(5, 32, kItems, 3), copy(5, 32, kItems, 3);
  const std::vector<Sample> together = withThreeRequests(batch);
  // The same numbers, but no two neighbours with the same memory: every other sample looks at the copy.
  std::vector<Sample> apart = together;
  const std::vector<Sample> copies = withThreeRequests(copy);
  for (std::size_t i = 1; i < apart.size(); i += 2) apart[i].observation = copies[i].observation;
  for (int fusion_block : {0, 1, 3}) {
    PolicyOptions options = smallOptions(GetParam());
    options.fusion_block = fusion_block;
    const auto shared = makeSmall(options), separate = makeSmall(options);
    const bool half = GetParam() == "bf16";
    EXPECT_NEAR(shared->lossAndGradients(together, 5), separate->lossAndGradients(apart, 5), half ? 5e-3 : 1e-5);
    const Eigen::VectorXf& a = shared->parameters().gradients();
    const Eigen::VectorXf& b = separate->parameters().gradients();
    EXPECT_LT((a - b).norm(), (half ? 0.05f : 1e-4f) * b.norm()) << "fusion block " << fusion_block;
    // The unbiased variance divides by the number of values, and fewer have been seen.
    EXPECT_LT((shared->parameters().buffers() - separate->parameters().buffers()).cwiseAbs().maxCoeff(), 1e-3f);
  }
}

TEST(GoalPolicy, DropoutIsDecidedByItsSeedAndOnlyInTraining) {
  const auto policy = makeSmall(smallOptions());
  const TestBatch batch(8, 32, kItems, 3);
  const double first = policy->lossAndGradients(batch.samples, 1);
  EXPECT_NE(policy->lossAndGradients(batch.samples, 2), first);
  EXPECT_EQ(policy->lossAndGradients(batch.samples, 1), first);
  Probabilities once, twice;
  policy->predict(batch.observations(), once);
  policy->predict(batch.observations(), twice);
  EXPECT_EQ(once, twice);
}

TEST(GoalPolicy, PredictsWithTheStatisticsOfTheLastTraining) {
  const auto policy = makeSmall(smallOptions());
  const TestBatch batch(8, 32, kItems, 3);
  Probabilities before, after;
  policy->predict(batch.observations(), before);
  policy->lossAndGradients(batch.samples, 1);  // moves the running statistics, and nothing else
  policy->predict(batch.observations(), after);
  EXPECT_NE(before, after);
}

TEST_P(EveryPrecision, WithRunningStatisticsTheLossIsThatOfWhatItPredicts) {
  PolicyOptions options = smallOptions(GetParam());
  options.dropout = 0;
  const auto policy = makeSmall(options);
  const TestBatch batch(8, 32, kItems, 3);
  const double with_batch_statistics = policy->lossAndGradients(batch.samples, 0);
  policy->setNormalisation(nn::Normalisation::kRunning);
  const double loss = policy->lossAndGradients(batch.samples, 0);
  Probabilities probabilities;
  policy->predict(batch.observations(), probabilities);
  double expected = 0, weights = 0;
  for (std::size_t i = 0; i < batch.samples.size(); ++i) {
    const Sample& sample = batch.samples[i];
    for (int a = 0; a < core::kActionCount; ++a) {
      const float probability = probabilities(static_cast<Eigen::Index>(i), a);
      expected -= sample.weight * sample.target[a] * std::log(probability);
      expected -= sample.weight * sample.unlikelihood[a] * std::log(1 - probability);
    }
    weights += sample.weight;
  }
  EXPECT_NEAR(loss, expected / weights, GetParam() == "f32" ? 1e-5 : 5e-3);
  EXPECT_GT(std::abs(loss - with_batch_statistics), 1e-2);
}

TEST(GoalPolicy, CountsItemsAndIgnoresTheirOrder) {
  const auto policy = makeSmall(smallOptions());
  const TestBatch batch(1, 32, kItems, 3);
  Observation observation = batch.samples[0].observation;
  const core::Request once = {2, 4}, twice = {2, 2, 4}, reordered = {4, 2}, nothing = {};
  std::vector<Probabilities> rows(4);
  int row = 0;
  for (const core::Request* request : {&once, &reordered, &twice, &nothing}) {
    observation.request = request;
    policy->predict({observation}, rows[row++]);
  }
  EXPECT_EQ(rows[0], rows[1]);
  EXPECT_NE(rows[0], rows[2]);
  EXPECT_NE(rows[0], rows[3]);
}

TEST(GoalPolicy, HasPyTorchsNamesShapesAndDefaults) {
  PolicyOptions options;
  options.precision = "f32";
  const auto policy = makePolicy(options, testVocabulary(16), 1);
  const nn::Parameters& parameters = policy->parameters();
  EXPECT_EQ(parameters.values().size(), 27495);
  std::map<std::string, nn::TensorSlice> slices;
  for (const nn::TensorSlice& slice : parameters.parameterSlices()) slices.emplace(slice.name, slice);
  using Shape = std::vector<std::int64_t>;
  std::map<std::string, Shape> expected = {{"embedding.weight", {16, 16}}, {"embedding.bias", {16}},
                                           {"hidden.weight", {16, 1024}},  {"hidden.bias", {16}},
                                           {"output.weight", {7, 16}},     {"output.bias", {7}}};
  std::map<std::string, Shape> expected_buffers;
  for (int block = 1; block <= 4; ++block) {
    const std::string name = "block" + std::to_string(block);
    expected[name + ".conv.weight"] = {16, block == 1 ? 9 : block == 2 ? 32 : 16, 3, 3};
    for (const char* vector : {".conv.bias", ".norm.weight", ".norm.bias"}) expected[name + vector] = {16};
    for (const char* vector : {".norm.running_mean", ".norm.running_var"}) expected_buffers[name + vector] = {16};
  }
  const auto shapes = [](const std::vector<nn::TensorSlice>& tensors) {
    std::map<std::string, Shape> by_name;
    for (const nn::TensorSlice& slice : tensors) by_name[slice.name] = slice.shape;
    return by_name;
  };
  EXPECT_EQ(shapes(parameters.parameterSlices()), expected);
  EXPECT_EQ(shapes(parameters.bufferSlices()), expected_buffers);
  const auto largest = [&](const std::string& name) {
    const nn::TensorSlice& slice = slices.at(name);
    return parameters.values().segment(slice.offset, slice.size).cwiseAbs().maxCoeff();
  };
  EXPECT_NEAR(largest("block1.conv.weight"), 1 / std::sqrt(81.0), 2e-3);
  EXPECT_NEAR(largest("block2.conv.weight"), 1 / std::sqrt(288.0), 1e-3);
  EXPECT_NEAR(largest("hidden.weight"), 1 / std::sqrt(1024.0), 1e-3);
  EXPECT_EQ(largest("block3.norm.weight"), 1);
  EXPECT_EQ(largest("block3.norm.bias"), 0);
  const auto other = makePolicy(options, testVocabulary(16), 2);
  EXPECT_NE(parameters.values(), other->parameters().values());
}

TEST(GoalPolicy, RefusesBadOptions) {
  const auto with = [](const std::function<void(PolicyOptions&)>& change) {
    return [change] {
      PolicyOptions options = smallOptions();
      change(options);
      makeSmall(options);
    };
  };
  expectError(with([](PolicyOptions& o) { o.kind = "late"; }), "kind: 'late'");
  expectError(with([](PolicyOptions& o) { o.channels = 20; }),
              "policy: channels: '20' is not a multiple of 16; allowed: a multiple of 16 in [16, 256]");
  expectError(with([](PolicyOptions& o) { o.channels = 512; }), "channels: '512'");
  expectError(with([](PolicyOptions& o) { o.fusion_block = 4; }), "fusion_block: '4'");
  expectError(with([](PolicyOptions& o) { o.dropout = 1; }), "dropout: '1'");
  expectError(with([](PolicyOptions& o) { o.image_size = 100; }), "image_size: '100'");
  expectError(with([](PolicyOptions& o) { o.precision = "fp8"; }), "precision: 'fp8'");
  expectError([] { makePolicy(smallOptions(), core::Vocabulary(), 1); }, "vocabulary");
}

TEST(GoalPolicy, RefusesBadSamples) {
  const auto policy = makeSmall(smallOptions());
  TestBatch batch(2, 32, kItems, 3);
  const auto learn = [&] { policy->lossAndGradients(batch.samples, 0); };
  batch.requests[1] = {kItems};
  expectError(learn, "observation 1 requests item 6; the policy knows items 0 to 5");
  batch.requests[1] = {-1};
  expectError(learn, "requests item -1");
  batch.requests[1] = {};
  batch.samples[1].weight = std::numeric_limits<float>::quiet_NaN();
  expectError(learn, "sample 1 has weight nan");
  batch.samples[0].weight = batch.samples[1].weight = 0;
  expectError(learn, "weight 0");
  batch.samples[1].observation.request = nullptr;
  expectError(learn, "observation 1 has no request");
  batch.samples.clear();
  expectError(learn, "at least one sample");
}

TEST(GoalPolicy, PredictsNothingOfNoObservations) {
  Probabilities none;
  makeSmall(smallOptions())->predict({}, none);
  EXPECT_EQ(none.rows(), 0);
}

/// What loadPolicy() says of a file that was changed.
std::string loadErrorAfter(const std::function<void(nn::WeightsFile&)>& change) {
  nn::WeightsFile file = savePolicy(*makeSmall(smallOptions()), {});
  change(file);
  const std::string error = errorOf([&] { loadPolicy(file, "run/weights.safetensors"); });
  EXPECT_EQ(error.rfind("run/weights.safetensors", 0), 0u) << error;
  return error;
}

void setNumber(nn::StoredTensor& tensor, std::size_t index, float number) {
  std::memcpy(&tensor.bytes[index * sizeof number], &number, sizeof number);
}

TEST(LoadPolicy, NamesWhatIsWrongWithMetadata) {
  const std::vector<std::tuple<std::string, std::string, std::string>> cases = {
      {"format", "early_fusion/9", "metadata 'format' is 'early_fusion/9'"},
      {"kind", "resnet", "resnet"},
      {"channels", "many", "many"},
      {"channels", "24", "channels: '24'"},
      {"fusion_block", "9", "9"},
      {"image_size", "33", "image_size: '33'"},
      {"vocabulary", "mug, bowl", "metadata 'vocabulary' is not a JSON list"},
      {"vocabulary", "[\"mug\",\"mug\"]", "metadata 'vocabulary'"},
      {"vocabulary", "[]", "vocabulary"}};
  for (const auto& [key, value, part] : cases) {
    const std::string error = loadErrorAfter([&](nn::WeightsFile& file) { file.metadata[key] = value; });
    EXPECT_NE(error.find(part), std::string::npos) << error;
  }
  for (const char* key : {"format", "kind", "channels", "fusion_block", "dropout", "image_size", "vocabulary"}) {
    const std::string error = loadErrorAfter([&](nn::WeightsFile& file) { file.metadata.erase(key); });
    EXPECT_NE(error.find(std::string("metadata '") + key + "' is missing"), std::string::npos) << error;
  }
}

TEST(LoadPolicy, NamesWhatIsWrongWithATensor) {
  using Change = std::function<void(nn::WeightsFile&)>;
  const std::vector<std::pair<Change, std::string>> cases = {
      {[](nn::WeightsFile& f) { f.tensors.erase("block2.conv.bias"); }, "'block2.conv.bias' is missing"},
      {[](nn::WeightsFile& f) { f.tensors.erase("block4.norm.running_var"); }, "'block4.norm.running_var' is missing"},
      {[](nn::WeightsFile& f) { f.tensors["hidden.weight"].dtype = "I32"; }, "'hidden.weight' has type I32"},
      {[](nn::WeightsFile& f) {
         f.tensors["hidden.weight"].shape = {64, 16};
       },
       "'hidden.weight' has shape (64,16); by the file's metadata it must be (16,64)"},
      {[](nn::WeightsFile& f) { f.metadata["channels"] = "32"; }, "'block1.conv.weight' has shape (16,9,3,3)"},
      {[](nn::WeightsFile& f) { f.metadata["vocabulary"] = R"(["mug"])"; }, "'embedding.weight' has shape (16,6)"},
      {[](nn::WeightsFile& f) { setNumber(f.tensors["output.bias"], 3, std::nanf("")); },
       "'output.bias' holds nan at index 3"},
      {[](nn::WeightsFile& f) { setNumber(f.tensors["output.bias"], 3, INFINITY); }, "'output.bias' holds inf"},
      {[](nn::WeightsFile& f) { setNumber(f.tensors["block1.norm.running_var"], 0, -1.f); },
       "'block1.norm.running_var' holds -1"}};
  for (const auto& [change, part] : cases) {
    const std::string error = loadErrorAfter(change);
    EXPECT_NE(error.find(part), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace early_fusion::model
