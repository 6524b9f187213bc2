#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <set>
#include <vector>

#include "early_fusion/learning/trajectory.h"

namespace early_fusion::learning {

/// A frame of a trajectory. Nothing is owned.
struct FrameOfTrajectory {
  const Trajectory* trajectory;
  std::size_t step;
};

/// Draws frames again, bit for bit, in the given order.
using Redraw = std::function<std::vector<SharedFrame>(const std::vector<FrameOfTrajectory>& frames)>;

/// The trajectories that a round trains on, in the order of their episodes.
///
/// Frames take almost all of a trajectory's memory. The most recent trajectories that fit into the memory limit keep
/// their frames. The frames of the others are dropped and drawn again when a batch needs them. Labels are always kept.
class TrainingWindow {
 public:
  /// A frame of the window: trajectories()[trajectory].steps[step].
  struct Index {
    std::uint32_t trajectory;
    std::uint32_t step;

    bool operator<(const Index& other) const {
      return trajectory != other.trajectory ? trajectory < other.trajectory : step < other.step;
    }
  };

  /// @param max_trajectories 0: no limit. @param max_frame_bytes memory for frames.
  /// @param redraw empty: all frames are kept, whatever max_frame_bytes is.
  TrainingWindow(int max_trajectories, std::size_t max_frame_bytes, Redraw redraw);

  /// Adds a trajectory with all its frames. Removes the oldest if there are too many.
  void add(Trajectory trajectory);

  const std::deque<Trajectory>& trajectories() const { return trajectories_; }

  /// A hash of the first frame and of every step's label and nearest item, for each trajectory: detects a changed
  /// simulator.
  const std::deque<std::int64_t>& checksums() const { return checksums_; }

  /// Memory of the frames that are kept [bytes], without those that loadFrames() has drawn.
  std::size_t frameBytes() const { return frame_bytes_; }

  /// Draws the missing frames of the frame stacks at these steps. Drops those that the last call has drawn.
  void loadFrames(const std::vector<Index>& frames);

 private:
  TrajectoryStep& stepAt(const Index& index) { return trajectories_[index.trajectory].steps[index.step]; }
  /// The step from which on the trajectory has shown this step's frame.
  Index firstShown(Index index) const;
  void dropLoaded();

  int max_trajectories_;
  std::size_t max_frame_bytes_;
  Redraw redraw_;
  std::deque<Trajectory> trajectories_;
  std::deque<std::int64_t> checksums_;
  std::size_t without_frames_ = 0;  // the oldest trajectories, whose frames are dropped
  std::size_t frame_bytes_ = 0;
  std::set<Index> loaded_;  // the steps whose frames the last loadFrames() has set
};

}  // namespace early_fusion::learning
