#pragma once

#include "early_fusion/nn/lanes.h"

namespace early_fusion::nn {

/// start + sum_i x_i y_i. The order of the additions is fixed, so the bits do not depend on the vectors' alignment.
inline float dot(const float* x, const float* y, int count, float start = 0.f) {
  float lanes[kLanes] = {};
  int i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    for (int lane = 0; lane < kLanes; ++lane) lanes[lane] += x[i + lane] * y[i + lane];
  }
  float sum = start;
  for (; i < count; ++i) sum += x[i] * y[i];
  for (int lane = 0; lane < kLanes; ++lane) sum += lanes[lane];
  return sum;
}

}  // namespace early_fusion::nn
