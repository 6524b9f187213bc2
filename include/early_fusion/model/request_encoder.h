#pragma once

#include <cstddef>

#include "early_fusion/core/random.h"
#include "early_fusion/model/observation.h"
#include "early_fusion/nn/linear.h"

namespace early_fusion::model {

/// Writes the number of requested instances of each item to counts (items).
/// @param index the observation's index, for errors. @throws Error if it has no request or requests an unknown item.
void countItems(const Observation& observation, std::size_t index, int items, float* counts);

/// Embeds a request as a goal vector: a linear layer over the items' counts (Walsman et al. 2019, sec. III-C).
class RequestEncoder {
 public:
  /// Adds "embedding.weight" and "embedding.bias" to `parameters`, which must outlive the encoder.
  RequestEncoder(nn::Parameters& parameters, int items, int channels, int threads)
      : embedding_(parameters, "embedding", items, channels, threads) {}

  void initialise(core::Random& random) { embedding_.initialise(random); }

  /// counts (rows, items) -> goals (rows, channels).
  void forward(const nn::Matrix& counts, int rows, nn::Matrix& goals) const { embedding_.forward(counts, rows, goals); }

  /// dgoals (rows, channels) -> the parameters' gradients.
  void backward(const nn::Matrix& counts, const nn::Matrix& dgoals, int rows) {
    embedding_.backward(counts, dgoals, rows, nullptr);
  }

  /// One row, counts (items) -> goal (channels). The bits do not depend on the calling thread.
  void predict(const float* counts, float* goal) const { embedding_.forwardRow(counts, goal); }

 private:
  nn::Linear embedding_;
};

}  // namespace early_fusion::model
