#include "early_fusion/nn/adam.h"

#include <cassert>
#include <cmath>

namespace early_fusion::nn {

Adam::Adam(Eigen::Index size, const AdamOptions& options)
    : options_(options), first_moment_(Eigen::VectorXf::Zero(size)), second_moment_(Eigen::VectorXf::Zero(size)) {}

void Adam::step(Eigen::VectorXf& values, const Eigen::VectorXf& gradients, double learning_rate) {
  assert(values.size() == first_moment_.size() && gradients.size() == first_moment_.size());
  ++step_count_;
  const double correction1 = 1.0 - std::pow(options_.beta1, static_cast<double>(step_count_));
  const double correction2 = 1.0 - std::pow(options_.beta2, static_cast<double>(step_count_));
  // 1 - beta is computed in double. From float(beta) its relative error would be 3e-5 at beta2 = 0.999.
  const float beta1 = static_cast<float>(options_.beta1);
  const float beta2 = static_cast<float>(options_.beta2);
  const float rest1 = static_cast<float>(1.0 - options_.beta1);
  const float rest2 = static_cast<float>(1.0 - options_.beta2);
  const float decay = static_cast<float>(1.0 - learning_rate * options_.weight_decay);
  const float step_size = static_cast<float>(learning_rate / correction1);
  const float root_correction = static_cast<float>(std::sqrt(correction2));
  const float epsilon = static_cast<float>(options_.epsilon);

  first_moment_.array() = beta1 * first_moment_.array() + rest1 * gradients.array();
  second_moment_.array() = beta2 * second_moment_.array() + rest2 * gradients.array().square();
  values.array() = decay * values.array() -
                   step_size * first_moment_.array() / (second_moment_.array().sqrt() / root_correction + epsilon);
}

void Adam::restore(std::int64_t step_count, const Eigen::VectorXf& first_moment, const Eigen::VectorXf& second_moment) {
  assert(first_moment.size() == first_moment_.size() && second_moment.size() == second_moment_.size());
  step_count_ = step_count;
  first_moment_ = first_moment;
  second_moment_ = second_moment;
}

}  // namespace early_fusion::nn
