#include "early_fusion/model/goal_policy.h"

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "early_fusion/core/error.h"
#include "early_fusion/core/image_size.h"
#include "early_fusion/model/early_fusion.h"

namespace early_fusion::model {

namespace {

constexpr const char* kFormat = "early_fusion/2";
constexpr int kWidestRegister = 16;  // channels come in multiples of it

void validate(PolicyOptions options, const core::Vocabulary& vocabulary) {
  options.options().validate("policy");
  if (vocabulary.size() == 0) throw core::Error("policy: the vocabulary is empty; it needs at least one item");
}

bool usesBfloat16(const std::string& precision) {
  return precision == "bf16" || (precision == "auto" && nn::processorHasBfloat16());
}

std::string join(const std::vector<std::int64_t>& shape) {
  std::string text;
  for (std::int64_t edge : shape) text += (text.empty() ? "" : ",") + std::to_string(edge);
  return "(" + text + ")";
}

core::Vocabulary vocabularyFromText(const std::string& text, const std::string& source) {
  std::vector<std::string> names;
  try {
    names = nlohmann::json::parse(text).get<std::vector<std::string>>();
  } catch (const nlohmann::json::exception&) {
    throw core::Error(source + ": metadata 'vocabulary' is not a JSON list of item names: " + text);
  }
  try {
    return core::Vocabulary(names);
  } catch (const core::Error& error) {
    throw core::Error(source + ": metadata 'vocabulary': " + error.what());
  }
}

/// The options that savePolicy() writes; how to compute is not among them.
PolicyOptions optionsFromFile(const nn::WeightsFile& file, const std::string& source) {
  const std::string& format = file.meta("format", source);
  if (format != kFormat) {
    throw core::Error(source + ": metadata 'format' is '" + format + "'; this version reads '" + kFormat + "'");
  }
  PolicyOptions options;
  core::OptionSet set = options.options();
  for (const char* key : {"kind", "channels", "fusion_block", "dropout", "image_size"}) {
    set.set(key, file.meta(key, source), source + ": metadata");
  }
  return options;
}

void loadTensors(const nn::WeightsFile& file, const std::string& source, const std::vector<nn::TensorSlice>& slices,
                 Eigen::VectorXf& values) {
  for (const nn::TensorSlice& slice : slices) {
    const std::string where = source + ": tensor '" + slice.name + "'";
    const auto found = file.tensors.find(slice.name);
    if (found == file.tensors.end()) {
      throw core::Error(where + " is missing; the policy needs it with shape " + join(slice.shape));
    }
    const nn::StoredTensor& tensor = found->second;
    if (tensor.dtype != "F32") throw core::Error(where + " has type " + tensor.dtype + "; it must be F32");
    if (tensor.shape != slice.shape || tensor.bytes.size() != slice.size * sizeof(float)) {
      throw core::Error(where + " has shape " + join(tensor.shape) + "; by the file's metadata it must be " +
                        join(slice.shape));
    }
    float* to = values.data() + slice.offset;
    std::memcpy(to, tensor.bytes.data(), tensor.bytes.size());
    for (std::size_t i = 0; i < slice.size; ++i) {
      if (!std::isfinite(to[i])) {
        throw core::Error(where + " holds " + std::to_string(to[i]) + " at index " + std::to_string(i) +
                          "; weights must be finite: the training that wrote them has diverged");
      }
    }
  }
}

/// A variance below 0 would make NaNs of every image.
void checkVariances(const nn::Parameters& parameters, const std::string& source) {
  for (const nn::TensorSlice& slice : parameters.bufferSlices()) {
    if (slice.name.find("running_var") == std::string::npos) continue;
    const float least = parameters.buffers().segment(slice.offset, slice.size).minCoeff();
    if (least < 0) {
      throw core::Error(source + ": tensor '" + slice.name + "' holds " + std::to_string(least) +
                        "; a variance must be at least 0");
    }
  }
}

void storeTensors(const std::vector<nn::TensorSlice>& slices, const Eigen::VectorXf& values, nn::WeightsFile& file) {
  for (const nn::TensorSlice& slice : slices) {
    const char* bytes = reinterpret_cast<const char*>(values.data() + slice.offset);
    file.tensors[slice.name] = {"F32", slice.shape, std::string(bytes, slice.size * sizeof(float))};
  }
}

}  // namespace

core::OptionSet PolicyOptions::options() {
  core::OptionSet set("policy");
  set.addChoice("kind", kind, {"early_fusion"}, "How the goal reaches the network");
  set.addMultiple("channels", channels, kWidestRegister, 16, 256, "",
                  "Channels of every block, of the hidden layer and of the goal's embedding");
  set.add("fusion_block", fusion_block, 0, kBlocks - 1, "",
          "The block whose output the goal is joined to; 0 joins it to the image itself");
  set.add("dropout", dropout, 0.0, 0.95, "", "Share of the hidden layer's units that are dropped in training");
  core::addImageSize(set, "image_size", image_size, "Edge of the square frames that the policy sees");
  set.addChoice("precision", precision, precisionNames(),
                "What convolutions compute in; auto is bf16 where the processor has it natively");
  return set;
}

std::unique_ptr<GoalPolicy> makePolicy(const PolicyOptions& options, const core::Vocabulary& vocabulary,
                                       std::uint64_t seed) {
  validate(options, vocabulary);
  if (usesBfloat16(options.precision)) {
    return std::make_unique<EarlyFusion<nn::bfloat16>>(options, vocabulary, seed);
  }
  return std::make_unique<EarlyFusion<float>>(options, vocabulary, seed);
}

std::unique_ptr<GoalPolicy> loadPolicy(const nn::WeightsFile& file, const std::string& source,
                                       const std::string& precision) {
  PolicyOptions options = optionsFromFile(file, source);
  if (!precision.empty()) options.precision = precision;
  const core::Vocabulary vocabulary = vocabularyFromText(file.meta("vocabulary", source), source);
  std::unique_ptr<GoalPolicy> policy;
  try {
    policy = makePolicy(options, vocabulary, 0);
  } catch (const core::Error& error) {
    throw core::Error(source + ": " + error.what());
  }
  nn::Parameters& parameters = policy->parameters();
  loadTensors(file, source, parameters.parameterSlices(), parameters.values());
  loadTensors(file, source, parameters.bufferSlices(), parameters.buffers());
  checkVariances(parameters, source);
  policy->parametersChanged();
  return policy;
}

nn::WeightsFile savePolicy(const GoalPolicy& policy, const std::vector<std::pair<std::string, std::string>>& extra) {
  nn::WeightsFile file;
  for (const auto& [key, value] : extra) file.metadata[key] = value;
  PolicyOptions options = policy.options();
  const core::OptionSet set = options.options();
  for (const core::Option& option : set.options()) {
    if (option.name != "precision") file.metadata[option.name] = option.get();
  }
  file.metadata["format"] = kFormat;
  file.metadata["vocabulary"] = nlohmann::json(policy.vocabulary().names()).dump();
  const nn::Parameters& parameters = policy.parameters();
  storeTensors(parameters.parameterSlices(), parameters.values(), file);
  storeTensors(parameters.bufferSlices(), parameters.buffers(), file);
  return file;
}

}  // namespace early_fusion::model
