#include "early_fusion/core/digest.h"

#include <gtest/gtest.h>

namespace early_fusion::core {
namespace {

TEST(Digest, IsXxh3Of128Bits) {
  EXPECT_EQ(digestOf(""), "99aa06d3014798d86001c324468d497f");  // xxh128sum </dev/null
  EXPECT_EQ(digestOf("a"), "a96faf705af16834e6c632b61e964e1f");
}

}  // namespace
}  // namespace early_fusion::core
