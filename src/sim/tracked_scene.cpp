#include "early_fusion/sim/tracked_scene.h"

#include <cmath>
#include <set>
#include <utility>

#include "early_fusion/core/error.h"
#include "early_fusion/core/names.h"
#include "early_fusion/sim/task.h"

namespace early_fusion::sim {

namespace {

constexpr double kMostHoldSec = 3600;

std::int64_t holdNs(double hold_sec) {
  if (!(hold_sec >= 0 && hold_sec <= kMostHoldSec)) {
    throw core::Error("hold_sec: " + std::to_string(hold_sec) + " is not in [0, 3600]");
  }
  return std::llround(hold_sec * 1e9);
}

}  // namespace

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

void TrackedScene::see(int object, std::int64_t stamp_ns, const Eigen::Isometry3d& world_from_frame) {
  if (!world_from_frame.matrix().allFinite()) {
    throw core::Error("the pose of frame '" + objects_[object].frame + "' is not finite");
  }
  Track& track = tracks_[object];
  if (track.seen_ns && stamp_ns < *track.seen_ns) return;
  track.seen_ns = stamp_ns;
  const Eigen::Isometry3d pose = world_from_frame * objects_[object].frame_from_object;
  Instance& instance = instances_[object];
  instance.x = pose.translation().x();
  instance.y = pose.translation().y();
  instance.theta = std::atan2(pose.linear()(1, 0), pose.linear()(0, 0));
}

void TrackedScene::take(int object, std::int64_t stamp_ns) { tracks_[object].taken_ns = stamp_ns; }

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

world::Orientation nearestOrientation(const world::OrientationLattice& lattice, double pan_rad, double tilt_rad) {
  const std::string angles = "pan " + std::to_string(pan_rad) + " rad, tilt " + std::to_string(tilt_rad) + " rad";
  // Far outside any joint's limits, and safe to round to an int.
  if (!(std::abs(pan_rad) < 1e3 && std::abs(tilt_rad) < 1e3)) throw core::Error(angles + ": are not joint angles");
  const world::Orientation nearest{static_cast<int>(std::lround(pan_rad / world::kStepRad)),
                                   static_cast<int>(std::lround(tilt_rad / world::kStepRad))};
  if (!lattice.contains(nearest)) throw core::Error(angles + ": is outside the joint limits of the camera's URDF");
  return nearest;
}

}  // namespace early_fusion::sim
