#pragma once

#include <string>

#include "early_fusion/core/options.h"

namespace early_fusion::core {

/// The edge of a square image [px] is a multiple of kImageSizeStep up to kMaxImageSize.
inline constexpr int kImageSizeStep = 16;
inline constexpr int kMaxImageSize = 992;

/// Declares the edge of a square image.
inline void addImageSize(OptionSet& set, const std::string& name, int& field, const std::string& help) {
  set.addMultiple(name, field, kImageSizeStep, kImageSizeStep, kMaxImageSize, "px", help);
}

}  // namespace early_fusion::core
