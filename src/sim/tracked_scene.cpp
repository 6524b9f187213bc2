#include "early_fusion/sim/tracked_scene.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "early_fusion/core/error.h"
#include "early_fusion/core/names.h"
#include "early_fusion/core/options.h"
#include "early_fusion/sim/task.h"
#include "early_fusion/world/yaml_entries.h"

namespace early_fusion::sim {

namespace {

constexpr double kMostHoldSec = 3600;
constexpr double kMostAngleDeg = 3, kMostDistanceM = 0.05;  // of a camera from the rig's

std::int64_t holdNs(double hold_sec) {
  if (!(hold_sec >= 0 && hold_sec <= kMostHoldSec)) {
    throw core::Error("hold_sec: " + std::to_string(hold_sec) + " is not in [0, 3600]");
  }
  return std::llround(hold_sec * 1e9);
}

}  // namespace

std::vector<Instance> asTracked(std::vector<Instance> instances, const TrackerErrors& errors, core::Random& random) {
  for (Instance& instance : instances) {
    instance.x += 1e-3 * errors.mm * random.normal();
    instance.y += 1e-3 * errors.mm * random.normal();
    instance.theta += errors.degrees * EIGEN_PI / 180 * random.normal();
  }
  return instances;
}

TrackedScene::TrackedScene(std::vector<TrackedObject> objects, const core::Vocabulary& vocabulary, double hold_sec)
    : objects_(std::move(objects)), hold_ns_(holdNs(hold_sec)), tracks_(objects_.size()) {
  if (objects_.empty() || objects_.size() > kMaxInstances) {
    throw core::Error("objects: " + std::to_string(objects_.size()) + " are tracked; expected 1 to " +
                      std::to_string(kMaxInstances));
  }
  std::set<std::string> frames;
  for (const TrackedObject& object : objects_) {
    if (object.frame.empty()) throw core::Error("frame: is empty for item '" + object.item + "'");
    if (!frames.insert(object.frame).second) throw core::Error("frame: '" + object.frame + "' is listed twice");
    instances_.push_back({vocabulary.index(object.item), 0, 0, 0});
  }
}

Eigen::Isometry3d TrackedScene::pose(int object, const Eigen::Isometry3d& world_from_frame) const {
  if (!world_from_frame.matrix().allFinite()) {
    throw core::Error("the pose of frame '" + objects_[object].frame + "' is not finite");
  }
  return world_from_frame * objects_[object].frame_from_object;
}

void TrackedScene::see(int object, std::int64_t stamp_ns, const Eigen::Isometry3d& world_from_frame) {
  const Eigen::Isometry3d pose = this->pose(object, world_from_frame);
  Track& track = tracks_[object];
  if (track.seen_ns && stamp_ns < *track.seen_ns) return;
  track.seen_ns = stamp_ns;
  Instance& instance = instances_[object];
  instance.x = pose.translation().x();
  instance.y = pose.translation().y();
  instance.theta = std::atan2(pose.linear()(1, 0), pose.linear()(0, 0));
}

void TrackedScene::take(int object, std::int64_t stamp_ns) { tracks_[object].taken_ns = stamp_ns; }

void TrackedScene::forgetStamps() {
  for (Track& track : tracks_) {
    track.seen_ns.reset();
    if (track.taken_ns) track.taken_ns = std::numeric_limits<std::int64_t>::min();
  }
}

InstanceMask TrackedScene::present(std::int64_t stamp_ns) const {
  InstanceMask mask = 0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (!tracks_[i].taken_ns && fresh(tracks_[i], stamp_ns)) mask |= InstanceMask{1} << i;
  }
  return mask;
}

std::vector<std::string> TrackedScene::taken() const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (tracks_[i].taken_ns) names.push_back(label(i));
  }
  return names;
}

void TrackedScene::beginEpisode(std::int64_t stamp_ns) {
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const Track& track = tracks_[i];
    const bool since_taken = !track.taken_ns || (track.seen_ns && *track.seen_ns > *track.taken_ns);
    if (!since_taken || !fresh(track, stamp_ns)) missing.push_back(label(i));
  }
  if (!missing.empty()) throw core::Error("not seen on the counter: " + core::joined(missing) + "; put them back");
  for (Track& track : tracks_) track.taken_ns.reset();
}

bool TrackedScene::fresh(const Track& track, std::int64_t stamp_ns) const {
  return track.seen_ns && stamp_ns - *track.seen_ns <= hold_ns_;
}

std::string TrackedScene::label(std::size_t object) const {
  return objects_[object].item + " (" + objects_[object].frame + ")";
}

std::vector<TrackedObject> loadTrackedObjects(const std::string& yaml_file) {
  const YAML::Node root = core::loadYamlFile(yaml_file);
  if (!root.IsMap() || !root["objects"] || !root["objects"].IsSequence()) {
    throw core::Error(yaml_file + ": needs 'objects', a list of {frame, item, position, rotation}");
  }
  world::checkKeys(root, {"objects"}, yaml_file);
  std::vector<TrackedObject> objects;
  for (const YAML::Node& entry : root["objects"]) {
    if (!entry.IsMap()) throw core::Error(world::place(yaml_file, entry) + "a tracked object is a map");
    world::checkKeys(entry, {"frame", "item", "position", "rotation"}, yaml_file);
    TrackedObject object;
    object.frame = world::readText(entry, "frame", yaml_file, "a tracked object");
    object.item = world::readText(entry, "item", yaml_file, "a tracked object");
    object.frame_from_object = Eigen::Translation3d(world::readPosition(entry["position"], yaml_file)) *
                               Eigen::Isometry3d(world::readRotation(entry["rotation"], yaml_file));
    objects.push_back(object);
  }
  return objects;
}

world::Orientation nearestOrientation(const world::CameraRig& rig, const Eigen::Isometry3d& world_from_camera) {
  const Eigen::Vector3d axis = world_from_camera.linear().col(2);
  const world::OrientationLattice& lattice = rig.lattice();
  int nearest = 0;
  double cosine = -2;
  for (int i = 0; i < lattice.size(); ++i) {
    const double other = axis.dot(rig.worldFromCamera(lattice.at(i)).linear().col(2));
    if (other > cosine) {
      cosine = other;
      nearest = i;
    }
  }
  const double angle_deg = std::acos(std::min(1.0, cosine)) * 180 / EIGEN_PI;
  const double distance_m =
      (rig.worldFromCamera(lattice.at(nearest)).translation() - world_from_camera.translation()).norm();
  if (angle_deg <= kMostAngleDeg && distance_m <= kMostDistanceM) return lattice.at(nearest);
  throw core::Error("the camera is " + std::to_string(distance_m) + " m and " + std::to_string(angle_deg) +
                    " degrees from the nearest orientation of the world's camera URDF; use the robot's URDF in the "
                    "world file, and check the frame of the world");
}

}  // namespace early_fusion::sim
