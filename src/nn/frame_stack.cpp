#include "early_fusion/nn/frame_stack.h"

#include <array>

namespace early_fusion::nn {

namespace {

template <class T>
std::array<T, 256> makeByteTable() {
  std::array<T, 256> table;
  for (int byte = 0; byte < 256; ++byte) table[byte] = fromFloat<T>(static_cast<float>(byte));
  return table;
}

}  // namespace

template <class T>
void stackFrames(const std::uint8_t* const frames[kStackedFrames], int pixels, T* x) {
  static const std::array<T, 256> table = makeByteTable<T>();
  constexpr int kStored = kStoredImageChannels<T>;
  for (int f = 0; f < kStackedFrames; ++f) {
    const std::uint8_t* frame = frames[f];
    for (int p = 0; p < pixels; ++p) {
      for (int c = 0; c < 3; ++c) x[std::size_t(p) * kStored + 3 * f + c] = table[frame ? frame[3 * p + c] : 0];
    }
  }
  for (int p = 0; p < pixels; ++p) {
    for (int c = kImageChannels; c < kStored; ++c) x[std::size_t(p) * kStored + c] = fromFloat<T>(0.f);
  }
}

template void stackFrames<float>(const std::uint8_t* const[kStackedFrames], int, float*);
template void stackFrames<bfloat16>(const std::uint8_t* const[kStackedFrames], int, bfloat16*);

}  // namespace early_fusion::nn
