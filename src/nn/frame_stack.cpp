#include "early_fusion/nn/frame_stack.h"

#include <algorithm>
#include <cstring>

namespace early_fusion::nn {

namespace {

constexpr int kRun = 128;  // pixels at a time; their numbers fit in the first-level cache

constexpr std::uint8_t kBlack[3 * kRun] = {};

void store(int difference, float& number) { number = static_cast<float>(difference); }

/// A difference of bytes has no more significant bits than a bfloat16, so nothing is rounded.
void store(int difference, bfloat16& number) {
  const auto exact = static_cast<float>(difference);
  std::uint32_t bits;
  std::memcpy(&bits, &exact, sizeof bits);
  number.bits = static_cast<std::uint16_t>(bits >> 16);
}

template <class T, int kCopied>
inline void interleavePixel(const T (&rows)[core::kStackedFrames][3 * kRun + 1], int p, T* x) {
  T* pixel = x + p * kImageChannels;
  for (int f = 0; f < core::kStackedFrames; ++f) {
    std::memcpy(static_cast<void*>(pixel + 3 * f), rows[f] + 3 * p, kCopied * sizeof(T));
  }
}

/// Interleaves `count` pixels of three frames, (count, 3) each. A copy moves four numbers, the size of a register. The
/// next copy overwrites the fourth number, so the last pixel is copied separately.
template <class T>
void interleave(const T (&rows)[core::kStackedFrames][3 * kRun + 1], int count, T* x) {
  for (int p = 0; p < count - 1; ++p) interleavePixel<T, 4>(rows, p, x);
  interleavePixel<T, 3>(rows, count - 1, x);
}

}  // namespace

template <class T>
void stackFrames(const core::FrameStack& frames, int first_pixel, int last_pixel, T* x) {
  T rows[core::kStackedFrames][3 * kRun + 1] = {};
  for (int start = first_pixel; start < last_pixel; start += kRun) {
    const int count = std::min(kRun, last_pixel - start);
    const std::uint8_t* bytes[core::kStackedFrames];
    for (int f = 0; f < core::kStackedFrames; ++f) bytes[f] = frames[f] != nullptr ? frames[f] + 3 * start : kBlack;
    for (int i = 0; i < 3 * count; ++i) store(bytes[0][i] - kMiddleByte, rows[0][i]);
    for (int f = 1; f < core::kStackedFrames; ++f) {
      for (int i = 0; i < 3 * count; ++i) store(bytes[f - 1][i] - bytes[f][i], rows[f][i]);
    }
    interleave(rows, count, x + std::size_t(start) * kImageChannels);
  }
}

template void stackFrames<float>(const core::FrameStack&, int, int, float*);
template void stackFrames<bfloat16>(const core::FrameStack&, int, int, bfloat16*);

}  // namespace early_fusion::nn
