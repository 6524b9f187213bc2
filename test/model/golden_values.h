#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "early_fusion/nn/parameters.h"
#include "parity_case.h"

namespace early_fusion::model {

/// Values of one network by name. The first word of a name is its kind; see expectGolden().
using GoldenValues = std::map<std::string, std::vector<double>>;

constexpr char kGoldenFile[] = EARLY_FUSION_SOURCE_SHARE "/test/model/golden_parity.txt";
constexpr double kGoldenRate = 1e-3;
/// Adam divides a gradient by its size. Two implementations stay close only if epsilon is larger than rounding errors.
constexpr double kGoldenEpsilon = 1e-3;
constexpr int kGoldenSteps = 10;

/// A tensor in five numbers: size, largest absolute number, and the sums under three fixed random choices of signs. A
/// wrong number changes the sums, and so does a permutation.
inline std::vector<double> digest(const float* numbers, std::size_t size) {
  std::vector<double> result = {static_cast<double>(size), 0, 0, 0, 0};
  core::Random random(size);
  for (std::size_t i = 0; i < size; ++i) {
    const std::uint64_t signs = random.next();
    result[1] = std::max(result[1], std::abs(static_cast<double>(numbers[i])));
    for (int k = 0; k < 3; ++k) result[2 + k] += signs >> k & 1 ? numbers[i] : -static_cast<double>(numbers[i]);
  }
  return result;
}

/// The inputs on which the values of a case depend, besides the network.
inline GoldenValues goldenInputs(const nn::Parameters& first, const TestBatch& batch) {
  std::vector<float> bytes;
  for (const std::vector<std::uint8_t>& frame : batch.frames) bytes.insert(bytes.end(), frame.begin(), frame.end());
  return {{"input frames", digest(bytes.data(), bytes.size())},
          {"input parameters", digest(first.values().data(), first.values().size())},
          {"input statistics", digest(first.buffers().data(), first.buffers().size())}};
}

/// The case's section in the file.
inline std::string goldenName(const ParityCase& network) {
  return std::string(network.kind) + ", channels " + std::to_string(network.channels) + ", fusion_block " +
         std::to_string(network.fusion_block) + ", image_size " + std::to_string(network.image_size) +
         ", spatial_grid " + network.spatial_grid;
}

/// Each case has a section "[goldenName()]" with a line "name: numbers" for each value.
inline std::map<std::string, GoldenValues> readGoldenFile() {
  std::map<std::string, GoldenValues> cases;
  std::ifstream stream(kGoldenFile);
  std::string line, section;
  while (std::getline(stream, line)) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] == '[') {
      section = line.substr(1, line.size() - 2);
      continue;
    }
    const std::size_t colon = line.find(':');
    std::istringstream numbers(line.substr(colon + 1));
    for (double number; numbers >> number;) cases[section][line.substr(0, colon)].push_back(number);
  }
  return cases;
}

inline void writeGoldenCase(std::ostream& stream, const ParityCase& network, const GoldenValues& values) {
  stream << "\n[" << goldenName(network) << "]\n";
  for (const auto& [name, numbers] : values) {
    stream << name << ":";
    for (double number : numbers) {
      char text[32];
      std::snprintf(text, sizeof text, " %.8g", number);
      stream << text;
    }
    stream << "\n";
  }
}

/// The allowed error of a gradient, as a share of its largest number. Rounding decides which of two nearly equal
/// numbers is the maximum that pooling takes, and each processor rounds differently. Such a change moves a pixel's
/// gradient to its neighbour. With the same maxima the error is below 2e-4.
constexpr double kGradientTolerance = 2e-2;

/// The allowed error of the loss of a step, for the same reason and because rounding errors grow from step to step.
inline double lossTolerance(std::size_t step) { return 5e-6 + 1e-3 * static_cast<double>(step); }

/// The allowed error of a value: absolute for probabilities and losses, a share of the tensor's largest number for a
/// digest.
inline double goldenTolerance(const std::string& name, std::size_t index) {
  if (name == "probabilities") return 1e-5;
  if (name == "loss") return lossTolerance(0);
  if (name == "losses") return lossTolerance(index);
  if (name.rfind("gradient ", 0) == 0) return kGradientTolerance;
  if (name.rfind("statistic ", 0) == 0) return 1e-5;
  if (name.rfind("moved ", 0) == 0) return 0.05;  // after ten steps
  return 1e-7;                                    // inputs, which are the same bits but for the file's eight digits
}

/// Fails for every number of `values` that differs from the stored one, and if one of the two has more values.
inline void expectGolden(const GoldenValues& values, const GoldenValues& golden) {
  EXPECT_EQ(values.size(), golden.size());
  for (const auto& [name, expected] : golden) {
    const auto found = values.find(name);
    ASSERT_NE(found, values.end()) << "there is no " << name;
    ASSERT_EQ(found->second.size(), expected.size()) << name;
    const bool is_digest = name.find(' ') != std::string::npos;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      double tolerance = goldenTolerance(name, i);
      if (is_digest) {
        tolerance = i == 0 ? 0 : tolerance * expected[1] + 1e-7;
        if (i > 1) tolerance *= std::sqrt(expected[0]);  // errors of random sign
      }
      EXPECT_NEAR(found->second[i], expected[i], tolerance) << name << ", number " << i;
    }
  }
}

}  // namespace early_fusion::model
