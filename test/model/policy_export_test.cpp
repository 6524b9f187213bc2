#include "early_fusion/model/policy_export.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <opencv2/dnn.hpp>

#include "early_fusion/core/file.h"
#include "early_fusion/learning/rollout.h"
#include "early_fusion/model/policy_file.h"
#include "early_fusion/model/vision_trunk.h"
#include "early_fusion/world/world.h"
#include "parity_case.h"

namespace early_fusion::model {
namespace {

/// The frames of an episode of MEDIUM with random actions, and a random request for each.
struct PlayedEpisode {
  static constexpr int kSteps = 200;

  explicit PlayedEpisode(const world::World& world) {
    sim::Task task = sim::loadTask("medium");
    task.steps = kSteps;
    learning::RolloutRunner runner(world, task, 1);
    runner.run(0, 1, *learning::makeRandomAgent(1), true,
               [&](learning::Trajectory played) { trajectory = std::move(played); });
    core::Random random(4);
    requests.resize(trajectory.steps.size());
    for (core::Request& request : requests) {
      for (int k = random.below(4); k > 0; --k) request.push_back(random.below(world.objects.size()));
      if (!request.empty() && random.below(3) == 0) request.push_back(request.front());
    }
  }

  Observation observation(std::size_t step) const { return {trajectory.frameStack(step), &requests[step]}; }

  learning::Trajectory trajectory;
  std::vector<core::Request> requests;
};

class PolicyExport : public testing::TestWithParam<std::pair<std::string, int>> {
 protected:
  static void SetUpTestSuite() {
    world = world::loadWorld("");
    played = std::make_unique<PlayedEpisode>(*world);
    ASSERT_EQ(played->trajectory.steps.size(), 200u);
  }
  static void TearDownTestSuite() {
    played.reset();
    world.reset();
  }

  static cv::Mat floatsOrBytes(const cv::Mat& bytes, nn::OnnxType type) {
    cv::Mat converted = bytes;
    if (type == nn::OnnxType::kFloat) bytes.convertTo(converted, CV_32F);
    return converted;
  }

  /// What a user feeds: the last three frames, the newest first, and the counts of the request.
  static void feed(cv::dnn::Net& net, const Observation& observation, nn::OnnxType type) {
    const int size = world->options.image_size;
    cv::Mat frames(std::vector<int>{core::kStackedFrames, size, size, 3}, CV_8U, cv::Scalar(0));
    for (int age = 0; age < core::kStackedFrames; ++age) {
      const std::uint8_t* frame = observation.frames[age];
      if (frame != nullptr) std::memcpy(frames.ptr(age), frame, frames.step[0]);
    }
    cv::Mat counts(1, world->objects.size(), CV_32F, cv::Scalar(0));
    for (int item : *observation.request) counts.at<float>(item) += 1;
    net.setInput(floatsOrBytes(frames, type), "frames");
    net.setInput(counts, "request");
  }

  /// OpenCV's probabilities are the policy's, at each step of the episode.
  static void expectSame(TrainablePolicy& policy, nn::OnnxType type) {
    const std::string bytes = exportOnnx(policy, type, {});
    cv::dnn::Net net = cv::dnn::readNetFromONNX(bytes.data(), bytes.size());
    Probabilities all(PlayedEpisode::kSteps, core::kActionCount), expected;
    for (int step = 0; step < PlayedEpisode::kSteps; ++step) {
      policy.predict({played->observation(step)}, expected);
      all.row(step) = expected;
      feed(net, played->observation(step), type);
      const cv::Mat probabilities = net.forward("probabilities");
      ASSERT_EQ(probabilities.size(), cv::Size(core::kActionCount, 1));
      for (int k = 0; k < core::kActionCount; ++k) {
        ASSERT_NEAR(probabilities.at<float>(k), expected(0, k), 1e-4) << "step " << step << ", action " << k;
      }
    }
    // A network that hardly depends on its inputs could hide a wrong one.
    EXPECT_GT((all.colwise().maxCoeff() - all.colwise().minCoeff()).mean(), 0.04f) << all.topRows(9);
  }

  inline static std::shared_ptr<const world::World> world;
  inline static std::unique_ptr<PlayedEpisode> played;
};

/// An untrained network, with norms that do something and larger logits, so that its probabilities differ by step.
std::unique_ptr<TrainablePolicy> drawnPolicy(const PolicyOptions& options, const core::Vocabulary& vocabulary) {
  auto policy = makePolicy(options, vocabulary, 3);
  drawNorms(policy->parameters());
  for (const nn::TensorSlice& slice : policy->parameters().parameterSlices()) {
    if (slice.name == "output.weight") policy->parameters().values().segment(slice.offset, slice.size) *= 4;
  }
  policy->parametersChanged();
  return policy;
}

TEST_P(PolicyExport, GivesTheSameProbabilitiesInOpenCvAtEachStepOfAnEpisode) {
  PolicyOptions options;
  std::tie(options.kind, options.fusion_block) = GetParam();
  options.precision = "f32";
  for (const auto& [spatial_grid, type] :
       {std::pair("true", nn::OnnxType::kFloat), std::pair("false", nn::OnnxType::kByte)}) {
    options.spatial_grid = spatial_grid;
    SCOPED_TRACE(std::string("spatial grid: ") + spatial_grid);
    expectSame(*drawnPolicy(options, world->objects.vocabulary()), type);
  }
}

/// Every kind, with the goal joined at every place where there is a choice.
std::vector<std::pair<std::string, int>> everyNetwork() {
  std::vector<std::pair<std::string, int>> networks;
  for (const PolicyKind& kind : policyKinds()) {
    const bool fuses = std::count(kind.options.begin(), kind.options.end(), "fusion_block") > 0;
    for (int block = 0; block < (fuses ? kBlocks : 1); ++block) networks.emplace_back(kind.name, block);
  }
  return networks;
}

INSTANTIATE_TEST_SUITE_P(Kinds, PolicyExport, testing::ValuesIn(everyNetwork()),
                         [](const auto& info) { return info.param.first + "_" + std::to_string(info.param.second); });

using ShippedPolicyExport = PolicyExport;

TEST_F(ShippedPolicyExport, GivesTheSameProbabilitiesInOpenCvForTrainedWeights) {
  const std::string path = core::shareFolder() + "/models/medium.safetensors";
  const auto policy = loadPolicy(nn::WeightsFile::read(path), path, "f32");
  for (const nn::OnnxType type : {nn::OnnxType::kByte, nn::OnnxType::kFloat}) expectSame(*policy, type);
}

TEST(PolicyExportMetadata, IsThatOfAWeightsFileAndWhatIsGiven) {
  const auto policy = parityPolicy({"late_fusion", 16, 1, 32});
  const std::string bytes = exportOnnx(*policy, nn::OnnxType::kByte, {{"task", "medium"}});
  for (const auto& [key, value] : savePolicy(*policy, {{"task", "medium"}}).metadata) {
    const auto field = [](const std::string& text) { return static_cast<char>(text.size()) + text; };
    EXPECT_NE(bytes.find(field(key) + "\x12" + field(value)), std::string::npos) << key;  // 2 << 3 | 2: a text
  }
}

}  // namespace
}  // namespace early_fusion::model
