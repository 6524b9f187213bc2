#include "early_fusion/ros/trainer/rollout_workers.h"

#include <algorithm>

#include "early_fusion/core/names.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

std::string workerNamespace(int number) { return number == 1 ? "" : "worker_" + std::to_string(number); }

RolloutWorkers::Worker::Worker(const std::string& name_space, const world::World& world, double stall_sec,
                               Health& health)
    : node(name_space),
      weights_publisher(node.advertise<Weights>(kWeightsTopic, 1, true)),
      client(node, world, stall_sec, health) {}

RolloutWorkers::RolloutWorkers(int count, const world::World& world, double stall_sec, Health& health) {
  for (int i = 1; i <= count; ++i) {
    workers_.push_back(std::make_unique<Worker>(workerNamespace(i), world, stall_sec, health));
  }
}

void RolloutWorkers::publish(const Weights& weights) {
  for (const auto& worker : workers_) worker->weights_publisher.publish(weights);
}

void RolloutWorkers::start(const RolloutPlan& plan, std::function<void(learning::Trajectory)> on_trajectory,
                           std::function<void()> on_done) {
  plan_ = plan;
  on_trajectory_ = std::move(on_trajectory);
  on_done_ = std::move(on_done);
  early_.clear();
  next_ = plan.goal.first_episode;
  playing_ = std::min<int>(workers_.size(), plan.goal.episodes);
  RolloutPlan share = plan;
  for (int i = 0; i < playing_; ++i) {
    // Whole numbers that add up to all episodes and differ by at most one.
    share.goal.episodes = (plan.goal.episodes + playing_ - 1 - i) / playing_;
    workers_[i]->client.start(
        share, [this](learning::Trajectory trajectory) { onTrajectory(std::move(trajectory)); },
        [this] {
          if (--playing_ > 0) return;
          const std::function<void()> done = std::move(on_done_);  // it may start the next plan
          done();
        });
    share.goal.first_episode += share.goal.episodes;
  }
}

void RolloutWorkers::onTrajectory(learning::Trajectory trajectory) {
  const std::uint64_t episode = trajectory.episode;
  early_.emplace(episode, std::move(trajectory));
  for (auto first = early_.begin(); first != early_.end() && first->first == next_; first = early_.begin()) {
    learning::Trajectory next = std::move(first->second);
    early_.erase(first);
    ++next_;
    on_trajectory_(std::move(next));
  }
}

double RolloutWorkers::done() const {
  if (plan_.goal.episodes == 0) return 0;
  return static_cast<double>(next_ - plan_.goal.first_episode + early_.size()) / plan_.goal.episodes;
}

std::string RolloutWorkers::waitsFor() const {
  std::vector<std::string> waits;
  for (const auto& worker : workers_) {
    if (worker->client.busy()) waits.push_back(worker->client.waitsFor());
  }
  return waits.empty() ? "nothing" : core::joined(waits);
}

}  // namespace early_fusion::nodes
