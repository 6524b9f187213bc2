#include "early_fusion/learning/checkpoint_tensors.h"

#include <gtest/gtest.h>

#include "early_fusion/core/error.h"

namespace early_fusion::learning {
namespace {

TEST(CheckpointTensors, EveryKindReadsBack) {
  nn::WeightsFile file;
  const Eigen::VectorXf floats = Eigen::VectorXf::LinSpaced(5, -1, 1);
  file.tensors["floats"] = storeFloats(floats);
  file.tensors["integers"] = storeIntegers({-3, 1LL << 40});
  file.tensors["actions"] = storeBytes({0, 1, 2, 6, 5, 4}, {2, 3});
  const nn::WeightsFile read = nn::WeightsFile::parse(file.serialize(), "file");
  EXPECT_EQ(loadFloats(read, "floats", 5, "file"), floats);
  EXPECT_EQ(loadIntegers(read, "integers", "file"), (std::vector<std::int64_t>{-3, 1LL << 40}));
  const auto actions = loadActions(read, "actions", "file");
  ASSERT_EQ(actions.size(), 2u);
  EXPECT_EQ(actions[1],
            (std::vector<core::Action>{core::Action::kIdle, core::Action::kRemove, core::Action::kCollect}));
}

TEST(CheckpointTensors, WrongTypesSizesAndValuesAreErrors) {
  nn::WeightsFile file;
  file.tensors["floats"] = storeFloats(Eigen::VectorXf::Ones(2));
  file.tensors["nan"] = storeFloats(Eigen::VectorXf::Constant(2, NAN));
  file.tensors["actions"] = storeBytes({7}, {1, 1});
  EXPECT_THROW(loadFloats(file, "floats", 3, "file"), core::Error);
  EXPECT_THROW(loadFloats(file, "nan", 2, "file"), core::Error);
  EXPECT_THROW(loadFloats(file, "missing", 2, "file"), core::Error);
  EXPECT_THROW(loadIntegers(file, "floats", "file"), core::Error);
  EXPECT_THROW(loadActions(file, "actions", "file"), core::Error);
}

}  // namespace
}  // namespace early_fusion::learning
