#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/core/image.h"
#include "early_fusion/sim/episode.h"

namespace early_fusion::cli {

/// One step of an episode that was played.
struct PlayedStep {
  sim::EpisodeSetup setup;
  sim::EpisodeState state;
  core::Action action;
  core::Action expert_action;
  std::optional<Eigen::MatrixXf> attention;  ///< of a policy, see model::GoalPolicy
};

struct ImageStyle {
  int size;       ///< edge of each drawn image [px]
  int scale;      ///< enlargement of each image
  bool annotate;  ///< attention map, crosshair circle, boxes around requested objects, request and action
};

/// An image of each step.
std::vector<core::Image> drawSteps(const world::World& world, const std::vector<PlayedStep>& steps,
                                   const ImageStyle& style);

/// A sheet of frames, row by row: the first step, the last step, all steps that took an object, and steps at regular
/// intervals between.
core::Image drawEpisode(const world::World& world, const std::vector<PlayedStep>& steps, const ImageStyle& style);

/// A sheet with each object of the set alone on the counter and its name below. @param look null: the world's own.
core::Image drawObjects(const world::World& world, std::shared_ptr<const world::Appearance> look,
                        const ImageStyle& style);

}  // namespace early_fusion::cli
