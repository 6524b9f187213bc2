#include "early_fusion/model/action_choice.h"

#include <gtest/gtest.h>

#include <array>

#include "early_fusion/core/error.h"

namespace early_fusion::model {
namespace {

using Row = Eigen::Matrix<float, 1, core::kActionCount>;

Row someProbabilities() {
  Row row;
  row << 0.1f, 0.2f, 0.05f, 0.3f, 0.25f, 0.1f, 0.f;
  return row;
}

TEST(ActionChoice, ArgmaxTakesTheLikeliest) {
  EXPECT_EQ(chooseAction(someProbabilities(), ActionChoice::kArgmax, 1, 2, 3), core::Action::kTiltDown);
}

/// @param dependent how many draws in a row may have used the same random number.
void expectDrawnAsOftenAsLikely(ActionChoice choice, int dependent) {
  constexpr int kDraws = 20000;
  std::array<int, core::kActionCount> counts{};
  for (int i = 0; i < kDraws; ++i) {
    ++counts[static_cast<int>(chooseAction(someProbabilities(), choice, 7, i / 48, i % 48))];
  }
  for (int k = 0; k < core::kActionCount; ++k) {
    const double p = someProbabilities()[k];
    EXPECT_NEAR(double(counts[k]) / kDraws, p, 4 * std::sqrt(p * (1 - p) * dependent / kDraws)) << "action " << k;
  }
}

TEST(ActionChoice, SamplesDrawEachActionAsOftenAsItsProbabilitySays) {
  expectDrawnAsOftenAsLikely(ActionChoice::kSample, 1);
}

TEST(ActionChoice, PersistentDrawsDoTooButKeepToOneActionForAWhile) {
  expectDrawnAsOftenAsLikely(ActionChoice::kPersistent, 32);
  int changes = 0;
  for (int i = 1; i < 4800; ++i) {
    const auto draw = [&](int at) {
      return chooseAction(someProbabilities(), ActionChoice::kPersistent, 7, at / 48, at % 48);
    };
    changes += draw(i) != draw(i - 1);
  }
  EXPECT_GT(changes, 100);
  EXPECT_LT(changes, 480);  // 4800 / 16 new numbers and 100 episodes, most of which change the action
}

TEST(ActionChoice, MixedIsArgmaxInEvenEpisodesAndPersistentInOddOnes) {
  for (std::uint64_t episode = 0; episode < 40; ++episode) {
    const ActionChoice same = episode % 2 == 0 ? ActionChoice::kArgmax : ActionChoice::kPersistent;
    for (std::uint32_t step = 0; step < 48; ++step) {
      EXPECT_EQ(chooseAction(someProbabilities(), ActionChoice::kMixed, 7, episode, step),
                chooseAction(someProbabilities(), same, 7, episode, step));
    }
  }
}

TEST(ActionChoice, ADrawIsDecidedBySeedEpisodeAndStep) {
  int of_seeds = 0, of_episodes = 0, of_steps = 0;
  for (std::uint32_t step = 0; step < 100; ++step) {
    const auto draw = [&](std::uint64_t seed, std::uint64_t episode, std::uint32_t at) {
      return chooseAction(someProbabilities(), ActionChoice::kSample, seed, episode, at);
    };
    EXPECT_EQ(draw(1, 2, step), draw(1, 2, step));
    of_seeds += draw(1, 2, step) != draw(2, 2, step);
    of_episodes += draw(1, 2, step) != draw(1, 3, step);
    of_steps += draw(1, 2, step) != draw(1, 2, step + 100);
  }
  // Two independent draws differ with a probability of 0.785.
  EXPECT_GT(of_seeds, 60);
  EXPECT_GT(of_episodes, 60);
  EXPECT_GT(of_steps, 60);
}

TEST(ActionChoice, NamesItsWays) {
  EXPECT_EQ(actionChoiceFromName("argmax"), ActionChoice::kArgmax);
  EXPECT_EQ(actionChoiceFromName("sample"), ActionChoice::kSample);
  EXPECT_EQ(actionChoiceFromName("persistent"), ActionChoice::kPersistent);
  EXPECT_EQ(actionChoiceFromName("mixed"), ActionChoice::kMixed);
  EXPECT_EQ(actionChoiceNames().size(), 4u);
  EXPECT_THROW(actionChoiceFromName("greedy"), core::Error);
}

}  // namespace
}  // namespace early_fusion::model
