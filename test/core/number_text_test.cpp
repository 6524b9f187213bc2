#include "early_fusion/core/number_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace early_fusion::core {
namespace {

TEST(NumberText, IsTheShorterOfBothNotations) {
  EXPECT_EQ(shortestText(0), "0");
  EXPECT_EQ(shortestText(-1), "-1");
  EXPECT_EQ(shortestText(0.3), "0.3");
  EXPECT_EQ(shortestText(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(shortestText(1e-4), "1e-04");
  EXPECT_EQ(shortestText(0.001), "0.001");
  EXPECT_EQ(shortestText(2.5e-4), "0.00025");
  EXPECT_EQ(shortestText(10000), "10000");
  EXPECT_EQ(shortestText(100000), "1e+05");
  EXPECT_EQ(shortestText(123456), "123456");
  EXPECT_EQ(shortestText(1e300), "1e+300");
  EXPECT_EQ(shortestText(5e-324), "5e-324");
  EXPECT_EQ(shortestText(std::numeric_limits<double>::infinity()), "inf");
  EXPECT_EQ(shortestText(std::nan("")), "nan");
}

TEST(NumberText, ParsesToTheSameBits) {
  for (const double value : {0.1, 1. / 3, 1e22, 123456789012345678., std::numeric_limits<double>::max(),
                             std::numeric_limits<double>::min(), -2. / 3e-7}) {
    EXPECT_EQ(parseDouble(shortestText(value)), value) << shortestText(value);
  }
}

TEST(NumberText, OnlyWholeTextsAreNumbers) {
  EXPECT_EQ(parseDouble("1e-3"), 0.001);
  EXPECT_EQ(parseDouble("-.5"), -0.5);
  EXPECT_TRUE(std::isnan(parseDouble("nan").value()));
  for (const char* text : {"", " 1", "1 ", "+1", "0x10", "1e", "1,5", "x", "1e999"}) {
    EXPECT_FALSE(parseDouble(text)) << text;
  }
}

}  // namespace
}  // namespace early_fusion::core
