#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace early_fusion::nn {

/// The types of a tensor's elements, by their numbers in ONNX.
enum class OnnxType { kFloat = 1, kByte = 2, kInteger = 7 };

struct OnnxAttribute {
  std::string name;
  std::variant<std::int64_t, float, std::vector<std::int64_t>> value;
};

/// A network in the ONNX format (https://onnx.ai/onnx/repo-docs/IR.html), which other runtimes read. Inputs, constants
/// and the outputs of nodes are values with a name each. Nodes must be added in the order of their computation.
class OnnxModel {
 public:
  /// The version of the operators, from 2019: OpenCV reads no operators of much later versions.
  static constexpr std::int64_t kOperators = 11;

  void addInput(const std::string& name, OnnxType type, const std::vector<std::int64_t>& shape, const std::string& doc);
  void addOutput(const std::string& name, OnnxType type, const std::vector<std::int64_t>& shape,
                 const std::string& doc);

  /// Adds a float tensor, row-major, with a copy of `values`. @return `name`.
  std::string addConstant(const std::string& name, const std::vector<std::int64_t>& shape, const float* values);
  /// Adds a vector. @return `name`.
  std::string addConstant(const std::string& name, const std::vector<std::int64_t>& integers);

  /// Adds a node. @param op "Conv", ... @param name of the node and of its output. @return `name`.
  std::string addNode(const std::string& op, const std::vector<std::string>& inputs, const std::string& name,
                      const std::vector<OnnxAttribute>& attributes = {});

  // Nodes that several layers need. Each is an addNode().
  std::string reshape(const std::string& input, const std::vector<std::int64_t>& shape, const std::string& name);
  std::string transpose(const std::string& input, const std::vector<std::int64_t>& axes, const std::string& name);
  /// Joins the inputs along axis 1, that of the channels.
  std::string concat(const std::vector<std::string>& inputs, const std::string& name);
  /// Of (1,n), over n.
  std::string softmax(const std::string& input, const std::string& name);

  /// The file's bytes. @param doc describes the network. @param metadata texts by their keys. All texts are UTF-8.
  std::string serialize(const std::string& doc, const std::map<std::string, std::string>& metadata) const;

 private:
  // Protobuf messages.
  std::vector<std::string> nodes_, constants_, inputs_, outputs_;
};

}  // namespace early_fusion::nn
