#pragma once

#include <memory>
#include <vector>

#include "early_fusion/learning/training_session.h"
#include "early_fusion/ros/trainer/local_worker.h"
#include "early_fusion/ros/trainer/trainer_node.h"

namespace early_fusion::nodes {

/// The trainer's options: the defaults, the preset, and the private ROS parameters, in this order. Needs ros::init()
/// and a master.
/// @throws core::Error naming the parameter or the preset's key, its value and the allowed range.
TrainerNode::Options loadTrainerOptions();

/// Starts the session. A trainer that is respawned in the same launch continues it, also without options.resume.
/// @throws core::Error as learning::TrainingSession.
std::unique_ptr<learning::TrainingSession> startSession(learning::SessionOptions options,
                                                        std::shared_ptr<const world::World> world);

/// Starts the session's first options.local_workers workers in this process.
/// @throws core::Error as LocalWorker.
std::vector<std::unique_ptr<LocalWorker>> startLocalWorkers(const TrainerNode::Options& options,
                                                            const std::shared_ptr<const world::World>& world);

}  // namespace early_fusion::nodes
