// Every layer's gradients against finite differences of the same layer, written naively in double.
#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "early_fusion/nn/attention_pooling.h"
#include "early_fusion/nn/dropout.h"
#include "early_fusion/nn/linear.h"
#include "early_fusion/nn/softmax_cross_entropy.h"
#include "reference_layers.h"

namespace early_fusion::nn {
namespace {

/// A tensor that the loss depends on, and its gradient according to the layer.
struct Checked {
  std::string name;
  Numbers* values;
  Numbers gradient;
};

/// A layer with a scalar behind it.
struct LayerCheck {
  virtual ~LayerCheck() = default;
  /// In double, from the present values of the tensors.
  virtual double loss() = 0;
  virtual std::vector<Checked> tensors() = 0;
};

Matrix toMatrix(const Numbers& numbers, int rows, int columns) {
  Matrix matrix(rows, columns);
  for (Eigen::Index i = 0; i < matrix.size(); ++i) matrix.data()[i] = static_cast<float>(numbers[i]);
  return matrix;
}

Numbers fromMatrix(const Matrix& matrix) { return Numbers(matrix.data(), matrix.data() + matrix.size()); }

double weightedSum(const Numbers& values, const Numbers& factors) {
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += values[i] * factors[i];
  return sum;
}

struct ConvBlockCheck : LayerCheck {
  ConvBlockCheck(const ConvBlockShape& shape, int images)
      : random(11),
        naive(shape, images, random),
        factors(randomNumbers(std::size_t(images) * shape.size * shape.size / 4 * shape.out_channels, random)) {}

  double loss() override { return weightedSum(naive.forward(), factors); }

  std::vector<Checked> tensors() override {
    FastConvBlock<float> fast(naive, true, 2);
    fast.normalisation = normalisation;
    fast.forward();
    fast.backward(factors);
    return {{"conv.weight", &naive.weight, fast.gradient("block.conv.weight")},
            {"conv.bias", &naive.bias, fast.gradient("block.conv.bias")},
            {"norm.weight", &naive.scale, fast.gradient("block.norm.weight")},
            {"norm.bias", &naive.shift, fast.gradient("block.norm.bias")},
            {"x", &naive.x, Numbers(fast.dx.data(), fast.dx.data() + naive.x.size())},
            {"goals", &naive.goals, fromMatrix(fast.dgoals)}};
  }

  core::Random random;
  NaiveConvBlock naive;
  Numbers factors;
  Normalisation normalisation = Normalisation::kBatch;
};

/// What the running statistics differ by from the batch's is a constant.
struct RenormalisedCheck : ConvBlockCheck {
  RenormalisedCheck(const ConvBlockShape& shape, int images) : ConvBlockCheck(shape, images) {
    normalisation = Normalisation::kRunning;
    FastConvBlock<float> fast(naive, true, 2);
    fast.normalisation = normalisation;
    fast.forward();
    naive.forward();
    const Numbers mean = fast.buffer("block.norm.running_mean"), variance = fast.buffer("block.norm.running_var");
    for (int c = 0; c < shape.out_channels; ++c) {
      naive.ratio.push_back(std::sqrt((naive.variance[c] + 1e-5) / (variance[c] + 1e-5)));
      naive.distance.push_back((naive.mean[c] - mean[c]) / std::sqrt(variance[c] + 1e-5));
    }
  }
};

struct LinearCheck : LayerCheck {
  static constexpr int kRows = 5, kIn = 37, kOut = 19;

  LinearCheck()
      : x(randomNumbers(kRows * kIn, random)),
        weight(randomNumbers(kOut * kIn, random)),
        bias(randomNumbers(kOut, random)),
        factors(randomNumbers(kRows * kOut, random)) {}

  double loss() override {
    double sum = 0;
    for (int row = 0; row < kRows; ++row) {
      for (int o = 0; o < kOut; ++o) {
        double y = bias[o];
        for (int i = 0; i < kIn; ++i) y += weight[o * kIn + i] * x[row * kIn + i];
        sum += y * factors[row * kOut + o];
      }
    }
    return sum;
  }

  std::vector<Checked> tensors() override {
    Parameters parameters;
    Linear layer(parameters, "linear", kIn, kOut, 2);
    for (int i = 0; i < kOut * kIn; ++i) parameters.values()[i] = static_cast<float>(weight[i]);
    for (int i = 0; i < kOut; ++i) parameters.values()[kOut * kIn + i] = static_cast<float>(bias[i]);
    Matrix dx(kRows, kIn);
    layer.backward(toMatrix(x, kRows, kIn), toMatrix(factors, kRows, kOut), kRows, &dx);
    const float* gradients = parameters.gradients().data();
    return {{"weight", &weight, Numbers(gradients, gradients + kOut * kIn)},
            {"bias", &bias, Numbers(gradients + kOut * kIn, gradients + kOut * kIn + kOut)},
            {"x", &x, fromMatrix(dx)}};
  }

  core::Random random{12};
  Numbers x, weight, bias, factors;
};

struct DropoutCheck : LayerCheck {
  static constexpr int kRows = 6, kColumns = 16;

  DropoutCheck() : x(randomNumbers(kRows * kColumns, random)), factors(randomNumbers(kRows * kColumns, random)) {
    Matrix ones = Matrix::Ones(kRows, kColumns);
    layer.forward(ones, kRows, 5);
    mask = fromMatrix(ones);
  }

  double loss() override {
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * mask[i] * factors[i];
    return sum;
  }

  std::vector<Checked> tensors() override {
    Matrix dx = toMatrix(factors, kRows, kColumns);
    layer.backward(dx, kRows);
    return {{"x", &x, fromMatrix(dx)}};
  }

  core::Random random{13};
  Dropout layer{0.3};
  Numbers x, factors, mask;
};

struct CrossEntropyCheck : LayerCheck {
  static constexpr int kRows = 6, kClasses = 7;

  CrossEntropyCheck()
      : logits(randomNumbers(kRows * kClasses, random, -3, 3)),
        targets(randomNumbers(kRows * kClasses, random, 0, 1)),
        unlikelihoods(randomNumbers(kRows * kClasses, random, 0, 3)),
        weights(randomNumbers(kRows, random, 0.1, 2)) {
    weights[2] = 0;
    unlikelihoods[1] = 0;
  }

  double loss() override {
    double sum = 0, weight_sum = 0;
    for (int row = 0; row < kRows; ++row) {
      double normaliser = 0;
      for (int k = 0; k < kClasses; ++k) normaliser += std::exp(logits[row * kClasses + k]);
      for (int k = 0; k < kClasses; ++k) {
        const double probability = std::exp(logits[row * kClasses + k]) / normaliser;
        sum -= weights[row] * targets[row * kClasses + k] * std::log(probability);
        sum -= weights[row] * unlikelihoods[row * kClasses + k] * std::log(1 - probability);
      }
      weight_sum += weights[row];
    }
    return sum / weight_sum;
  }

  std::vector<Checked> tensors() override {
    Matrix dlogits(kRows, kClasses);
    const Eigen::VectorXd row_weights = Eigen::Map<Eigen::VectorXd>(weights.data(), kRows);
    const Matrix matrix = toMatrix(logits, kRows, kClasses);
    const double value =
        softmaxCrossEntropy(matrix, toMatrix(targets, kRows, kClasses), row_weights, kRows, dlogits) +
        unlikelihoodLoss(matrix, toMatrix(unlikelihoods, kRows, kClasses), row_weights, kRows, dlogits);
    EXPECT_NEAR(value, loss(), 1e-6);
    return {{"logits", &logits, fromMatrix(dlogits)}};
  }

  core::Random random{14};
  Numbers logits, targets, unlikelihoods, weights;
};

/// Two queries that share a map, whose gradient is the sum of both.
struct AttentionPoolingCheck : LayerCheck {
  static constexpr int kChannels = 5, kRegions = 19, kQueries = 2;

  explicit AttentionPoolingCheck(AttentionWeights weights)
      : kind(weights),
        map(randomNumbers(kChannels * kRegions, random)),
        queries(randomNumbers(kQueries * kChannels, random)),
        factors(randomNumbers(kQueries * kChannels, random)) {}

  double loss() override {
    double sum = 0;
    for (int q = 0; q < kQueries; ++q) {
      sum += weightedSum(naiveAttentionPooling(kind, map, rowOf(queries, q)).pooled, rowOf(factors, q));
    }
    return sum;
  }

  std::vector<Checked> tensors() override {
    AttentionPooling layer(kind, kChannels, kRegions);
    const Matrix map_row = toMatrix(map, 1, kChannels * kRegions), query_rows = toMatrix(queries, kQueries, kChannels),
                 factor_rows = toMatrix(factors, kQueries, kChannels);
    Matrix weights(kQueries, kRegions), pooled(kQueries, kChannels), dqueries(kQueries, kChannels);
    Matrix dmap = Matrix::Zero(1, kChannels * kRegions);
    for (int q = 0; q < kQueries; ++q) {
      layer.forward(map_row.data(), query_rows.row(q).data(), weights.row(q).data(), pooled.row(q).data());
    }
    for (int q = 0; q < kQueries; ++q) {
      layer.backward(map_row.data(), query_rows.row(q).data(), weights.row(q).data(), factor_rows.row(q).data(),
                     dmap.data(), dqueries.row(q).data());
    }
    return {{"map", &map, fromMatrix(dmap)}, {"queries", &queries, fromMatrix(dqueries)}};
  }

  static Numbers rowOf(const Numbers& numbers, int row) {
    return Numbers(numbers.begin() + row * kChannels, numbers.begin() + (row + 1) * kChannels);
  }

  AttentionWeights kind;
  core::Random random{15};
  Numbers map, queries, factors;
};

struct Case {
  const char* name;
  std::function<std::unique_ptr<LayerCheck>()> make;
};

ConvBlockShape blockShape(int image_channels, int goal_channels, int out_channels, int size, float input_scale = 1.f,
                          bool spatial_grid = false) {
  return {image_channels, goal_channels, out_channels, size, input_scale, spatial_grid};
}

template <class Check = ConvBlockCheck>
std::function<std::unique_ptr<LayerCheck>()> convBlock(const ConvBlockShape& shape, int images) {
  return [=] { return std::make_unique<Check>(shape, images); };
}

std::function<std::unique_ptr<LayerCheck>()> attentionPooling(AttentionWeights weights) {
  return [=] { return std::make_unique<AttentionPoolingCheck>(weights); };
}

class Gradients : public testing::TestWithParam<Case> {};

TEST_P(Gradients, AreThoseOfFiniteDifferences) {
  constexpr double kStep = 1e-6;
  constexpr int kMostNumbers = 150;  // of a tensor
  const std::unique_ptr<LayerCheck> layer = GetParam().make();
  core::Random random(1);
  for (const Checked& tensor : layer->tensors()) {
    Numbers& values = *tensor.values;
    ASSERT_EQ(tensor.gradient.size(), values.size()) << tensor.name;
    const bool all = values.size() <= kMostNumbers;
    Numbers analytic, numeric;
    for (int k = 0; k < (all ? int(values.size()) : kMostNumbers); ++k) {
      const int i = all ? k : random.below(int(values.size()));
      const double kept = values[i];
      values[i] = kept + kStep;
      const double above = layer->loss();
      values[i] = kept - kStep;
      const double below = layer->loss();
      values[i] = kept;
      analytic.push_back(tensor.gradient[i]);
      numeric.push_back((above - below) / (2 * kStep));
    }
    EXPECT_LT(worstError(analytic, numeric), 2e-4) << tensor.name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Layers, Gradients,
    testing::Values(Case{"Linear", [] { return std::make_unique<LinearCheck>(); }},
                    Case{"Dropout", [] { return std::make_unique<DropoutCheck>(); }},
                    Case{"CrossEntropy", [] { return std::make_unique<CrossEntropyCheck>(); }},
                    Case{"LinearAttention", attentionPooling(AttentionWeights::kLinear)},
                    Case{"SoftmaxAttention", attentionPooling(AttentionWeights::kSoftmax)},
                    Case{"ConvBlock", convBlock(blockShape(16, 0, 16, 6), 3)},
                    Case{"ConvBlockWithGoal", convBlock(blockShape(16, 4, 16, 6), 3)},
                    Case{"ConvBlockOfTwoPixels", convBlock(blockShape(16, 4, 16, 2), 5)},
                    Case{"RenormalisedConvBlock", convBlock<RenormalisedCheck>(blockShape(16, 4, 16, 6), 3)},
                    Case{"ConvBlockOfOneImage", convBlock(blockShape(16, 3, 32, 4), 1)},
                    Case{"FirstConvBlock", convBlock(blockShape(9, 0, 16, 4, 0.25f), 2)},
                    Case{"ConvBlockWithGrid", convBlock(blockShape(9, 0, 16, 6, 0.25f, true), 3)},
                    Case{"ConvBlockWithGridOfTwoPixels", convBlock(blockShape(16, 0, 16, 2, 1.f, true), 5)},
                    Case{"ConvBlockWithGridAndGoal", convBlock(blockShape(9, 4, 16, 8, 0.25f, true), 2)},
                    Case{"FirstConvBlockWithGoal", convBlock(blockShape(9, 4, 16, 4), 2)}),
    [](const testing::TestParamInfo<Case>& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace early_fusion::nn
