#include "early_fusion/learning/training_window.h"

#include <numeric>

#include "early_fusion/core/frame_stack.h"

namespace early_fusion::learning {

namespace {

std::int64_t checksum(const Trajectory& trajectory) {
  const std::vector<std::uint8_t>& frame = *trajectory.steps.front().frame;
  auto sum = std::accumulate(frame.begin(), frame.end(), std::uint64_t{0});
  for (const TrajectoryStep& step : trajectory.steps) {
    sum = 31 * (31 * sum + static_cast<std::uint64_t>(step.label.action)) +
          static_cast<std::uint64_t>(step.nearest_item + 1);
  }
  return static_cast<std::int64_t>(sum);
}

std::size_t frameBytesOf(const Trajectory& trajectory) {
  std::size_t bytes = 0;
  for (const TrajectoryStep& step : trajectory.steps) bytes += step.is_new_frame ? step.frame->size() : 0;
  return bytes;
}

}  // namespace

TrainingWindow::TrainingWindow(int max_trajectories, std::size_t max_frame_bytes, Redraw redraw)
    : max_trajectories_(max_trajectories), max_frame_bytes_(max_frame_bytes), redraw_(std::move(redraw)) {}

void TrainingWindow::add(Trajectory trajectory) {
  dropLoaded();
  checksums_.push_back(checksum(trajectory));
  frame_bytes_ += frameBytesOf(trajectory);
  trajectories_.push_back(std::move(trajectory));
  if (max_trajectories_ > 0 && trajectories_.size() > static_cast<std::size_t>(max_trajectories_)) {
    if (without_frames_ > 0) {
      --without_frames_;
    } else {
      frame_bytes_ -= frameBytesOf(trajectories_.front());
    }
    trajectories_.pop_front();
    checksums_.pop_front();
  }
  while (redraw_ && frame_bytes_ > max_frame_bytes_) {
    Trajectory& oldest = trajectories_[without_frames_++];
    frame_bytes_ -= frameBytesOf(oldest);
    for (TrajectoryStep& step : oldest.steps) step.frame.reset();
  }
}

void TrainingWindow::dropLoaded() {
  for (const Index& index : loaded_) stepAt(index).frame.reset();
  loaded_.clear();
}

/// Equal frames of neighbouring steps share their memory, as TrajectoryRecorder makes them: samples depend on it.
void TrainingWindow::loadFrames(const std::vector<Index>& frames) {
  dropLoaded();
  std::set<Index> drawn;
  for (const Index& frame : frames) {
    if (frame.trajectory >= without_frames_) continue;
    for (std::uint32_t age = 0; age < core::kStackedFrames && age <= frame.step; ++age) {
      loaded_.insert({frame.trajectory, frame.step - age});
    }
  }
  for (const Index& index : loaded_) drawn.insert(firstShown(index));
  if (drawn.empty()) return;
  loaded_.insert(drawn.begin(), drawn.end());
  std::vector<FrameOfTrajectory> wanted;
  for (const Index& index : drawn) wanted.push_back({&trajectories_[index.trajectory], index.step});
  const std::vector<SharedFrame> images = redraw_(wanted);
  auto image = images.begin();
  for (const Index& index : drawn) stepAt(index).frame = *image++;
  for (const Index& index : loaded_) stepAt(index).frame = stepAt(firstShown(index)).frame;
}

TrainingWindow::Index TrainingWindow::firstShown(Index index) const {
  while (!trajectories_[index.trajectory].steps[index.step].is_new_frame) --index.step;
  return index;
}

}  // namespace early_fusion::learning
