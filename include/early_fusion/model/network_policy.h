#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "early_fusion/model/policy_head.h"
#include "early_fusion/model/request_encoder.h"
#include "early_fusion/model/sample_batch.h"
#include "early_fusion/model/trainable_policy.h"
#include "early_fusion/model/vision_trunk.h"

namespace early_fusion::model {

/// The base class of all kinds. The trunk computes maps from frame stacks, the encoder computes goals from requests,
/// and the head computes actions from features. A kind defines how features are computed from maps and goals. It has no
/// parameters of its own.
///
/// Parameters: block1 to block4 (conv, norm), embedding, hidden, output.
class NetworkPolicy : public TrainablePolicy {
 public:
  const PolicyOptions& options() const override { return options_; }
  const core::Vocabulary& vocabulary() const override { return vocabulary_; }
  nn::Parameters& parameters() override { return parameters_; }
  const nn::Parameters& parameters() const override { return parameters_; }
  void parametersChanged() override;
  void setNormalisation(nn::Normalisation normalisation) override { trunk_->setNormalisation(normalisation); }
  void predict(const std::vector<Observation>& observations, Probabilities& probabilities) override;
  double lossAndGradients(const std::vector<Sample>& samples, std::uint64_t dropout_seed) override;
  int featureCount() const override { return static_cast<int>(thread_features_.cols()); }
  void predictFeatures(const std::vector<Observation>& observations, nn::Matrix& features) override;
  std::string addTo(nn::OnnxModel& model, const std::string& frame_stack, const std::string& counts) const override;

 protected:
  /// @param feature_count the number of inputs of the head.
  NetworkPolicy(const PolicyOptions& options, const core::Vocabulary& vocabulary, std::uint64_t seed,
                const VisionTrunkShape& trunk_shape, int feature_count);

  VisionTrunk& trunk() { return *trunk_; }
  const VisionTrunk& trunk() const { return *trunk_; }
  int threads() const { return threads_; }

  /// predictRow() of the observation, for what a kind keeps of it.
  void predictFeatures(const Observation& observation);

  /// Makes room for rows. The matrix may lose what it held.
  static void reserveRows(nn::Matrix& matrix, int rows, int columns) {
    if (matrix.rows() < rows) matrix.resize(rows, columns);
  }

 private:
  /// Training: goals (goalCount(), channels) -> features (goalCount(), feature_count).
  virtual void forward(const FrameStackBatch& batch, const nn::Matrix& goals, nn::Matrix& features) = 0;

  /// Backward of the last forward(): the same batch and goals, dfeatures -> the gradients of the trunk's parameters,
  /// and dgoals.
  virtual void backward(const FrameStackBatch& batch, const nn::Matrix& goals, const nn::Matrix& dfeatures,
                        nn::Matrix& dgoals) = 0;

  /// Inference of one observation: goal (channels) -> features (feature_count). @param thread as
  /// VisionTrunk::predict().
  virtual void predictRow(int thread, const core::FrameStack& frames, const float* goal, float* features) = 0;

  /// predictRow() as nodes of an ONNX graph. @param map names the trunk's output (1,C,edge,edge).
  /// @param goal names (1,channels). @return the name of the features (1,feature_count).
  virtual std::string addFeaturesTo(nn::OnnxModel& model, const std::string& map, const std::string& goal) const = 0;

  void refreshWeights();
  void refreshInference();
  void reserve(int rows);
  void reservePrediction(int rows);
  void predictFeatures(int row, const Observation& observation, int thread, float* features);
  /// Computes the features of each observation, in parallel. @param use (int row, const float* features), called by any
  /// thread.
  template <class Use>
  void forEachFeatures(const std::vector<Observation>& observations, const Use& use);

  PolicyOptions options_;
  core::Vocabulary vocabulary_;
  int threads_;
  int frame_thread_;  // predictRow()'s `thread` for a single observation
  nn::Parameters parameters_;
  std::unique_ptr<VisionTrunk> trunk_;
  RequestEncoder encoder_;
  PolicyHead head_;
  bool weights_stale_ = true;
  bool statistics_stale_ = true;

  // Of a training step, one row for each sample.
  SampleBatch batch_;
  nn::Matrix goals_, dgoals_, features_, dfeatures_;
  // Of inference: first one row for each observation, then one row for each thread.
  nn::Matrix predict_counts_, predict_goals_, thread_features_;
};

}  // namespace early_fusion::model
