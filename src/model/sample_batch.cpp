#include "early_fusion/model/sample_batch.h"

#include <cmath>
#include <string>

#include "early_fusion/core/error.h"
#include "early_fusion/model/request_encoder.h"

namespace early_fusion::model {

void SampleBatch::reserve(int rows) {
  if (counts_.rows() >= rows) return;
  counts_.resize(rows, items_);
  targets_.resize(rows, core::kActionCount);
  unlikelihoods_.resize(rows, core::kActionCount);
  weights_.resize(rows);
}

void SampleBatch::addFrames(const core::FrameStack& frames, int row) {
  if (!frame_stacks_.frame_stacks.empty() && frame_stacks_.frame_stacks.back() == frames) return;
  frame_stacks_.frame_stacks.push_back(frames);
  frame_stacks_.first_goal.push_back(row);
}

void SampleBatch::assign(const std::vector<Sample>& samples) {
  if (samples.empty()) throw core::Error("a training step needs at least one sample");
  rows_ = static_cast<int>(samples.size());
  reserve(rows_);
  frame_stacks_.frame_stacks.clear();
  frame_stacks_.first_goal.clear();
  double weight_sum = 0;
  for (int i = 0; i < rows_; ++i) {
    const Sample& sample = samples[i];
    countItems(sample.observation, i, items_, counts_.row(i).data());
    if (!std::isfinite(sample.weight) || sample.weight < 0) {
      throw core::Error("sample " + std::to_string(i) + " has weight " + std::to_string(sample.weight) +
                        "; a weight must be a finite number of at least 0");
    }
    addFrames(sample.observation.frames, i);
    for (int k = 0; k < core::kActionCount; ++k) {
      targets_(i, k) = sample.target[k];
      unlikelihoods_(i, k) = sample.unlikelihood[k];
    }
    weights_[i] = sample.weight;
    weight_sum += sample.weight;
  }
  frame_stacks_.first_goal.push_back(rows_);
  if (weight_sum <= 0) throw core::Error("all samples of a training step have weight 0; one must have a positive one");
}

}  // namespace early_fusion::model
