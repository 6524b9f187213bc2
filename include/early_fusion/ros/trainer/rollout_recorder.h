#pragma once

#include <early_fusion/Action.h>
#include <early_fusion/Request.h>
#include <early_fusion/RunEpisodesGoal.h>
#include <early_fusion/Scene.h>
#include <sensor_msgs/Image.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "early_fusion/learning/trajectory.h"
#include "early_fusion/sim/episode.h"
#include "early_fusion/world/world.h"

namespace early_fusion::nodes {

/// Which episodes to record, and how they must be played to count.
struct RolloutPlan {
  RunEpisodesGoal goal;         ///< the episodes, as the simulator is asked for them
  std::string weights;          ///< the id of the weights that must act
  std::string mode = "argmax";  ///< how they must choose
  learning::TrainingExpert training_expert = learning::TrainingExpert::kGreedy;
};

/// Makes labelled trajectories of the messages of episodes that are played elsewhere.
///
/// An episode counts only when every step of it was seen and follows from the one before by the rules, and when the
/// policy that acted had the right weights and had seen the episode from its beginning. So a node that died in between
/// cannot change what is learnt: its episode is dropped and stays missing().
class RolloutRecorder {
 public:
  /// `world` must outlive the recorder. @throws core::Error as firstEpisode().
  RolloutRecorder(const world::World& world, const RolloutPlan& plan);

  /// Takes the four messages of one stamp.
  /// @return the labelled step, valid until the next call of any function; nullptr when it is not of the plan or is
  /// known already.
  /// @throws core::Error saying why the step cannot be used; the episode at hand is dropped then.
  const learning::TrajectoryStep* add(const sensor_msgs::Image& image, const Request& request, const Scene& scene,
                                      const Action& action);

  /// The next trajectory in the plan's order, once it is there.
  std::optional<learning::Trajectory> next();

  bool complete() const { return next_ == end(); }

  /// Whether a step is of an episode of the plan that is not recorded yet.
  bool wants(const Scene& scene) const;

  /// A run of episodes that are not recorded, as [first, last).
  std::pair<std::uint64_t, std::uint64_t> missing() const;

 private:
  struct Recording {
    sim::EpisodeKey key;
    sim::Episode episode;
    learning::TrajectoryRecorder recorder;
    ::ros::Time stamp;            // of the last step
    std::string previous_action;  // recorded at the last step
  };

  std::uint64_t end() const { return first_.number + plan_.goal.episodes; }
  void begin(const Scene& scene);
  void check(const sensor_msgs::Image& image, const Request& request, const Scene& scene, const Action& action) const;

  const world::World& world_;
  RolloutPlan plan_;
  sim::EpisodeKey first_;  // of the plan's episodes
  std::optional<Recording> recording_;
  std::map<std::uint64_t, learning::Trajectory> finished_;
  std::uint64_t next_;
};

}  // namespace early_fusion::nodes
