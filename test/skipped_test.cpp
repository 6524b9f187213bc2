// Stands for a test that cannot be built here, so that it is reported instead of missing.
#include <gtest/gtest.h>

TEST(NotBuilt, IsSkipped) { GTEST_SKIP() << EARLY_FUSION_SKIP_REASON; }
