#include "early_fusion/sim/episode.h"

#include <algorithm>
#include <cassert>

namespace early_fusion::sim {

namespace {

InstanceMask allOf(std::size_t count) { return count >= 32 ? ~InstanceMask{0} : (InstanceMask{1} << count) - 1; }

}  // namespace

Episode::Episode(const world::World& world, const Task& task, EpisodeSetup setup)
    : setup_(std::move(setup)),
      cone_(std::make_shared<ConeTable>(world, setup_.instances)),
      held_out_pairs_(world.objects.size(), task.pair_split),
      steps_(task.steps),
      outstanding_(setup_.request),
      requested_(static_cast<int>(setup_.request.size())) {
  state_.orientation = setup_.orientation;
  state_.present = allOf(setup_.instances.size());
  updateRequest();
}

void Episode::step(core::Action action) {
  assert(!finished());
  if (core::picks(action)) {
    const int instance = cone_->nearest(state_.orientation, state_.present);
    if (instance >= 0) take(instance, action == core::Action::kCollect);
  }
  const world::Orientation moved = world::turned(state_.orientation, action);
  if (cone_->lattice().contains(moved)) state_.orientation = moved;
  ++state_.step;
}

void Episode::take(int instance, bool collect) {
  state_.present &= ~(InstanceMask{1} << instance);
  if (collect) {
    ++collected_;
    const auto wanted = std::find(outstanding_.begin(), outstanding_.end(), setup_.instances[instance].item);
    if (wanted != outstanding_.end()) {
      ++collected_requested_;
      outstanding_.erase(wanted);
    }
  }
  updateRequest();
}

void Episode::updateRequest() {
  core::Request left;  // in the scene
  for (std::size_t i = 0; i < setup_.instances.size(); ++i) {
    if ((state_.present >> i) & 1u) left.push_back(setup_.instances[i].item);
  }
  state_.request.clear();
  for (int item : outstanding_) {
    if (core::countOf(state_.request, item) < core::countOf(left, item)) state_.request.push_back(item);
  }
}

void Episode::setRequest(const core::Request& request) {
  outstanding_ = request;
  std::sort(outstanding_.begin(), outstanding_.end());
  updateRequest();
  outstanding_ = state_.request;
  requested_ = collected_requested_ + static_cast<int>(outstanding_.size());
}

Score Episode::score() const {
  Score score;
  if (collected_ > 0) score.precision = static_cast<double>(collected_requested_) / collected_;
  if (requested_ > 0) score.recall = static_cast<double>(collected_requested_) / requested_;
  if (collected_requested_ > 0) score.f1 = 2 * score.precision * score.recall / (score.precision + score.recall);
  return score;
}

}  // namespace early_fusion::sim
