#include "early_fusion/nn/convolution.h"

#include <dnnl_version.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

#include "early_fusion/core/error.h"

#include "reference_layers.h"

namespace early_fusion::nn {
namespace {

/// height, width, in, out
class ConvolutionTest : public testing::TestWithParam<std::array<int, 4>> {
 protected:
  ConvolutionTest() {
    const auto [height, width, in, out] = GetParam();
    shape = {in, out, height, width};
    x = randomNumbers(std::size_t(height) * width * in, random);
    weights = randomNumbers(std::size_t(out) * in * 9, random);
  }

  template <class T>
  static AlignedBuffer<T> stored(const Numbers& numbers) {
    AlignedBuffer<T> buffer(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) buffer[i] = fromFloat<T>(static_cast<float>(numbers[i]));
    return buffer;
  }

  template <class T>
  static Numbers numbers(const AlignedBuffer<T>& buffer) {
    Numbers numbers;
    for (std::size_t i = 0; i < buffer.size(); ++i) numbers.push_back(toFloat(buffer[i]));
    return numbers;
  }

  MapShape mapOf(int channels, MapLayout layout) const { return {shape.height, shape.width, channels, layout}; }

  template <class T>
  double forwardError() {
    Convolution<T> convolution(shape, false, 2);
    convolution.setWeights(stored<float>(weights).data());
    const AlignedBuffer<T> in = stored<T>(x);
    const Numbers expected =
        naiveConvolution(x, weights, shape.height, shape.width, shape.in_channels, shape.out_channels);
    AlignedBuffer<T> out(expected.size()), second(expected.size());
    convolution.forward(0, in.data(), out.data());
    convolution.forward(1, in.data(), second.data());
    EXPECT_EQ(std::memcmp(out.data(), second.data(), expected.size() * sizeof(T)), 0);

    const MapLayout layout = convolution.predictionLayout();
    const AlignedBuffer<T> laid_out = inLayout(in.data(), mapOf(shape.in_channels, layout));
    AlignedBuffer<T> predicted(expected.size()), wide(expected.size());
    convolution.predict(0, laid_out.data(), predicted.data());
    convolution.predict(1, laid_out.data(), second.data());
    convolution.predictOnAllThreads(laid_out.data(), wide.data());
    EXPECT_EQ(std::memcmp(predicted.data(), second.data(), expected.size() * sizeof(T)), 0);
    EXPECT_EQ(std::memcmp(predicted.data(), wide.data(), expected.size() * sizeof(T)), 0);
    const AlignedBuffer<T> same = inLayout(out.data(), mapOf(shape.out_channels, layout));
    return std::max(worstError(numbers(out), expected), worstError(numbers(predicted), numbers(same)));
  }

  core::Random random{31};
  ConvolutionShape shape{};
  Numbers x, weights;
};

TEST(Processor, PrefersBfloat16OnlyWhereItHasIt) { EXPECT_TRUE(processorHasBfloat16() || !processorPrefersBfloat16()); }

class ConvolutionLibraryTest : public testing::Test {
 protected:
  static constexpr char kVariable[] = "EARLY_FUSION_CONVOLUTIONS";
  ConvolutionLibraryTest() {
    if (const char* value = std::getenv(kVariable)) before = value;
  }
  ~ConvolutionLibraryTest() override { setenv(kVariable, before.c_str(), 1); }

  std::string before;
};

TEST_F(ConvolutionLibraryTest, IsWhatTheEnvironmentNames) {
  unsetenv(kVariable);
  EXPECT_EQ(convolutionLibrary(), ConvolutionLibrary::kAuto);
  setenv(kVariable, "onednn", 1);
  EXPECT_EQ(convolutionLibrary(), ConvolutionLibrary::kOneDnn);
  setenv(kVariable, "eigen", 1);
  EXPECT_EQ(convolutionLibrary(), ConvolutionLibrary::kEigen);
}

TEST_F(ConvolutionLibraryTest, RefusesAnotherName) {
  setenv(kVariable, "xnnpack", 1);
  try {
    Convolution<float>({16, 16, 4, 4}, false, 1);
    FAIL() << "no error";
  } catch (const core::Error& error) {
    EXPECT_STREQ(error.what(),
                 "environment variable EARLY_FUSION_CONVOLUTIONS: 'xnnpack' is not known; use auto, onednn or eigen");
  }
}

TEST_F(ConvolutionLibraryTest, DiffersByRoundingOnly) {
  const ConvolutionShape shape{9, 16, 24, 40};
  core::Random random(5);
  const Numbers x = randomNumbers(std::size_t(9) * 24 * 40, random),
                dy = randomNumbers(std::size_t(16) * 24 * 40, random);
  const Numbers weights = randomNumbers(std::size_t(9) * 16 * 9, random);
  const auto results = [&](const char* library) {
    setenv(kVariable, library, 1);
    Convolution<float> convolution(shape, true, 1);
    const auto stored = [](const Numbers& numbers) { return std::vector<float>(numbers.begin(), numbers.end()); };
    convolution.setWeights(stored(weights).data());
    std::vector<float> dx(x.size()), dw(convolution.weightsGradientSize()), oihw(weights.size());
    convolution.backwardInput(0, stored(dy).data(), dx.data());
    convolution.backwardWeights(0, stored(x).data(), stored(dy).data(), dw.data());
    convolution.weightsGradient(dw.data(), oihw.data());
    return std::pair(Numbers(dx.begin(), dx.end()), Numbers(oihw.begin(), oihw.end()));
  };
  const auto onednn = results("onednn"), eigen = results("eigen");
  EXPECT_LT(worstError(eigen.first, onednn.first), 1e-5);
  EXPECT_LT(worstError(eigen.second, onednn.second), 1e-5);
}

TEST_P(ConvolutionTest, PredictsByWinogradWhereThereAreManyChannels) {
  if (!processorHasBfloat16()) GTEST_SKIP() << "this processor may lack the kernels";
  if (convolutionLibrary() == ConvolutionLibrary::kEigen) GTEST_SKIP() << "Eigen multiplies directly";
  const bool many = std::min(shape.in_channels, shape.out_channels) >= 64;
  const bool has_kernels = DNNL_VERSION_MAJOR < 3;  // oneDNN 3 dropped them
  EXPECT_EQ(Convolution<float>(shape, false, 1).predictionLayout() == MapLayout::kBlocked, many && has_kernels);
  EXPECT_EQ(Convolution<bfloat16>(shape, false, 1).predictionLayout(), MapLayout::kChannelsLast);
}

TEST_P(ConvolutionTest, IsTheNaiveOneOnEveryThread) { EXPECT_LT(forwardError<float>(), 1e-5); }

TEST_P(ConvolutionTest, InBfloat16IsCloseToTheNaiveOne) {
  if (!processorHasBfloat16()) GTEST_SKIP() << "no native bfloat16 here";
  EXPECT_LT(forwardError<bfloat16>(), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Shapes, ConvolutionTest,
                         testing::Values(std::array<int, 4>{128, 128, 9, 16}, std::array<int, 4>{6, 10, 16, 32},
                                         std::array<int, 4>{2, 2, 64, 64}, std::array<int, 4>{64, 64, 16, 16},
                                         std::array<int, 4>{16, 16, 64, 64}, std::array<int, 4>{32, 24, 128, 64},
                                         std::array<int, 4>{32, 32, 32, 32}));

}  // namespace
}  // namespace early_fusion::nn
