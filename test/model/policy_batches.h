#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "early_fusion/core/random.h"
#include "early_fusion/core/vocabulary.h"
#include "early_fusion/model/sample.h"

namespace early_fusion::model {

inline core::Vocabulary testVocabulary(int items) {
  std::vector<std::string> names;
  for (int i = 0; i < items; ++i) names.push_back("item_" + std::to_string(i));
  return core::Vocabulary(names);
}

/// Samples with the frames and requests that they point to: smooth noise, some black frames, requests of zero to three
/// items of which one may stand twice, soft targets, unlikely actions and unequal weights.
struct TestBatch {
  TestBatch(int count, int image_size, int items, std::uint64_t seed) : frames(count + 2), requests(count) {
    core::Random random(seed, {77});
    for (std::vector<std::uint8_t>& frame : frames) {
      frame.resize(3u * image_size * image_size);
      const int base = random.below(156);
      for (std::uint8_t& byte : frame) byte = static_cast<std::uint8_t>(base + random.below(100));
    }
    for (int i = 0; i < count; ++i) {
      for (int k = random.below(4); k > 0; --k) requests[i].push_back(random.below(items));
      if (i % 3 == 1 && !requests[i].empty()) requests[i].push_back(requests[i][0]);
      Sample sample;
      for (int k = 0; k < core::kStackedFrames; ++k) sample.observation.frames[k] = frames[i + k].data();
      if (i % 4 == 3) sample.observation.frames[2] = nullptr;
      if (i % 4 == 2) sample.observation.frames[1] = sample.observation.frames[2] = nullptr;
      sample.observation.request = &requests[i];
      sample.weight = static_cast<float>(0.5 + random.uniform());
      const int first = random.below(core::kActionCount), second = random.below(core::kActionCount);
      sample.target[first] += 0.75f;
      sample.target[second] += 0.25f;
      const int unlikely = (std::max(first, second) + 1) % core::kActionCount;
      if (i % 2 == 0 && sample.target[unlikely] == 0) sample.unlikelihood[unlikely] = 0.5f;
      samples.push_back(sample);
    }
  }

  std::vector<Observation> observations() const {
    std::vector<Observation> all;
    for (const Sample& sample : samples) all.push_back(sample.observation);
    return all;
  }

  std::vector<std::vector<std::uint8_t>> frames;
  std::vector<core::Request> requests;
  std::vector<Sample> samples;
};

/// Every frame stack of the batch with `requests` requests of the batch, side by side.
inline std::vector<Sample> withRequests(const TestBatch& batch, int requests) {
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < batch.samples.size(); ++i) {
    for (int k = 0; k < requests; ++k) {
      Sample sample = batch.samples[(i + 2 * k) % batch.samples.size()];
      sample.observation.frames = batch.samples[i].observation.frames;
      samples.push_back(sample);
    }
  }
  return samples;
}

}  // namespace early_fusion::model
