#include "early_fusion/nn/adam.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reference_layers.h"

namespace early_fusion::nn {
namespace {

/// Kingma and Ba 2015, algorithm 1, with the decoupled decay of Loshchilov and Hutter 2019; one number, in double.
struct Reference {
  double value, first = 0, second = 0;

  void step(double gradient, double rate, int t, const AdamOptions& options) {
    first = options.beta1 * first + (1 - options.beta1) * gradient;
    second = options.beta2 * second + (1 - options.beta2) * gradient * gradient;
    const double corrected1 = first / (1 - std::pow(options.beta1, t));
    const double corrected2 = second / (1 - std::pow(options.beta2, t));
    value -= rate * (corrected1 / (std::sqrt(corrected2) + options.epsilon) + options.weight_decay * value);
  }
};

Eigen::VectorXf toVector(const Numbers& numbers) {
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), numbers.size()).cast<float>();
}

TEST(Adam, IsThePapersAlgorithm) {
  constexpr int kSize = 37;
  for (double decay : {0.0, 0.1}) {
    AdamOptions options;
    options.weight_decay = decay;
    core::Random random(5);
    Eigen::VectorXf values = toVector(randomNumbers(kSize, random));
    std::vector<Reference> references;
    for (int i = 0; i < kSize; ++i) references.push_back({values[i]});
    Adam adam(kSize, options);
    for (int t = 1; t <= 200; ++t) {
      const double rate = 1e-2 / t;
      const Numbers gradients = randomNumbers(kSize, random, -1, 2);
      adam.step(values, toVector(gradients), rate);
      for (int i = 0; i < kSize; ++i) references[i].step(gradients[i], rate, t, options);
    }
    EXPECT_EQ(adam.stepCount(), 200);
    for (int i = 0; i < kSize; ++i) EXPECT_NEAR(values[i], references[i].value, 2e-6) << i;
  }
}

TEST(Adam, GoesOnFromARestoredStateBitForBit) {
  constexpr int kSize = 64;
  core::Random random(6);
  Eigen::VectorXf values = toVector(randomNumbers(kSize, random));
  Adam adam(kSize, {});
  for (int t = 0; t < 5; ++t) adam.step(values, toVector(randomNumbers(kSize, random)), 1e-3);
  Adam resumed(kSize, {});
  resumed.restore(adam.stepCount(), adam.firstMoment(), adam.secondMoment());
  Eigen::VectorXf resumed_values = values;
  const Eigen::VectorXf gradients = toVector(randomNumbers(kSize, random));
  adam.step(values, gradients, 1e-3);
  resumed.step(resumed_values, gradients, 1e-3);
  EXPECT_EQ(values, resumed_values);
}

}  // namespace
}  // namespace early_fusion::nn
