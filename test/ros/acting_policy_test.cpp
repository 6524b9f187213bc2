#include "early_fusion/ros/policy/acting_policy.h"

#include <gtest/gtest.h>

#include <set>

#include "early_fusion/core/error.h"
#include "early_fusion/core/random.h"
#include "early_fusion/model/policy_file.h"
#include "early_fusion/model/policy_kinds.h"

namespace early_fusion::nodes {
namespace {

constexpr int kSize = 32;

class ActingPolicyTest : public testing::Test {
 protected:
  ActingPolicyTest() {
    options_.image_size = kSize;
    options_.precision = "f32";
    options_.horizontal_fov_deg = 45;
    policy_ = model::makePolicy(options_, core::Vocabulary({"bowl", "mug"}), 3);
    acting_.load(model::savePolicy(*policy_, {}), "test", {"argmax", 0, "f32"});
  }

  static core::Image frame(std::uint64_t seed) {
    core::Image image(kSize, kSize);
    core::Random random(seed);
    for (std::uint8_t& value : image.rgb) value = static_cast<std::uint8_t>(random.below(256));
    return image;
  }

  /// The network's probabilities for these frames, the newest first.
  std::vector<float> expected(const std::vector<core::Image>& frames, const core::Request& request) {
    model::Observation observation;
    observation.request = &request;
    for (std::size_t age = 0; age < frames.size(); ++age) observation.frames[age] = frames[age].rgb.data();
    model::Probabilities probabilities;
    policy_->predict({observation}, probabilities);
    return {probabilities.data(), probabilities.data() + core::kActionCount};
  }

  model::PolicyOptions options_;
  std::unique_ptr<model::TrainablePolicy> policy_;
  ActingPolicy acting_;
};

TEST_F(ActingPolicyTest, DecidesFromTheLastThreeFramesNewestFirst) {
  const core::Image a = frame(1), b = frame(2), c = frame(3), d = frame(4);
  const core::Request request{1};
  EXPECT_EQ(acting_.decide(a, {"mug"}, 7, 0).probabilities, expected({a}, request));
  EXPECT_EQ(acting_.decide(b, {"mug"}, 7, 1).probabilities, expected({b, a}, request));
  EXPECT_EQ(acting_.decide(c, {"mug"}, 7, 2).probabilities, expected({c, b, a}, request));
  const Decision decision = acting_.decide(d, {"mug"}, 7, 3);
  EXPECT_EQ(decision.probabilities, expected({d, c, b}, request));
  EXPECT_EQ(decision.frames, 3);
}

TEST_F(ActingPolicyTest, ForgetsWhenAnEpisodeBegins) {
  acting_.decide(frame(1), {"mug"}, 7, 0);
  acting_.decide(frame(2), {"mug"}, 7, 1);
  EXPECT_EQ(acting_.decide(frame(3), {"mug"}, 8, 0).frames, 1);
  acting_.decide(frame(4), {"mug"}, 8, 1);
  // The same episode from its beginning, as after a goal that was sent again.
  EXPECT_EQ(acting_.decide(frame(3), {"mug"}, 8, 0).frames, 1);
}

TEST_F(ActingPolicyTest, AGapInTheStepsBeginsAnew) {
  acting_.decide(frame(1), {"mug"}, 7, 0);
  EXPECT_EQ(acting_.decide(frame(2), {"mug"}, 7, 2).frames, 1);
}

TEST_F(ActingPolicyTest, TheSameStepAgainReplacesItsFrame) {
  const core::Image a = frame(1), b = frame(2);
  acting_.decide(a, {"mug"}, 7, 0);
  acting_.decide(frame(9), {"mug"}, 7, 1);
  const Decision decision = acting_.decide(b, {"bowl"}, 7, 1);
  EXPECT_EQ(decision.probabilities, expected({b, a}, {0}));
  EXPECT_EQ(decision.frames, 2);
}

TEST_F(ActingPolicyTest, TheRequestsOrderDoesNotMatter) {
  const std::vector<float> one = acting_.decide(frame(1), {"mug", "bowl"}, 7, 0).probabilities;
  EXPECT_EQ(acting_.decide(frame(1), {"bowl", "mug"}, 7, 0).probabilities, one);
}

TEST_F(ActingPolicyTest, AnUnknownItemIsNamedWithTheKnownOnesAndLeavesTheFramesAlone) {
  acting_.decide(frame(1), {"mug"}, 7, 0);
  try {
    acting_.decide(frame(2), {"anvil"}, 7, 1);
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("anvil"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("bowl, mug"), std::string::npos) << error.what();
  }
  EXPECT_EQ(acting_.decide(frame(2), {"mug"}, 7, 1).frames, 2);
}

TEST_F(ActingPolicyTest, NamesTheRequestedItemWhoseOwnRequestMakesAnActionLikeliest) {
  const core::Image a = frame(1), b = frame(2);
  acting_.decide(a, {"mug", "bowl", "mug"}, 7, 0);
  acting_.decide(b, {"mug", "bowl", "mug"}, 7, 1);
  std::set<std::string> named;
  for (const core::Action action : core::kAllActions) {
    const float bowl = expected({b, a}, {0})[static_cast<int>(action)];
    const float mug = expected({b, a}, {1})[static_cast<int>(action)];
    const LikelyItem item = acting_.likeliestItem(action);
    EXPECT_EQ(item.name, bowl > mug ? "bowl" : "mug");
    EXPECT_EQ(item.probability, std::max(bowl, mug));
    named.insert(item.name);
  }
  EXPECT_EQ(named.size(), 2u) << "each is the likeliest for some action, because probabilities add up to 1";
  acting_.decide(b, {"bowl"}, 7, 1);
  EXPECT_EQ(acting_.likeliestItem(core::Action::kCollect).name, "bowl");
}

TEST_F(ActingPolicyTest, DrawnActionsAreAFunctionOfSeedEpisodeAndStep) {
  acting_.load(acting_.file(), "test", {"sample", 11, "f32"});
  int differs = 0;
  for (std::uint32_t step = 0; step < 20; ++step) {
    const Decision decision = acting_.decide(frame(step), {"mug"}, 7, step);
    model::Probabilities row(1, core::kActionCount);
    for (int i = 0; i < core::kActionCount; ++i) row(0, i) = decision.probabilities[i];
    EXPECT_EQ(decision.action, model::chooseAction(row.row(0), model::ActionChoice::kSample, 11, 7, step));
    differs += decision.action != model::chooseAction(row.row(0), model::ActionChoice::kArgmax, 11, 7, step);
  }
  EXPECT_GT(differs, 0);
}

TEST_F(ActingPolicyTest, UnusableWeightsLeaveTheOldOnesActing) {
  nn::WeightsFile broken = acting_.file();
  broken.tensors.erase(broken.tensors.begin());
  EXPECT_THROW(acting_.load(broken, "broken", {}), core::Error);
  EXPECT_THROW(acting_.load(acting_.file(), "test", {"guess", 0, "f32"}), core::Error);
  const core::Image a = frame(1);
  EXPECT_EQ(acting_.decide(a, {"mug"}, 7, 0).probabilities, expected({a}, {1}));
}

TEST_F(ActingPolicyTest, ShowsTheLastImageTinted) {
  acting_.decide(frame(1), {"mug"}, 7, 0);
  acting_.decide(frame(2), {"mug"}, 7, 1);
  const core::Image plain = frame(2), tinted = acting_.lastImageTinted(4);
  ASSERT_EQ(tinted.rgb.size(), plain.rgb.size());
  int redder = 0;
  for (std::size_t i = 0; i < plain.rgb.size(); i += 3) {
    EXPECT_GE(tinted.rgb[i], plain.rgb[i]);
    EXPECT_LE(tinted.rgb[i + 1], plain.rgb[i + 1]);
    redder += tinted.rgb[i] > plain.rgb[i];
  }
  EXPECT_GT(redder, 0);
}

TEST_F(ActingPolicyTest, ShowsWhatAKindWithAttentionAttendsToInsteadOfSaliency) {
  acting_.decide(frame(1), {"mug"}, 7, 0);
  EXPECT_EQ(acting_.lastImageTinted(0).rgb, frame(1).rgb) << "without attention and a grid nothing is tinted";
  options_.kind = "softmax_attention_map";
  acting_.load(model::savePolicy(*model::makePolicy(options_, core::Vocabulary({"bowl", "mug"}), 3), {}), "test", {});
  acting_.decide(frame(1), {"mug"}, 7, 0);
  const core::Image tinted = acting_.lastImageTinted(0);
  EXPECT_NE(tinted.rgb, frame(1).rgb);
  EXPECT_EQ(acting_.lastImageTinted(4).rgb, tinted.rgb);
}

TEST_F(ActingPolicyTest, TellsTheFieldOfViewOfItsWeightsAndRefusesThoseWithout) {
  nn::WeightsFile file = acting_.file();
  file.metadata.erase("horizontal_fov_deg");
  EXPECT_THROW(acting_.load(file, "test", {}), core::Error);
  EXPECT_DOUBLE_EQ(acting_.horizontalFovDeg(), 45);
}

}  // namespace
}  // namespace early_fusion::nodes
