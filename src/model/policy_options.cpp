#include "early_fusion/model/policy_options.h"

#include "early_fusion/core/image_size.h"
#include "early_fusion/model/policy_kinds.h"
#include "early_fusion/model/vision_trunk.h"

namespace early_fusion::model {

namespace {

constexpr int kChannelsStep = 16;  // the number of floats in the widest register

}  // namespace

core::OptionSet PolicyOptions::options() {
  core::OptionSet set("policy");
  set.addChoice("kind", kind, policyKindNames(), "how the goal reaches the network");
  set.addMultiple("channels", channels, kChannelsStep, kChannelsStep, kMaxChannels, "",
                  "width of every block, of the hidden layer and of the goal's embedding");
  set.add("fusion_block", fusion_block, 0, kBlocks - 1, "",
          "the goal joins the output of this block; 0: the frame stack itself");
  set.addChoice("spatial_grid", spatial_grid, {"auto", "true", "false"},
                "whether the network also sees each pixel's coordinates; auto: only the attention kinds");
  set.add("dropout", dropout, 0.0, 0.95, "", "share of the hidden units that are dropped in a training step");
  core::addImageSize(set, "image_size", image_size, "edge of the square frames that the policy sees");
  set.addChoice("precision", precision, precisionNames(),
                "arithmetic of the convolutions; auto: bf16 if the processor computes faster in it, else f32");
  return set;
}

}  // namespace early_fusion::model
