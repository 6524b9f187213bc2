#include "early_fusion/nn/frame_stack.h"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace early_fusion::nn {

namespace {

constexpr int kRun = 128;  // pixels at a time, whose numbers stay in the innermost cache

float aboutZero(std::uint8_t byte) { return static_cast<float>(byte - kMiddleByte); }

/// bytes (count) -> numbers, exactly.
void convert(const std::uint8_t* bytes, int count, float* numbers) {
  for (int i = 0; i < count; ++i) numbers[i] = aboutZero(bytes[i]);
}

/// Such numbers have no more significant bits than a bfloat16: nothing is rounded.
void convert(const std::uint8_t* bytes, int count, bfloat16* numbers) {
  for (int i = 0; i < count; ++i) {
    const float number = aboutZero(bytes[i]);
    std::uint32_t bits;
    std::memcpy(&bits, &number, sizeof bits);
    numbers[i].bits = static_cast<std::uint16_t>(bits >> 16);
  }
}

template <class T, int kCopied>
inline void interleavePixel(const T (&rows)[kStackedFrames][3 * kRun + 1], int p, T* x) {
  constexpr int kStored = kStoredImageChannels<T>;
  T* pixel = x + p * kStored;
  for (int f = 0; f < kStackedFrames; ++f) {
    std::memcpy(static_cast<void*>(pixel + 3 * f), rows[f] + 3 * p, kCopied * sizeof(T));
  }
  std::memset(static_cast<void*>(pixel + kImageChannels), 0, (kStored - kImageChannels) * sizeof(T));
}

/// Lays `count` pixels of three frames, (count, 3) each, side by side. Four numbers are copied at a time, one register;
/// the fourth is overwritten by what comes next, so the last pixel is copied exactly.
template <class T>
void interleave(const T (&rows)[kStackedFrames][3 * kRun + 1], int count, T* x) {
  for (int p = 0; p < count - 1; ++p) interleavePixel<T, 4>(rows, p, x);
  interleavePixel<T, 3>(rows, count - 1, x);
}

}  // namespace

template <class T>
void stackFrames(const std::uint8_t* const frames[kStackedFrames], int pixels, T* x) {
  T rows[kStackedFrames][3 * kRun + 1];
  for (T(&row)[3 * kRun + 1] : rows) std::fill(std::begin(row), std::end(row), fromFloat<T>(aboutZero(0)));
  for (int start = 0; start < pixels; start += kRun) {
    const int count = std::min(kRun, pixels - start);
    for (int f = 0; f < kStackedFrames; ++f) {
      if (frames[f] != nullptr) convert(frames[f] + 3 * start, 3 * count, rows[f]);
    }
    interleave(rows, count, x + std::size_t(start) * kStoredImageChannels<T>);
  }
}

template void stackFrames<float>(const std::uint8_t* const[kStackedFrames], int, float*);
template void stackFrames<bfloat16>(const std::uint8_t* const[kStackedFrames], int, bfloat16*);

}  // namespace early_fusion::nn
