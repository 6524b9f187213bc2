#include "early_fusion/nn/dot.h"

#include <gtest/gtest.h>

#include <vector>

namespace early_fusion::nn {
namespace {

TEST(Dot, AddsEveryProductToTheStart) {
  for (const int count : {0, 1, 15, 16, 17, 64, 100}) {
    std::vector<float> x(count + 1, 1000.f), y(count + 1, 1000.f);  // a number more, which must not count
    float expected = 3;
    for (int i = 0; i < count; ++i) {
      x[i] = static_cast<float>(i % 7 - 3);
      y[i] = static_cast<float>(i % 5 + 1);
      expected += x[i] * y[i];
    }
    EXPECT_EQ(dot(x.data(), y.data(), count, 3), expected) << count << " numbers";
  }
}

}  // namespace
}  // namespace early_fusion::nn
