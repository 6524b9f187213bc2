#include "early_fusion/nn/dropout.h"

#include <gtest/gtest.h>

namespace early_fusion::nn {
namespace {

TEST(Dropout, DropsItsShareAndScalesTheRest) {
  constexpr int kRows = 200, kColumns = 64;
  for (double rate : {0.1, 0.5, 0.9}) {
    Dropout dropout(rate);
    Matrix x = Matrix::Constant(kRows, kColumns, 2.f);
    dropout.forward(x, kRows, 7);
    int dropped = 0;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const bool zeroed = x.data()[i] == 0.f;
      dropped += zeroed;
      EXPECT_FLOAT_EQ(x.data()[i], zeroed ? 0.f : static_cast<float>(2 / (1 - rate)));
    }
    // Four standard deviations of a binomial.
    const double count = kRows * kColumns;
    EXPECT_NEAR(dropped / count, rate, 4 * std::sqrt(rate * (1 - rate) / count));
  }
}

TEST(Dropout, IsDecidedByItsSeed) {
  Dropout dropout(0.5);
  Matrix first = Matrix::Ones(8, 16), again = first, other = first;
  dropout.forward(first, 8, 1);
  dropout.forward(again, 8, 1);
  dropout.forward(other, 8, 2);
  EXPECT_EQ(first, again);
  EXPECT_NE(first, other);
}

TEST(Dropout, AtZeroDoesNothing) {
  Dropout dropout(0);
  Matrix x = Matrix::Random(4, 16);
  const Matrix before = x;
  dropout.forward(x, 4, 1);
  EXPECT_EQ(x, before);
  dropout.backward(x, 4);
  EXPECT_EQ(x, before);
}

}  // namespace
}  // namespace early_fusion::nn
