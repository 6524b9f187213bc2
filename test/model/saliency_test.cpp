#include "early_fusion/model/saliency.h"

#include <gtest/gtest.h>

namespace early_fusion::model {
namespace {

constexpr int kSize = 64;

/// Chooses between two actions by the red of one pixel of the newest frame, and by nothing else.
class OnePixelPolicy : public GoalPolicy {
 public:
  OnePixelPolicy(int x, int y) : pixel_(3 * (y * kSize + x)) { options_.image_size = kSize; }

  const PolicyOptions& options() const override { return options_; }
  const core::Vocabulary& vocabulary() const override { return vocabulary_; }
  void predict(const std::vector<Observation>& observations, Probabilities& probabilities) override {
    probabilities.setZero(observations.size(), core::kActionCount);
    for (std::size_t i = 0; i < observations.size(); ++i) {
      probabilities(i, 0) = observations[i].frames[0][pixel_] / 255.f;
      probabilities(i, 1) = 1 - probabilities(i, 0);
    }
  }

 private:
  int pixel_;
  PolicyOptions options_;
  core::Vocabulary vocabulary_;
};

TEST(OcclusionSaliency, IsWhatPaintingTheCellChanges) {
  OnePixelPolicy policy(36, 12);  // cell (1, 4) of 8 x 8, well inside it
  const core::Image black(kSize, kSize);
  const core::Request request{0};
  Observation observation;
  observation.frames[0] = black.rgb.data();
  observation.request = &request;
  const Eigen::MatrixXf saliency = occlusionSaliency(policy, observation, 8);
  ASSERT_EQ(saliency.rows(), 8);
  ASSERT_EQ(saliency.cols(), 8);
  // Grey moves 128 / 255 of the probability from one action to the other.
  EXPECT_NEAR(saliency(1, 4), 128.0 / 255, 1e-6);
  // A neighbour's half-cell margin reaches the pixel only from within half a cell.
  EXPECT_EQ(saliency(3, 4), 0);
  EXPECT_EQ(saliency(1, 6), 0);
  EXPECT_EQ(saliency(7, 0), 0);
}

TEST(Tint, ReddensWhereTheSaliencyIs) {
  core::Image image(16, 16);
  std::fill(image.rgb.begin(), image.rgb.end(), 100);
  Eigen::MatrixXf saliency = Eigen::MatrixXf::Zero(4, 4);
  saliency(0, 0) = 0.25f;
  tint(image, saliency);
  EXPECT_GT(image.rgb[0], 150);
  EXPECT_LT(image.rgb[1], 60);
  const std::size_t last = image.rgb.size() - 3;
  EXPECT_EQ(image.rgb[last], 100);
  EXPECT_EQ(image.rgb[last + 1], 100);
}

TEST(Tint, LeavesNegativeRegionsAlone) {
  core::Image image(16, 16);
  std::fill(image.rgb.begin(), image.rgb.end(), 100);
  Eigen::MatrixXf attention = Eigen::MatrixXf::Constant(4, 4, -3.f);
  attention(0, 0) = 0.25f;
  tint(image, attention);
  EXPECT_GT(image.rgb[0], 150);
  const std::size_t last = image.rgb.size() - 3;
  for (std::size_t i = last; i < image.rgb.size(); ++i) EXPECT_EQ(image.rgb[i], 100);
}

TEST(Tint, LeavesAnImageAloneThatNothingHangsOn) {
  core::Image image(16, 16);
  std::fill(image.rgb.begin(), image.rgb.end(), 100);
  const std::vector<std::uint8_t> before = image.rgb;
  tint(image, Eigen::MatrixXf::Zero(4, 4));
  EXPECT_EQ(image.rgb, before);
}

}  // namespace
}  // namespace early_fusion::model
