#pragma once

#include <cstddef>

#include "early_fusion/nn/lanes.h"

namespace early_fusion::nn {

/// How the numbers of one image's map lie in memory.
enum class MapLayout {
  kChannelsLast,  ///< (height, width, channels)
  kBlocked,       ///< (channels / kLanes, height, width, kLanes)
};

/// A map of one image before pooling; even edges, channels a multiple of kLanes.
struct MapShape {
  int height;
  int width;
  int channels;
  MapLayout layout = MapLayout::kChannelsLast;

  int positions() const { return height * width; }
  int pooledPositions() const { return height / 2 * (width / 2); }
  MapShape pooled(MapLayout pooled_layout) const { return {height / 2, width / 2, channels, pooled_layout}; }

  /// From a position's numbers to the next one's, within kLanes channels.
  std::size_t stride() const { return layout == MapLayout::kBlocked ? kLanes : channels; }
  /// Where channels [c, c + kLanes) of the first position are.
  std::size_t firstOf(int c) const { return layout == MapLayout::kBlocked ? std::size_t(c) * positions() : c; }
  std::size_t at(int position, int channel) const {
    return firstOf(channel / kLanes * kLanes) + position * stride() + channel % kLanes;
  }
};

}  // namespace early_fusion::nn
