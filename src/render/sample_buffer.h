#pragma once

#include <cstdint>
#include <vector>

#include "triangle_batch.h"

namespace early_fusion::render {

/// Depth and triangle number of every sample of a screen. Samples are stored in blocks of kLanes. Within a block, the
/// four samples of a pixel (2x2) are neighbours, row by row.
class SampleBuffer {
 public:
  static constexpr int kBlockWidth = kLanes == 4 ? 2 : 4;
  static constexpr int kBlockHeight = kLanes / kBlockWidth;
  static constexpr int kPixelsAcross = kBlockWidth / 2, kPixelsDown = kBlockHeight / 2;  ///< of a block

  /// @param width, height [samples], multiples of the block's.
  SampleBuffer(int width, int height, bool with_ids);

  int width() const { return width_; }
  int height() const { return height_; }
  int blocksAcross() const { return blocks_across_; }
  int blocksDown() const { return height_ / kBlockHeight; }
  /// Block after block, from left to right and from top to bottom.
  const std::int32_t* ids() const { return reinterpret_cast<const std::int32_t*>(ids_.data()); }

  /// The index of the first of pixel (x, y)'s four samples in ids().
  int pixelOffset(int x, int y) const {
    const int block = y / kPixelsDown * blocks_across_ + x / kPixelsAcross;
    return block * kLanes + 4 * (y % kPixelsDown * kPixelsAcross + x % kPixelsAcross);
  }

  /// All depths, row by row.
  void copyDepth(std::vector<float>& rows) const;

  /// Sets id 0 everywhere.
  void clear(float farthest);

  /// Gives `id` to the samples that triangle `lane` of the batch covers and in which it is the nearest so far. A sample
  /// on an edge belongs to one of the two triangles that share the edge.
  void fill(const TriangleBatch& batch, int lane, std::int32_t id);

 private:
  template <bool kWithIds>
  void fillBlocks(const TriangleBatch& batch, int lane, std::int32_t id);

  int width_;
  int height_;
  int blocks_across_;
  std::vector<FloatLanes> depth_;
  std::vector<IntLanes> ids_;
};

}  // namespace early_fusion::render
