#pragma once

#include <string>

#include "early_fusion/core/options.h"

namespace early_fusion::model {

inline constexpr int kMaxChannels = 256;

/// config/models/*.yaml: the network, and the frames that it sees. PolicyKind says which of these a kind reads.
struct PolicyOptions {
  std::string kind = "early_fusion";
  int channels = 16;     ///< of every block, of the hidden layer and of the embedding; a multiple of 16 in [16, 256]
  int fusion_block = 1;  ///< the goal joins the output of this block, [0, 3]; 0: the image itself
  double dropout = 0.5;  ///< after the hidden layer, [0, 0.95]
  int image_size = 128;  ///< [px], a multiple of 16
  std::string precision = "auto";  ///< f32, bf16, or auto: bf16 where the processor computes in it natively

  /// Horizontal field of view of the frames [degrees]. Not an option: that of the world that the policy is trained in,
  /// or what the weights file says.
  double horizontal_fov_deg = 60;

  core::OptionSet options();

  /// @throws Error naming an option whose value is not allowed.
  void validate() const;
};

}  // namespace early_fusion::model
