#include "early_fusion/model/saliency.h"

#include <algorithm>
#include <cstring>
#include <opencv2/imgproc.hpp>

namespace early_fusion::model {

namespace {

constexpr std::uint8_t kGrey = 128;
constexpr int kBatch = 32;
constexpr float kStrongestTint = 0.6f;

using Frames = std::array<std::vector<std::uint8_t>, core::kStackedFrames>;

/// Paints cell (row, column) of the grid grey. A margin of half a cell covers parts of objects at the cell's edge.
void paint(std::vector<std::uint8_t>& frame, int size, int grid, int row, int column) {
  const int margin = size / grid / 2;
  const int left = std::max(0, column * size / grid - margin);
  const int right = std::min(size, (column + 1) * size / grid + margin);
  const int top = std::max(0, row * size / grid - margin);
  const int bottom = std::min(size, (row + 1) * size / grid + margin);
  for (int y = top; y < bottom; ++y) std::memset(&frame[3 * (y * size + left)], kGrey, 3 * (right - left));
}

/// The observation with one cell painted over; `frames` keeps the pixels.
Observation occluded(const Observation& observation, int size, int grid, int cell, Frames& frames) {
  Observation result;
  result.request = observation.request;
  for (int age = 0; age < core::kStackedFrames; ++age) {
    if (observation.frames[age] == nullptr) continue;
    frames[age].assign(observation.frames[age], observation.frames[age] + 3 * size * size);
    paint(frames[age], size, grid, cell / grid, cell % grid);
    result.frames[age] = frames[age].data();
  }
  return result;
}

}  // namespace

Eigen::MatrixXf occlusionSaliency(GoalPolicy& policy, const Observation& observation, int grid) {
  const int size = policy.options().image_size;
  Probabilities plain, painted;
  policy.predict({observation}, plain);
  Eigen::MatrixXf saliency(grid, grid);
  std::vector<Frames> frames(kBatch);
  for (int first = 0; first < grid * grid; first += kBatch) {
    const int count = std::min(kBatch, grid * grid - first);
    std::vector<Observation> observations;
    for (int i = 0; i < count; ++i) observations.push_back(occluded(observation, size, grid, first + i, frames[i]));
    policy.predict(observations, painted);
    for (int i = 0; i < count; ++i) {
      const int cell = first + i;
      saliency(cell / grid, cell % grid) = 0.5f * (painted.row(i) - plain.row(0)).cwiseAbs().sum();
    }
  }
  return saliency;
}

void tint(core::Image& image, const Eigen::MatrixXf& map) {
  const float highest = map.maxCoeff();
  if (!(highest > 0)) return;
  cv::Mat cells(static_cast<int>(map.rows()), static_cast<int>(map.cols()), CV_32F);
  for (int row = 0; row < cells.rows; ++row) {
    for (int column = 0; column < cells.cols; ++column) {
      cells.at<float>(row, column) = std::max(0.f, map(row, column)) / highest;
    }
  }
  cv::Mat smooth;
  cv::resize(cells, smooth, {image.width, image.height}, 0, 0, cv::INTER_LINEAR);
  for (int i = 0; i < image.width * image.height; ++i) {
    const float share = kStrongestTint * smooth.at<float>(i / image.width, i % image.width);
    std::uint8_t* pixel = &image.rgb[3 * i];
    pixel[0] = static_cast<std::uint8_t>(pixel[0] + share * (255 - pixel[0]));
    pixel[1] = static_cast<std::uint8_t>(pixel[1] * (1 - share));
    pixel[2] = static_cast<std::uint8_t>(pixel[2] * (1 - share));
  }
}

}  // namespace early_fusion::model
