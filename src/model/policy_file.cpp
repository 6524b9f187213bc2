#include "early_fusion/model/policy_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/model/policy_kinds.h"

namespace early_fusion::model {

namespace {

constexpr char kFormat[] = "early_fusion/3";
constexpr char kFieldOfView[] = "horizontal_fov_deg";

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
    throw core::Error(source + ": metadata 'vocabulary' is not a JSON list of item names: " + core::excerpt(text));
  }
  try {
    return core::Vocabulary(names);
  } catch (const core::Error& error) {
    throw core::Error(source + ": metadata 'vocabulary': " + error.what());
  }
}

/// A JSON list, in the order of the network's outputs.
std::string actionsText() {
  nlohmann::json names;
  for (core::Action action : core::kAllActions) names.push_back(core::actionName(action));
  return names.dump();
}

/// The policy options that are metadata keys. Options of the computation, such as precision, are not stored.
std::vector<std::string> storedOptions(const PolicyKind& kind) {
  std::vector<std::string> keys = kind.options;
  keys.insert(keys.begin(), "kind");
  keys.emplace_back(kFieldOfView);
  return keys;
}

/// The options that a file may have: those of PolicyOptions, and the field of view.
core::OptionSet fileOptions(PolicyOptions& options) {
  core::OptionSet set = options.options();
  set.add(kFieldOfView, options.horizontal_fov_deg, 1.0, 179.0, "degrees", "horizontal field of view of the frames");
  return set;
}

void checkMetadata(const nn::WeightsFile& file, const std::string& source) {
  const std::string& format = file.meta("format", source);
  if (format != kFormat) {
    throw core::Error(source + ": metadata 'format' is '" + core::excerpt(format) + "'; this version reads '" +
                      kFormat + "'");
  }
  const std::string& actions = file.meta("actions", source);
  const bool same = nlohmann::json::parse(actions, nullptr, false) == nlohmann::json::parse(actionsText());
  if (!same) {  // nlohmann's != is false, too, for a text that is not JSON
    throw core::Error(source + ": metadata 'actions' is " + core::excerpt(actions) + "; this version has " +
                      actionsText() + ", in this order");
  }
  if (file.metadata.count(kFieldOfView) == 0) {
    throw core::Error(source + ": metadata '" + kFieldOfView +
                      "' is missing; it is the horizontal field of view [degrees] of the training frames, and a "
                      "camera's images are cropped to it");
  }
}

PolicyOptions optionsFromFile(const nn::WeightsFile& file, const std::string& source) {
  checkMetadata(file, source);
  PolicyOptions options;
  core::OptionSet set = fileOptions(options);
  set.set("kind", file.meta("kind", source), source + ": metadata");
  for (const std::string& key : storedOptions(policyKind(options.kind))) {
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
      throw core::Error(where + " has shape " + core::excerpt(join(tensor.shape)) +
                        "; by the file's metadata it must be " + join(slice.shape));
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

/// A variance below 0 would turn every output into NaN.
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

std::unique_ptr<TrainablePolicy> loadPolicy(const nn::WeightsFile& file, const std::string& source,
                                            const std::string& precision) {
  PolicyOptions options = optionsFromFile(file, source);
  if (!precision.empty()) options.precision = precision;
  const core::Vocabulary vocabulary = vocabularyFromText(file.meta("vocabulary", source), source);
  std::unique_ptr<TrainablePolicy> policy;
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

nn::WeightsFile savePolicy(const TrainablePolicy& policy,
                           const std::vector<std::pair<std::string, std::string>>& extra) {
  nn::WeightsFile file;
  for (const auto& [key, value] : extra) file.metadata[key] = value;
  PolicyOptions options = policy.options();
  const std::vector<std::string> stored = storedOptions(policyKind(options.kind));
  const core::OptionSet set = fileOptions(options);
  for (const core::Option& option : set.options()) {
    const bool needed = std::find(stored.begin(), stored.end(), option.name) != stored.end();
    if (needed) file.metadata[option.name] = option.get();
  }
  file.metadata["format"] = kFormat;
  file.metadata["actions"] = actionsText();
  file.metadata["vocabulary"] = nlohmann::json(policy.vocabulary().names()).dump();
  const nn::Parameters& parameters = policy.parameters();
  storeTensors(parameters.parameterSlices(), parameters.values(), file);
  storeTensors(parameters.bufferSlices(), parameters.buffers(), file);
  return file;
}

}  // namespace early_fusion::model
