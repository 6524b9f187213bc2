#pragma once

// glog, which torch includes, and gtest are both in the tests.
#include <torch/torch.h>

#include <string>
#include <vector>

#include "early_fusion/model/policy_options.h"
#include "early_fusion/model/sample.h"

namespace early_fusion::model {

/// The networks of all kinds, written with libtorch's own modules: the second implementation.
struct TorchNetwork : torch::nn::Module {
  TorchNetwork(const PolicyOptions& options, int items)
      : options_(options),
        fuses_early_(options.kind == "early_fusion"),
        attends_(options.kind == "attention_map" || options.kind == "softmax_attention_map"),
        grid_(options.usesSpatialGrid(attends_)) {
    const int c = options.channels;
    for (int b = 0; b < 4; ++b) {
      const int image_channels = b > 0 ? c : grid_ ? 11 : 9;
      const int in = image_channels + (fuses_early_ && b == options.fusion_block ? c : 0);
      auto block = std::make_shared<torch::nn::Module>("block");
      convolutions_.push_back(
          block->register_module("conv", torch::nn::Conv2d(torch::nn::Conv2dOptions(in, c, 3).padding(1))));
      norms_.push_back(block->register_module("norm", torch::nn::BatchNorm2d(c)));
      register_module("block" + std::to_string(b + 1), block);
    }
    const int edge = options.image_size / 16;
    const int map = c * edge * edge;
    embedding_ = register_module("embedding", torch::nn::Linear(items, c));
    hidden_ = register_module("hidden", torch::nn::Linear(attends_ ? 2 * c : fuses_early_ ? map : map + c, c));
    output_ = register_module("output", torch::nn::Linear(c, core::kActionCount));
  }

  /// images (N,9,S,S) as TorchBatch makes them, counts (N * k,items): those of an image side by side -> logits (N *
  /// k,7).
  torch::Tensor forward(const torch::Tensor& images, const torch::Tensor& counts) {
    const torch::Tensor goal = embedding_->forward(counts);
    torch::Tensor x = grid_ ? withGrid(images) : images;
    for (int b = 0; b < 4; ++b) {
      if (fuses_early_ && b == options_.fusion_block) x = withTiled(oneARow(x, goal), goal);
      x = norms_[b]->forward(torch::relu(torch::max_pool2d(convolutions_[b]->forward(x), 2)));
    }
    x = torch::relu(hidden_->forward(features(oneARow(x, goal), goal)));
    return output_->forward(torch::dropout(x, options_.dropout, is_training()));
  }

  /// The map of each row's image.
  static torch::Tensor oneARow(const torch::Tensor& x, const torch::Tensor& goal) {
    return x.size(0) == goal.size(0) ? x : x.repeat_interleave(goal.size(0) / x.size(0), 0);
  }

  static torch::Tensor withGrid(const torch::Tensor& x) {
    const std::int64_t size = x.size(2);
    const torch::Tensor centres = (2 * torch::arange(size, torch::kFloat) + 1 - size) / size;
    const torch::Tensor columns = centres.view({1, 1, 1, size}).expand({x.size(0), 1, size, size});
    const torch::Tensor rows = centres.view({1, 1, size, 1}).expand({x.size(0), 1, size, size});
    return torch::cat({x, columns, rows}, 1);
  }

  static torch::Tensor withTiled(const torch::Tensor& x, const torch::Tensor& goal) {
    return torch::cat({x, goal.unsqueeze(2).unsqueeze(3).expand({x.size(0), goal.size(1), x.size(2), x.size(3)})}, 1);
  }

  /// What the head decides from.
  torch::Tensor features(const torch::Tensor& map, const torch::Tensor& goal) const {
    if (fuses_early_) return map.flatten(1);
    if (!attends_) return torch::cat({map.flatten(1), goal}, 1);
    const torch::Tensor regions = map.flatten(2);                                    // (N,C,regions)
    const torch::Tensor scores = torch::bmm(goal.unsqueeze(1), regions).squeeze(1);  // (N,regions)
    const torch::Tensor weights = options_.kind == "attention_map" ? scores : torch::softmax(scores, 1);
    return torch::cat({torch::bmm(regions, weights.unsqueeze(2)).squeeze(2), goal}, 1);
  }

  PolicyOptions options_;
  bool fuses_early_, attends_, grid_;
  std::vector<torch::nn::Conv2d> convolutions_;
  std::vector<torch::nn::BatchNorm2d> norms_;
  torch::nn::Linear embedding_{nullptr}, hidden_{nullptr}, output_{nullptr};
};

/// Samples as libtorch takes them.
struct TorchBatch {
  TorchBatch(const std::vector<Sample>& samples, int image_size, int items) {
    const std::int64_t n = static_cast<std::int64_t>(samples.size());
    images = torch::zeros({n, 9, image_size, image_size});
    counts = torch::zeros({n, items});
    targets = torch::zeros({n, core::kActionCount});
    unlikelihoods = torch::zeros({n, core::kActionCount});
    weights = torch::zeros({n});
    for (std::int64_t i = 0; i < n; ++i) {
      torch::Tensor newer = torch::full({3, image_size, image_size}, 128.f);
      for (int f = 0; f < core::kStackedFrames; ++f) {
        const std::uint8_t* bytes = samples[i].observation.frames[f];
        torch::Tensor frame = torch::zeros({3, image_size, image_size});  // black
        if (bytes != nullptr) {
          frame = torch::from_blob(const_cast<std::uint8_t*>(bytes), {image_size, image_size, 3}, torch::kUInt8)
                      .permute({2, 0, 1})
                      .to(torch::kFloat);
        }
        images[i].slice(0, 3 * f, 3 * f + 3).copy_((f == 0 ? frame - newer : newer - frame) / 64);
        newer = frame;
      }
      for (int item : *samples[i].observation.request) counts[i][item] += 1;
      for (int k = 0; k < core::kActionCount; ++k) {
        targets[i][k] = samples[i].target[k];
        unlikelihoods[i][k] = samples[i].unlikelihood[k];
      }
      weights[i] = samples[i].weight;
    }
  }

  torch::Tensor loss(const torch::Tensor& logits) const {
    const torch::Tensor logs = torch::log_softmax(logits, 1);
    const torch::Tensor losses = -(targets * logs + unlikelihoods * torch::log1p(-logs.exp())).sum(1);
    return (weights * losses).sum() / weights.sum();
  }

  torch::Tensor images, counts, targets, unlikelihoods, weights;
};

}  // namespace early_fusion::model
