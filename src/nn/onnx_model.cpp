#include "early_fusion/nn/onnx_model.h"

#include "protobuf_message.h"

namespace early_fusion::nn {

namespace {

// IR version of the release that brought the operators' version.
constexpr std::int64_t kIrVersion = 6;

// The numbers of the fields of ONNX's messages.
// Source: https://github.com/onnx/onnx/blob/main/onnx/onnx.proto
namespace model_field {
constexpr int kIrVersion = 1, kProducer = 2, kDoc = 6, kGraph = 7, kOperators = 8, kMetadata = 14;
}
namespace graph_field {
constexpr int kNode = 1, kName = 2, kConstant = 5, kDoc = 10, kInput = 11, kOutput = 12;
}
namespace node_field {
constexpr int kInput = 1, kOutput = 2, kName = 3, kOp = 4, kAttribute = 5;
}
namespace attribute_field {
constexpr int kName = 1, kFloat = 2, kInteger = 3, kIntegers = 8, kType = 20;
}
namespace tensor_field {
constexpr int kEdge = 1, kType = 2, kName = 8, kBytes = 9;
}
namespace value_field {
constexpr int kName = 1, kType = 2, kDoc = 3;
}
namespace type_field {
constexpr int kTensor = 1;
}
namespace tensor_type_field {
constexpr int kElement = 1, kShape = 2;
}
namespace shape_field {
constexpr int kDimension = 1;
}
namespace dimension_field {
constexpr int kValue = 1;
}
namespace operators_field {
constexpr int kVersion = 2;
}
namespace metadata_field {
constexpr int kKey = 1, kValue = 2;
}

// The values of AttributeProto::type.
constexpr std::int64_t kFloatAttribute = 1, kIntegerAttribute = 2, kIntegersAttribute = 7;

std::int64_t number(OnnxType type) { return static_cast<std::int64_t>(type); }

/// @param values little endian.
std::string tensor(const std::string& name, OnnxType type, const std::vector<std::int64_t>& shape, const void* values,
                   std::size_t element_size) {
  ProtobufMessage message;
  std::size_t size = element_size;
  for (std::int64_t edge : shape) {
    message.add(tensor_field::kEdge, edge);
    size *= static_cast<std::size_t>(edge);
  }
  message.add(tensor_field::kType, number(type));
  message.add(tensor_field::kName, name);
  message.add(tensor_field::kBytes, std::string(static_cast<const char*>(values), size));
  return message.bytes();
}

std::string value(const std::string& name, OnnxType type, const std::vector<std::int64_t>& shape,
                  const std::string& doc) {
  ProtobufMessage edges;
  for (std::int64_t edge : shape) {
    ProtobufMessage dimension;
    dimension.add(dimension_field::kValue, edge);
    edges.add(shape_field::kDimension, dimension);
  }
  ProtobufMessage tensor_type, any_type, message;
  tensor_type.add(tensor_type_field::kElement, number(type));
  tensor_type.add(tensor_type_field::kShape, edges);
  any_type.add(type_field::kTensor, tensor_type);
  message.add(value_field::kName, name);
  message.add(value_field::kType, any_type);
  message.add(value_field::kDoc, doc);
  return message.bytes();
}

ProtobufMessage attributeMessage(const OnnxAttribute& attribute) {
  ProtobufMessage message;
  message.add(attribute_field::kName, attribute.name);
  if (const auto* real = std::get_if<float>(&attribute.value)) {
    message.add(attribute_field::kFloat, *real);
    message.add(attribute_field::kType, kFloatAttribute);
  } else if (const auto* integer = std::get_if<std::int64_t>(&attribute.value)) {
    message.add(attribute_field::kInteger, *integer);
    message.add(attribute_field::kType, kIntegerAttribute);
  } else {
    for (std::int64_t each : std::get<std::vector<std::int64_t>>(attribute.value)) {
      message.add(attribute_field::kIntegers, each);
    }
    message.add(attribute_field::kType, kIntegersAttribute);
  }
  return message;
}

void addAll(int field, const std::vector<std::string>& messages, ProtobufMessage& to) {
  for (const std::string& message : messages) to.add(field, message);
}

}  // namespace

void OnnxModel::addInput(const std::string& name, OnnxType type, const std::vector<std::int64_t>& shape,
                         const std::string& doc) {
  inputs_.push_back(value(name, type, shape, doc));
}

void OnnxModel::addOutput(const std::string& name, OnnxType type, const std::vector<std::int64_t>& shape,
                          const std::string& doc) {
  outputs_.push_back(value(name, type, shape, doc));
}

std::string OnnxModel::addConstant(const std::string& name, const std::vector<std::int64_t>& shape,
                                   const float* values) {
  constants_.push_back(tensor(name, OnnxType::kFloat, shape, values, sizeof *values));
  return name;
}

std::string OnnxModel::addConstant(const std::string& name, const std::vector<std::int64_t>& integers) {
  const auto count = static_cast<std::int64_t>(integers.size());
  constants_.push_back(tensor(name, OnnxType::kInteger, {count}, integers.data(), sizeof(std::int64_t)));
  return name;
}

std::string OnnxModel::addNode(const std::string& op, const std::vector<std::string>& inputs, const std::string& name,
                               const std::vector<OnnxAttribute>& attributes) {
  ProtobufMessage node;
  addAll(node_field::kInput, inputs, node);
  node.add(node_field::kOutput, name);
  node.add(node_field::kName, name);
  node.add(node_field::kOp, op);
  for (const OnnxAttribute& attribute : attributes) node.add(node_field::kAttribute, attributeMessage(attribute));
  nodes_.push_back(node.bytes());
  return name;
}

std::string OnnxModel::reshape(const std::string& input, const std::vector<std::int64_t>& shape,
                               const std::string& name) {
  return addNode("Reshape", {input, addConstant(name + ".shape", shape)}, name);
}

std::string OnnxModel::transpose(const std::string& input, const std::vector<std::int64_t>& axes,
                                 const std::string& name) {
  return addNode("Transpose", {input}, name, {{"perm", axes}});
}

std::string OnnxModel::concat(const std::vector<std::string>& inputs, const std::string& name) {
  return addNode("Concat", inputs, name, {{"axis", std::int64_t{1}}});
}

std::string OnnxModel::softmax(const std::string& input, const std::string& name) {
  return addNode("Softmax", {input}, name, {{"axis", std::int64_t{1}}});
}

std::string OnnxModel::serialize(const std::string& doc, const std::map<std::string, std::string>& metadata) const {
  ProtobufMessage graph;
  addAll(graph_field::kNode, nodes_, graph);
  graph.add(graph_field::kName, std::string("policy"));
  addAll(graph_field::kConstant, constants_, graph);
  graph.add(graph_field::kDoc, doc);
  addAll(graph_field::kInput, inputs_, graph);
  addAll(graph_field::kOutput, outputs_, graph);

  ProtobufMessage model, operators;
  model.add(model_field::kIrVersion, kIrVersion);
  model.add(model_field::kProducer, std::string("early_fusion"));
  model.add(model_field::kDoc, doc);
  model.add(model_field::kGraph, graph);
  operators.add(operators_field::kVersion, kOperators);
  model.add(model_field::kOperators, operators);
  for (const auto& [key, text] : metadata) {
    ProtobufMessage entry;
    entry.add(metadata_field::kKey, key);
    entry.add(metadata_field::kValue, text);
    model.add(model_field::kMetadata, entry);
  }
  return model.bytes();
}

}  // namespace early_fusion::nn
