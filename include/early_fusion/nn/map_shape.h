#pragma once

#include <cstddef>

#include "early_fusion/nn/lanes.h"

namespace early_fusion::nn {

/// The order of the numbers of one image's map in memory.
enum class MapLayout {
  kChannelsLast,  ///< (height, width, channels)
  kBlocked,       ///< (channels / kLanes, height, width, kLanes)
};

/// The shape of one image's map before pooling. Edges are even; channels are a multiple of kLanes.
struct MapShape {
  int height;
  int width;
  int channels;
  MapLayout layout = MapLayout::kChannelsLast;

  int positions() const { return height * width; }
  int pooledPositions() const { return height / 2 * (width / 2); }
  MapShape pooled(MapLayout pooled_layout) const { return {height / 2, width / 2, channels, pooled_layout}; }

  /// The distance from one position to the next, within a group of kLanes channels.
  std::size_t stride() const { return layout == MapLayout::kBlocked ? kLanes : channels; }
  /// The offset of channels [c, c + kLanes) of the first position.
  std::size_t firstOf(int c) const { return layout == MapLayout::kBlocked ? std::size_t(c) * positions() : c; }
  std::size_t at(int position, int channel) const {
    return firstOf(channel / kLanes * kLanes) + position * stride() + channel % kLanes;
  }
};

}  // namespace early_fusion::nn
