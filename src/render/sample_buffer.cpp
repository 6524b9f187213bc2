#include "sample_buffer.h"

#include <algorithm>
#include <cassert>

namespace early_fusion::render {

namespace {

constexpr int kPixelsAcross = SampleBuffer::kPixelsAcross;

/// Place of each lane's sample within its block [subsamples].
IntLanes laneX() {
  IntLanes x;
  for (int lane = 0; lane < kLanes; ++lane) x[lane] = kSubsamples * (2 * (lane / 4 % kPixelsAcross) + lane % 2);
  return x;
}

IntLanes laneY() {
  IntLanes y;
  for (int lane = 0; lane < kLanes; ++lane) y[lane] = kSubsamples * (2 * (lane / 4 / kPixelsAcross) + lane / 2 % 2);
  return y;
}

}  // namespace

SampleBuffer::SampleBuffer(int width, int height, bool with_ids)
    : width_(width),
      height_(height),
      blocks_across_(width / kBlockWidth),
      depth_(static_cast<std::size_t>(width) * height / kLanes),
      ids_(with_ids ? depth_.size() : 0) {
  assert(width % kBlockWidth == 0 && height % kBlockHeight == 0);
  assert(width <= kMaxScreenSize && height <= kMaxScreenSize);
}

void SampleBuffer::copyDepth(std::vector<float>& rows) const {
  rows.resize(static_cast<std::size_t>(width_) * height_);
  const auto* blocks = reinterpret_cast<const float*>(depth_.data());
  for (int y = 0; y < height_; ++y) {
    float* row = &rows[static_cast<std::size_t>(y) * width_];
    for (int x = 0; x < width_; x += 2) {
      const float* sample = blocks + pixelOffset(x / 2, y / 2) + 2 * (y % 2);
      row[x] = sample[0];
      row[x + 1] = sample[1];
    }
  }
}

void SampleBuffer::clear(float farthest) {
  std::fill(depth_.begin(), depth_.end(), allLanes(farthest));
  std::fill(ids_.begin(), ids_.end(), IntLanes{});
}

void SampleBuffer::fill(const TriangleBatch& batch, int lane, std::int32_t id) {
  if (ids_.empty()) {
    fillBlocks<false>(batch, lane, id);
  } else {
    fillBlocks<true>(batch, lane, id);
  }
}

template <bool kWithIds>
void SampleBuffer::fillBlocks(const TriangleBatch& batch, int lane, std::int32_t id) {
  const int first_column = batch.first_x[lane] / kBlockWidth, last_column = batch.last_x[lane] / kBlockWidth;
  const int first_row = batch.first_y[lane] / kBlockHeight, last_row = batch.last_y[lane] / kBlockHeight;
  // From the first sample of the bounding box to the samples of its block.
  const IntLanes to_x = laneX() - (batch.first_x[lane] & (kBlockWidth - 1)) * kSubsamples;
  const IntLanes to_y = laneY() - (batch.first_y[lane] & (kBlockHeight - 1)) * kSubsamples;
  IntLanes edge[3], next_column[3], next_row[3];
  for (int k = 0; k < 3; ++k) {
    const std::int32_t slope_x = batch.edge_x[k][lane], slope_y = batch.edge_y[k][lane];
    edge[k] = batch.edge[k][lane] + slope_x * to_x + slope_y * to_y;
    next_column[k] = allLanes(slope_x * kBlockWidth * kSubsamples);
    next_row[k] = allLanes(slope_y * kBlockHeight * kSubsamples);
  }
  const FloatLanes offset_x = batch.offset_x[lane] + toFloat(to_x);
  FloatLanes offset_y = batch.offset_y[lane] + toFloat(to_y);
  const float depth_x = batch.depth_x[lane], depth_y = batch.depth_y[lane], first_depth = batch.depth[lane];
  const FloatLanes low = allLanes(batch.depth_low[lane]), high = allLanes(batch.depth_high[lane]);
  for (int row = first_row; row <= last_row; ++row) {
    std::size_t block = static_cast<std::size_t>(row) * blocks_across_ + first_column;
    // Depth is evaluated in every block and not accumulated, because an accumulated sum would depend on the number of
    // lanes.
    const FloatLanes row_depth = first_depth + depth_y * offset_y;
    FloatLanes x = offset_x;
    IntLanes e0 = edge[0], e1 = edge[1], e2 = edge[2];
    for (int column = first_column; column <= last_column; ++column, ++block) {
      const FloatLanes depth = lowest(highest(row_depth + depth_x * x, low), high);
      const FloatLanes old_depth = depth_[block];
      const IntLanes wins = ((e0 | e1 | e2) >= 0) & (depth > old_depth);
      depth_[block] = select(wins, depth, old_depth);
      if (kWithIds) ids_[block] = select(wins, allLanes(id), ids_[block]);
      x += static_cast<float>(kBlockWidth * kSubsamples);
      e0 += next_column[0];
      e1 += next_column[1];
      e2 += next_column[2];
    }
    offset_y += static_cast<float>(kBlockHeight * kSubsamples);
    for (int k = 0; k < 3; ++k) edge[k] += next_row[k];
  }
}

}  // namespace early_fusion::render
