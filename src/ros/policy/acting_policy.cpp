#include "early_fusion/ros/policy/acting_policy.h"

#include <algorithm>
#include <cassert>

#include "early_fusion/model/policy_file.h"
#include "early_fusion/model/saliency.h"

namespace early_fusion::nodes {

void ActingPolicy::load(nn::WeightsFile file, const std::string& source, const Acting& acting) {
  const model::ActionChoice choice = model::actionChoiceFromName(acting.mode);
  std::unique_ptr<model::GoalPolicy> policy = model::loadPolicy(file, source, acting.precision);
  if (policy_ && policy_->options().image_size != policy->options().image_size) frames_.clear();
  file_ = std::move(file);
  policy_ = std::move(policy);
  acting_ = acting;
  choice_ = choice;
}

model::Observation ActingPolicy::observation(const core::Request& request) const {
  model::Observation observation;
  observation.request = &request;
  observation.frames = core::frameStack(frames_.size() - 1, [this](std::size_t at) { return frames_[at].rgb.data(); });
  return observation;
}

void ActingPolicy::remember(const core::Image& frame, std::uint64_t episode, std::uint32_t step) {
  const bool again = episode == episode_ && step == step_ && !frames_.empty();
  const bool follows = episode == episode_ && step == step_ + 1;
  if (again) {
    frames_.back() = frame;
  } else {
    if (!follows || step == 0) frames_.clear();
    frames_.push_back(frame);
  }
  if (frames_.size() > core::kStackedFrames) frames_.pop_front();
  episode_ = episode;
  step_ = step;
}

Decision ActingPolicy::decide(const core::Image& frame, const std::vector<std::string>& items, std::uint64_t episode,
                              std::uint32_t step) {
  assert(loaded() && frame.width == imageSize() && frame.height == imageSize());
  request_ = policy_->vocabulary().request(items);
  remember(frame, episode, step);
  policy_->predict({observation(request_)}, probabilities_);
  Decision decision;
  decision.action = model::chooseAction(probabilities_.row(0), choice_, acting_.seed, episode, step);
  decision.probabilities.assign(probabilities_.data(), probabilities_.data() + core::kActionCount);
  decision.frames = static_cast<int>(frames_.size());
  return decision;
}

LikelyItem ActingPolicy::likeliestItem(core::Action action) {
  assert(!frames_.empty() && !request_.empty());
  core::Request items = request_;
  items.erase(std::unique(items.begin(), items.end()), items.end());
  std::vector<core::Request> requests;
  for (const int item : items) requests.push_back({item});
  std::vector<model::Observation> observations;
  for (const core::Request& request : requests) observations.push_back(observation(request));
  model::Probabilities probabilities;
  policy_->predict(observations, probabilities);
  Eigen::Index likeliest;
  const float probability = probabilities.col(static_cast<int>(action)).maxCoeff(&likeliest);
  return {policy_->vocabulary().name(items[likeliest]), probability};
}

core::Image ActingPolicy::lastImageTinted(int saliency_grid) {
  assert(!frames_.empty());
  core::Image image = frames_.back();
  if (const auto attention = policy_->attention(observation(request_))) {
    model::tint(image, *attention);
  } else if (saliency_grid > 0) {
    model::tint(image, model::occlusionSaliency(*policy_, observation(request_), saliency_grid));
  }
  return image;
}

}  // namespace early_fusion::nodes
