#include "early_fusion/ros/robot/transform_gate.h"

#include <gtest/gtest.h>

namespace early_fusion::nodes {
namespace {

using Verdict = TransformGate::Verdict;

constexpr double kCacheSec = 10;

TEST(TransformGate, TakesWhatIsNewOrWithinTheHistoryAndLeavesOutRepetitions) {
  TransformGate gate(kCacheSec);
  EXPECT_EQ(gate.judge("head", "/driver", 100, 0), Verdict::kTake);
  EXPECT_EQ(gate.judge("head", "/driver", 100, 0.1), Verdict::kLeaveOut) << "a repetition";
  EXPECT_EQ(gate.judge("head", "/driver", 101, 0.2), Verdict::kTake);
  EXPECT_EQ(gate.judge("head", "/driver", 99, 0.3), Verdict::kTake) << "tf2 sorts it in";
  EXPECT_EQ(gate.judge("arm", "/other", 5, 0.3), Verdict::kTake) << "another frame";
  EXPECT_EQ(gate.rivals(), "");
}

TEST(TransformGate, ATimeThatJumpsBackBeginsAnew) {
  TransformGate gate(kCacheSec);
  gate.judge("head", "/play_1", 100, 0);
  gate.judge("arm", "/play_1", 100, 0);
  EXPECT_EQ(gate.judge("head", "/play_1", 20, 0.5), Verdict::kLeaveOut) << "perhaps somebody else goes on at 100";
  EXPECT_EQ(gate.judge("head", "/play_1", 21, 1.1), Verdict::kBeginAnew);
  EXPECT_EQ(gate.judge("arm", "/play_1", 21, 1.1), Verdict::kTake) << "the whole buffer has begun anew";
  gate.forget();
  EXPECT_EQ(gate.judge("head", "/play_1", 1, 1.2), Verdict::kTake);
}

TEST(TransformGate, NamesTwoPublishersWithStampsFarApartAndKeepsTheNewerOnes) {
  TransformGate gate(kCacheSec);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(gate.judge("head", "/driver", 5000 + 0.1 * i, 0.1 * i), Verdict::kTake);
    EXPECT_EQ(gate.rivals(), "");
    EXPECT_EQ(gate.judge("head", "/play_1", 100 + 0.1 * i, 0.1 * i), Verdict::kLeaveOut);
    EXPECT_NE(gate.rivals().find("/driver and /play_1 publish the transform of 'head' with stamps 4900 s apart"),
              std::string::npos)
        << gate.rivals();
  }
}

}  // namespace
}  // namespace early_fusion::nodes
