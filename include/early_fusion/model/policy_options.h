#pragma once

#include <string>
#include <vector>

#include "early_fusion/core/options.h"

namespace early_fusion::model {

inline constexpr int kMaxChannels = 256;

/// The choices of PolicyOptions::precision.
inline std::vector<std::string> precisionNames() { return {"auto", "f32", "bf16"}; }

/// The options of a network and of its frames. PolicyKind::options names those that a kind reads.
struct PolicyOptions {
  std::string kind = "early_fusion";
  int channels = 16;                  ///< width of every block, of the hidden layer and of the embedding
  int fusion_block = 1;               ///< the goal joins the output of this block; 0: the frame stack itself
  std::string spatial_grid = "auto";  ///< whether the first block sees coordinates; auto: the kind decides
  double dropout = 0.5;               ///< after the hidden layer
  int image_size = 128;               ///< [px]
  std::string precision = "auto";     ///< f32, bf16, or auto: bf16 if the processor computes faster in it

  /// Horizontal field of view of the frames [degrees]. Not an option: it comes from the world that the policy is
  /// trained in, or from the weights file.
  double horizontal_fov_deg = 60;

  core::OptionSet options();

  /// @param automatic what spatial_grid: auto means.
  bool usesSpatialGrid(bool automatic) const { return spatial_grid == "auto" ? automatic : spatial_grid == "true"; }
};

}  // namespace early_fusion::model
