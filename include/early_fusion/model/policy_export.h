#pragma once

#include <string>
#include <utility>
#include <vector>

#include "early_fusion/model/trainable_policy.h"
#include "early_fusion/nn/onnx_model.h"

namespace early_fusion::model {

/// A policy as the bytes of an ONNX file, for other runtimes. One run decides one step. The convolutions are in f32,
/// whatever the policy's precision is.
///
/// Inputs: "frames" (3, image_size, image_size, 3), RGB in [0, 255], the newest frame first, 0 for frames before the
/// episode; "request" (1, items), float, the number of requested instances of each item. Output: "probabilities" (1,
/// 7), float.
/// The metadata are those of savePolicy(), with `extra` merged in.
/// @param frames the type of the frames, kByte or kFloat.
std::string exportOnnx(const TrainablePolicy& policy, nn::OnnxType frames,
                       const std::vector<std::pair<std::string, std::string>>& extra);

}  // namespace early_fusion::model
