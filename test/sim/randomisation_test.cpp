#include "early_fusion/sim/randomisation.h"

#include <gtest/gtest.h>

#include "early_fusion/core/error.h"

namespace early_fusion::sim {
namespace {

std::string errorOf(const std::string& text) {
  try {
    parseRandomisation(text);
  } catch (const core::Error& error) {
    return error.what();
  }
  return "";
}

TEST(Randomisation, NoneChangesNothing) {
  EXPECT_TRUE(Randomisation().isNone());
  EXPECT_TRUE(loadRandomisation("none").isNone());
  EXPECT_EQ(randomisationText(Randomisation()), "");
  EXPECT_TRUE(parseRandomisation("").isNone());
  Randomisation only_looks;  // nothing departs from the world's files, however many looks there are
  only_looks.looks = 4;
  only_looks.texture_set = "held_out";
  EXPECT_TRUE(only_looks.isNone());
}

TEST(Randomisation, EveryShippedFileIsKnownAndAllButNoneChangeSomething) {
  for (const char* name : {"real_camera", "kitchen_1", "kitchen_2", "kitchen_3", "sensor"}) {
    EXPECT_FALSE(loadRandomisation(name).isNone()) << name;
  }
}

TEST(Randomisation, ItsTextIsReadAsTheSameOne) {
  Randomisation noisy;
  noisy.noise = 7.5;
  noisy.distractors = 3;
  noisy.texture_set = "held_out";
  noisy.looks = 2;
  noisy.look_seed = 18446744073709551615u;
  Randomisation read = parseRandomisation(randomisationText(noisy));
  EXPECT_EQ(read.options().toYamlLine(), noisy.options().toYamlLine());
  EXPECT_EQ(read.look_seed, 18446744073709551615u);
}

TEST(Randomisation, NamesWhatIsWrong) {
  EXPECT_NE(errorOf("{noise: -1}").find("noise: '-1' is out of range"), std::string::npos) << errorOf("{noise: -1}");
  EXPECT_NE(errorOf("{nois: 1}").find("nois"), std::string::npos);
  EXPECT_NE(errorOf("{texture_set: all}").find("texture_set"), std::string::npos);
  try {
    loadRandomisation("kitchen");
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("kitchen_1"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace early_fusion::sim
