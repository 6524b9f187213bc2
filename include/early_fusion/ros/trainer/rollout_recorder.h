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

#include "early_fusion/learning/expert_drive.h"
#include "early_fusion/learning/trajectory.h"
#include "early_fusion/sim/episode.h"
#include "early_fusion/world/world.h"

namespace early_fusion::nodes {

/// Which episodes to record, and how they must be played to count.
struct RolloutPlan {
  RunEpisodesGoal goal;         ///< the episodes, as in the simulator's goal
  std::string weights;          ///< the id of the weights that must act
  std::string mode = "argmax";  ///< how they must choose actions
};

/// Makes labelled trajectories of the messages of episodes that other nodes play.
///
/// An episode is accepted only if every step arrived, if each step follows from the previous one by the rules, and if
/// the right weights answered each step, also those that the training expert drove, and had seen the episode from its
/// beginning. So a node that dies within an episode does not
/// change the training data: the episode is dropped and stays missing().
class RolloutRecorder {
 public:
  /// `world` must outlive the recorder. @throws core::Error as firstEpisode(), expertDrive() and trainingExpert().
  RolloutRecorder(const world::World& world, const RolloutPlan& plan);

  /// Adds the four messages of one stamp.
  /// @return the labelled step, valid until the next call of any function; nullptr if the step is not part of the plan
  /// or was added before.
  /// @throws core::Error saying why the step cannot be used. The current episode is dropped then.
  const learning::TrajectoryStep* add(const sensor_msgs::Image& image, const Request& request, const Scene& scene,
                                      const Action& action);

  /// The next trajectory in the plan's order, if it is complete.
  std::optional<learning::Trajectory> next();

  bool complete() const { return next_ == end(); }

  /// Whether a step belongs to an episode of the plan that is not recorded yet.
  bool wants(const Scene& scene) const;

  /// A range of consecutive episodes that are not recorded, [first, last).
  std::pair<std::uint64_t, std::uint64_t> missing() const;

 private:
  struct Recording {
    sim::EpisodeKey key;
    sim::Episode episode;
    learning::TrajectoryRecorder recorder;
    ::ros::Time stamp;            // of the last step
    std::string previous_action;  // taken at the last step
  };

  std::uint64_t end() const { return first_.number + plan_.goal.episodes; }
  void begin(const Scene& scene);
  void check(const sensor_msgs::Image& image, const Request& request, const Scene& scene, const Action& action) const;

  const world::World& world_;
  RolloutPlan plan_;
  sim::EpisodeKey first_;  // of the plan's episodes
  learning::TrainingExpert training_expert_;
  learning::ExpertDrive drive_;
  std::optional<Recording> recording_;
  std::map<std::uint64_t, learning::Trajectory> finished_;
  std::uint64_t next_;
};

}  // namespace early_fusion::nodes
