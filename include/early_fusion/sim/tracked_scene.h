#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "early_fusion/core/random.h"
#include "early_fusion/core/vocabulary.h"
#include "early_fusion/sim/scene.h"
#include "early_fusion/world/camera_rig.h"

namespace early_fusion::sim {

/// A real object whose frame something tracks. Two objects of one item have two frames.
struct TrackedObject {
  std::string frame;
  std::string item;
  /// The object's origin and axes, as in the object set, in the tracked frame [m].
  Eigen::Isometry3d frame_from_object = Eigen::Isometry3d::Identity();
};

/// Standard deviations of a tracker's errors.
struct TrackerErrors {
  double mm = 0;       ///< of a position, along x and y
  double degrees = 0;  ///< of a rotation about z
};

/// The instances where a tracker with errors sees them.
std::vector<Instance> asTracked(std::vector<Instance> instances, const TrackerErrors& errors, core::Random& random);

/// The objects of a real scene, from the frames that a tracker reports. Instance i is the i-th tracked object, always.
/// Stamps are in nanoseconds of one clock.
class TrackedScene {
 public:
  /// @param hold_sec an object that is not seen stays in the scene, where it was last, for this long.
  /// @throws Error naming the value if a frame is empty or is listed twice, an item is not in `vocabulary`, there are
  /// none or more than kMaxInstances objects, or `hold_sec` is negative or not finite.
  TrackedScene(std::vector<TrackedObject> objects, const core::Vocabulary& vocabulary, double hold_sec);

  const std::vector<TrackedObject>& objects() const { return objects_; }

  /// The tracker has seen an object. What is older than the last sighting is ignored.
  /// @throws Error naming the frame if the pose is not finite.
  void see(int object, std::int64_t stamp_ns, const Eigen::Isometry3d& world_from_frame);

  /// An object was collected or removed: it is gone, wherever it is seen, until beginEpisode().
  void take(int object, std::int64_t stamp_ns);

  /// All objects where they were last seen; those that were never seen are at the origin.
  const std::vector<Instance>& instances() const { return instances_; }

  /// The objects that are on the counter: not taken and seen at most `hold_sec` before `stamp_ns`.
  InstanceMask present(std::int64_t stamp_ns) const;

  /// The place of an object whose frame is there. @throws Error as see().
  Eigen::Isometry3d pose(int object, const Eigen::Isometry3d& world_from_frame) const;

  /// What a person must put back, as "item (frame)".
  std::vector<std::string> taken() const;

  /// Forgets when objects were seen and taken, because the time has jumped back. What was taken stays taken until it
  /// is put back.
  void forgetStamps();

  /// Everything has been put back. @throws Error naming all objects that were not seen at most `hold_sec` before
  /// `stamp_ns`, or not since they were taken; then nothing changes.
  void beginEpisode(std::int64_t stamp_ns);

 private:
  struct Track {
    std::optional<std::int64_t> seen_ns;
    std::optional<std::int64_t> taken_ns;
  };

  bool fresh(const Track& track, std::int64_t stamp_ns) const;
  std::string label(std::size_t object) const;

  std::vector<TrackedObject> objects_;
  std::int64_t hold_ns_;
  std::vector<Instance> instances_;
  std::vector<Track> tracks_;
};

/// The tracked objects of a YAML file: `objects`, a list of {frame, item, position, rotation}. The last two are the
/// object's place in its frame; config/tracked_objects.yaml explains them. @throws Error naming file, line and value.
std::vector<TrackedObject> loadTrackedObjects(const std::string& yaml_file);

/// The rig's orientation whose optical axis is nearest to a camera's.
/// @throws Error if the camera looks more than 3 degrees past it, or stands more than 5 cm beside the rig's: then the
/// rig is not that of the robot, or its frames are not.
world::Orientation nearestOrientation(const world::CameraRig& rig, const Eigen::Isometry3d& world_from_camera);

}  // namespace early_fusion::sim
