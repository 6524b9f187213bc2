// NetworkPolicy::addTo(): the network as nodes of an ONNX graph.
#include "early_fusion/model/network_policy.h"
#include "early_fusion/nn/pooling.h"
#include "early_fusion/nn/spatial_grid.h"

namespace early_fusion::model {

namespace {

using Integers = std::vector<std::int64_t>;

/// The graph of a network with its parameters as constants.
class Graph {
 public:
  Graph(nn::OnnxModel& model, const nn::Parameters& parameters) : model_(model), parameters_(parameters) {}

  std::string linear(const std::string& name, const std::string& input) {
    return model_.addNode("Gemm", {input, tensor(name + ".weight"), tensor(name + ".bias")}, name,
                          {{"transB", std::int64_t{1}}});
  }

  /// Batch norm has a node of its own: it follows ReLU, and a convolution with zero padding follows it, so it cannot be
  /// folded into either.
  std::string block(const std::string& name, const std::string& input) {
    const std::string convolved =
        model_.addNode("Conv", {input, tensor(name + ".conv.weight"), tensor(name + ".conv.bias")}, name + ".conv",
                       {{"kernel_shape", Integers{3, 3}}, {"pads", Integers{1, 1, 1, 1}}});
    const std::string pooled = model_.addNode("MaxPool", {convolved}, name + ".pool",
                                              {{"kernel_shape", Integers{2, 2}}, {"strides", Integers{2, 2}}});
    const std::string norm = name + ".norm";
    return model_.addNode("BatchNormalization",
                          {model_.addNode("Relu", {pooled}, name + ".relu"), tensor(norm + ".weight"),
                           tensor(norm + ".bias"), tensor(norm + ".running_mean"), tensor(norm + ".running_var")},
                          norm, {{"epsilon", static_cast<float>(nn::kNormEpsilon)}});
  }

  /// Appends each pixel's coordinates to the channels of a map with this edge.
  std::string withGrid(const std::string& map, int size) {
    std::vector<float> grid;
    for (int channel = 0; channel < nn::kGridChannels; ++channel) {
      for (int pixel = 0; pixel < size * size; ++pixel) {
        grid.push_back(nn::gridCoordinate(channel == 0 ? pixel % size : pixel / size, size));
      }
    }
    const std::string name = model_.addConstant("spatial_grid", {1, nn::kGridChannels, size, size}, grid.data());
    return model_.concat({map, name}, "with_grid");
  }

  /// Appends the goal, tiled over a map with this edge, to the map's channels.
  std::string withGoal(const std::string& map, const std::string& goal, int channels, int size) {
    const std::string pixel = model_.reshape(goal, {1, channels, 1, 1}, "goal_pixel");
    const std::string shape = model_.addConstant("tiled_goal.shape", {1, channels, size, size});
    const std::string tiled = model_.addNode("Expand", {pixel, shape}, "tiled_goal");
    return model_.concat({map, tiled}, "with_goal");
  }

 private:
  /// @param name of a parameter or of a running statistic.
  std::string tensor(const std::string& name) {
    addConstant(name, parameters_.parameterSlices(), parameters_.values());
    addConstant(name, parameters_.bufferSlices(), parameters_.buffers());
    return name;
  }

  void addConstant(const std::string& name, const std::vector<nn::TensorSlice>& slices, const Eigen::VectorXf& values) {
    for (const nn::TensorSlice& slice : slices) {
      if (slice.name == name) model_.addConstant(name, slice.shape, values.data() + slice.offset);
    }
  }

  nn::OnnxModel& model_;
  const nn::Parameters& parameters_;
};

}  // namespace

std::string NetworkPolicy::addTo(nn::OnnxModel& model, const std::string& frame_stack,
                                 const std::string& counts) const {
  const VisionTrunkShape& shape = trunk().shape();
  Graph graph(model, parameters_);
  const std::string goal = graph.linear("embedding", counts);
  std::string map = shape.spatial_grid ? graph.withGrid(frame_stack, shape.image_size) : frame_stack;
  for (int b = 0; b < kBlocks; ++b) {
    if (shape.fusion && shape.fusion->block == b) {
      map = graph.withGoal(map, goal, shape.fusion->goal_channels, shape.image_size >> b);
    }
    map = graph.block("block" + std::to_string(b + 1), map);
  }
  const std::string hidden = graph.linear("hidden", addFeaturesTo(model, map, goal));
  const std::string logits = graph.linear("output", model.addNode("Relu", {hidden}, "hidden.relu"));
  return model.softmax(logits, "probabilities");
}

}  // namespace early_fusion::model
