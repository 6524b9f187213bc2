#include "early_fusion/model/request_encoder.h"

#include <algorithm>
#include <string>

#include "early_fusion/core/error.h"

namespace early_fusion::model {

void countItems(const Observation& observation, std::size_t index, int items, float* counts) {
  const std::string where = "observation " + std::to_string(index);
  if (observation.request == nullptr)
    throw core::Error(where + " has no request; use an empty request to request nothing");
  std::fill(counts, counts + items, 0.f);
  for (int item : *observation.request) {
    if (item < 0 || item >= items) {
      throw core::Error(where + " requests item " + std::to_string(item) + "; the policy knows items 0 to " +
                        std::to_string(items - 1));
    }
    counts[item] += 1.f;
  }
}

}  // namespace early_fusion::model
