#pragma once

#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/core/image.h"
#include "early_fusion/sim/episode.h"

namespace early_fusion::cli {

/// One step of an episode that was played.
struct PlayedStep {
  std::vector<sim::Instance> instances;
  sim::EpisodeState state;
  core::Action action;
  core::Action expert_action;
};

struct PictureStyle {
  int size;       ///< edge of each drawn image [px]
  int scale;      ///< each is enlarged so many times
  bool annotate;  ///< crosshair circle, request and action
};

core::Image drawStep(const world::World& world, const PlayedStep& step, const PictureStyle& style);

/// A sheet of images, row by row: the first step, the last one, and those between at which something was taken or that
/// are evenly spread.
core::Image drawEpisode(const world::World& world, const std::vector<PlayedStep>& steps, const PictureStyle& style);

/// A sheet with every object of the set alone on the counter, its name below.
core::Image drawObjects(const world::World& world, const PictureStyle& style);

}  // namespace early_fusion::cli
