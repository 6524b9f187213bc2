#pragma once

#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>

#include <string>
#include <vector>

#include "early_fusion/core/options.h"
#include "early_fusion/sim/scene.h"

namespace early_fusion::nodes {

/// What tracks the objects of the virtual robot's scene: it publishes their frames on tf, as AprilTags or motion
/// capture would, with errors.
class VirtualTracker {
 public:
  struct Options {
    bool track = false;
    double rate_hz = 20;
    double noise_mm = 0;
    double noise_deg = 0;
    double dropout = 0;

    core::OptionSet options();
  };

  /// `world` must outlive the tracker.
  VirtualTracker(const world::World& world, const Options& options, std::uint64_t seed);

  const Options& options() const { return options_; }

  /// Publishes a frame for each object that is there: "mug_1", "mug_2" for the first and the second mug.
  void publish(const std::vector<sim::Instance>& instances, sim::InstanceMask present);

 private:
  const world::World& world_;
  Options options_;
  std::uint64_t seed_;
  std::uint64_t sightings_ = 0;
  tf2_ros::TransformBroadcaster broadcaster_;
};

}  // namespace early_fusion::nodes
