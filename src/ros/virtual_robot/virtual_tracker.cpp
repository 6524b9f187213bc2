#include "early_fusion/ros/virtual_robot/virtual_tracker.h"

#include <map>

#include "early_fusion/core/random.h"
#include "early_fusion/ros/shared/conversions.h"
#include "early_fusion/ros/virtual_robot/sensor_image.h"
#include "early_fusion/sim/tracked_scene.h"

namespace early_fusion::nodes {

core::OptionSet VirtualTracker::Options::options() {
  core::OptionSet set("virtual tracker");
  set.add("track", track, "publish the objects' frames on tf, such as mug_1 and mug_2");
  set.add("track_rate", rate_hz, 0.1, 1000, "Hz", "sightings a second");
  set.add("track_noise", noise_mm, 0, 1000, "mm", "standard deviation of a frame's position along x and y");
  set.add("track_angle_noise", noise_deg, 0, 180, "degrees", "standard deviation of a frame's rotation about z");
  set.add("track_dropout", dropout, 0, 1, "", "probability that a sighting of an object is missing");
  return set;
}

VirtualTracker::VirtualTracker(const world::World& world, const Options& options, std::uint64_t seed)
    : world_(world), options_(options), seed_(seed) {}

void VirtualTracker::publish(const std::vector<sim::Instance>& instances, sim::InstanceMask present) {
  std::vector<geometry_msgs::TransformStamped> transforms;
  std::map<int, int> counts;
  core::Random random(seed_, {kTrackerStream, sightings_++});
  const std::vector<sim::Instance> seen = sim::asTracked(instances, {options_.noise_mm, options_.noise_deg}, random);
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const int number = ++counts[instances[i].item];
    const double dropped = random.uniform();
    if (!(present >> i & 1) || dropped < options_.dropout) continue;
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = ::ros::Time::now();
    transform.header.frame_id = world_.rig.worldFrame();
    transform.child_frame_id = world_.objects.vocabulary().name(instances[i].item) + "_" + std::to_string(number);
    transform.transform = transformMessage(sim::worldFromObject(world_, seen[i]));
    transforms.push_back(transform);
  }
  if (!transforms.empty()) broadcaster_.sendTransform(transforms);
}

}  // namespace early_fusion::nodes
