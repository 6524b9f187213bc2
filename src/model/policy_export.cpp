#include "early_fusion/model/policy_export.h"

#include "early_fusion/core/names.h"
#include "early_fusion/model/policy_file.h"
#include "early_fusion/nn/frame_stack.h"

namespace early_fusion::model {

namespace {

constexpr int kColors = 3;

/// Adds the nodes that do what nn::stackFrames() does. They are exact, also in 16 bits: all numbers are differences of
/// bytes, and a byte has no more significant bits than a float16 or bfloat16.
/// @param frames (ages, size, size, 3), floats. @return (1, kImageChannels, size, size), with the factor kByteScale.
std::string addFrameStack(nn::OnnxModel& model, const std::string& frames, int size) {
  constexpr int kChannels = nn::kImageChannels;
  std::vector<float> weights(kChannels * kChannels), bias(kChannels);
  for (int to = 0; to < kChannels; ++to) {
    const bool newest = to < kColors;
    if (!newest) weights[to * kChannels + to - kColors] = nn::kByteScale;
    weights[to * kChannels + to] = newest ? nn::kByteScale : -nn::kByteScale;
    bias[to] = newest ? -nn::kMiddleByte * nn::kByteScale : 0.f;
  }
  const std::string planes = model.transpose(frames, {0, 3, 1, 2}, "planes");
  return model.addNode("Conv",
                       {model.reshape(planes, {1, kChannels, size, size}, "image"),
                        model.addConstant("frame_stack.weight", {kChannels, kChannels, 1, 1}, weights.data()),
                        model.addConstant("frame_stack.bias", {kChannels}, bias.data())},
                       "frame_stack", {{"kernel_shape", std::vector<std::int64_t>{1, 1}}});
}

std::string actionNames() {
  std::vector<std::string> names;
  for (core::Action action : core::kAllActions) names.emplace_back(core::actionName(action));
  return core::joined(names);
}

}  // namespace

std::string exportOnnx(const TrainablePolicy& policy, nn::OnnxType frames,
                       const std::vector<std::pair<std::string, std::string>>& extra) {
  const int size = policy.options().image_size, items = policy.vocabulary().size();
  nn::OnnxModel model;
  model.addInput("frames", frames, {core::kStackedFrames, size, size, kColors},
                 "The last three frames, the newest first: (age, row, column, RGB) in [0, 255]. All 0 for a frame "
                 "before the episode. The metadata 'horizontal_fov_deg' is their field of view.");
  model.addInput("request", nn::OnnxType::kFloat, {1, items},
                 "The number of requested instances of each item: " + core::joined(policy.vocabulary().names()));
  const std::string numbers = frames == nn::OnnxType::kFloat
                                  ? "frames"
                                  : model.addNode("Cast", {"frames"}, "frames_as_floats",
                                                  {{"to", static_cast<std::int64_t>(nn::OnnxType::kFloat)}});
  const std::string probabilities = policy.addTo(model, addFrameStack(model, numbers, size), "request");
  model.addOutput(probabilities, nn::OnnxType::kFloat, {1, core::kActionCount},
                  "The probability of each action: " + actionNames());
  return model.serialize("A policy of the package early_fusion, of the kind " + policy.options().kind +
                             ". From the last three frames and a request, it chooses the next action of a pan-tilt "
                             "camera (Walsman et al., Early Fusion for Goal Directed Robotic Vision, IROS 2019).",
                         savePolicy(policy, extra).metadata);
}

}  // namespace early_fusion::model
