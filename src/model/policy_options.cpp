#include "early_fusion/model/policy_options.h"

#include "early_fusion/core/error.h"
#include "early_fusion/core/image.h"
#include "early_fusion/model/policy_kinds.h"
#include "early_fusion/model/vision_trunk.h"

namespace early_fusion::model {

namespace {

constexpr int kChannelsStep = 16;  // the widest register's floats

}  // namespace

core::OptionSet PolicyOptions::options() {
  core::OptionSet set("policy");
  set.addChoice("kind", kind, policyKindNames(), "How the goal reaches the network.");
  set.add("channels", channels, kChannelsStep, kMaxChannels, "",
          "Channels of every block, of the hidden layer and of the goal's embedding; a multiple of 16.");
  set.add("fusion_block", fusion_block, 0, kBlocks - 1, "",
          "The block whose output the goal is joined to; 0 joins it to the image itself.");
  set.add("dropout", dropout, 0.0, 0.95, "", "Share of the hidden layer's units that are dropped in training.");
  set.add("image_size", image_size, core::kImageSizeStep, core::kMaxImageSize, "px",
          "Edge of the square frames that the policy sees; a multiple of 16.");
  set.addChoice("precision", precision, {"auto", "f32", "bf16"},
                "What convolutions compute in; auto is bf16 where the processor has it natively.");
  return set;
}

void PolicyOptions::validate() const {
  PolicyOptions copy = *this;
  core::OptionSet set = copy.options();
  for (const core::Option& option : set.options()) set.set(option.name, option.get(), "policy");
  if (channels % kChannelsStep != 0) {
    throw core::Error("policy: channels: '" + std::to_string(channels) + "' is not a multiple of 16");
  }
  if (!core::isImageSize(image_size)) {
    throw core::Error("policy: image_size: '" + std::to_string(image_size) + "' is not " + core::kImageSizes);
  }
}

}  // namespace early_fusion::model
