#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "early_fusion/core/random.h"
#include "early_fusion/nn/attention_pooling.h"
#include "early_fusion/nn/conv_block.h"

namespace early_fusion::nn {

using Numbers = std::vector<double>;

/// Numbers that float holds exactly.
inline Numbers randomNumbers(std::size_t count, core::Random& random, double low = -1, double high = 1) {
  Numbers numbers(count);
  for (double& number : numbers) number = static_cast<float>(random.uniform(low, high));
  return numbers;
}

/// y (H,W,out) of a 3x3 convolution with zero padding, x (H,W,in), weights OIHW.
inline Numbers naiveConvolution(const Numbers& x, const Numbers& weights, int height, int width, int in, int out) {
  Numbers y(std::size_t(height) * width * out);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      for (int tap = 0; tap < 9; ++tap) {
        const int from_row = row + tap / 3 - 1, from_column = column + tap % 3 - 1;
        if (from_row < 0 || from_row >= height || from_column < 0 || from_column >= width) continue;
        for (int o = 0; o < out; ++o) {
          for (int i = 0; i < in; ++i) {
            y[(row * width + column) * out + o] +=
                weights[(o * in + i) * 9 + tap] * x[(from_row * width + from_column) * in + i];
          }
        }
      }
    }
  }
  return y;
}

/// relu(max over 2x2 windows of y + bias): y (H,W,C) -> (H/2,W/2,C).
inline Numbers naivePool(const Numbers& y, const Numbers& bias, int height, int width, int channels) {
  Numbers z(std::size_t(height / 2) * (width / 2) * channels, 0.0);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      for (int c = 0; c < channels; ++c) {
        double& pooled = z[((row / 2) * (width / 2) + column / 2) * channels + c];
        pooled = std::max(pooled, y[(row * width + column) * channels + c] + bias[c]);
      }
    }
  }
  return z;
}

/// A ConvBlock in double, one plain step after the other: the goal is tiled and concatenated, as the paper has it, and
/// so are the coordinates.
struct NaiveConvBlock {
  ConvBlockShape shape;
  int images;
  Numbers weight, bias, scale, shift;  // conv.weight, conv.bias, norm.weight, norm.bias
  Numbers x;                           // (images, size, size, image)
  Numbers goals;                       // (images, goal)
  Numbers mean, variance;              // of the batch, after forward()
  Numbers ratio, distance;             // constants of batch renormalisation; empty: 1 and 0

  NaiveConvBlock(const ConvBlockShape& block_shape, int batch, core::Random& random)
      : shape(block_shape), images(batch) {
    const int in = inChannels();
    weight = randomNumbers(std::size_t(shape.out_channels) * in * 9, random, -0.3, 0.3);
    bias = randomNumbers(shape.out_channels, random, -1.0, 0.3);  // ReLU must have something to do
    scale = randomNumbers(shape.out_channels, random, 0.5, 1.5);
    shift = randomNumbers(shape.out_channels, random);
    x = randomNumbers(std::size_t(images) * shape.size * shape.size * shape.image_channels, random,
                      -1 / shape.input_scale, 1 / shape.input_scale);
    goals = randomNumbers(std::size_t(images) * shape.goal_channels, random);
  }

  int inChannels() const { return shape.image_channels + (shape.spatial_grid ? 2 : 0) + shape.goal_channels; }

  /// What ReLU lets through, (images, size/2, size/2, out).
  Numbers pooled() const {
    const int in = inChannels(), pixels = shape.size * shape.size;
    Numbers all;
    for (int image = 0; image < images; ++image) {
      Numbers concatenated(std::size_t(pixels) * in);
      for (int p = 0; p < pixels; ++p) {
        double* to = &concatenated[p * in];
        for (int i = 0; i < shape.image_channels; ++i) {
          *to++ = shape.input_scale * x[(image * pixels + p) * shape.image_channels + i];
        }
        if (shape.spatial_grid) {
          for (const int at : {p % shape.size, p / shape.size}) *to++ = (at + 0.5) / shape.size * 2 - 1;
        }
        for (int i = 0; i < shape.goal_channels; ++i) *to++ = goals[image * shape.goal_channels + i];
      }
      const Numbers y = naiveConvolution(concatenated, weight, shape.size, shape.size, in, shape.out_channels);
      const Numbers z = naivePool(y, bias, shape.size, shape.size, shape.out_channels);
      all.insert(all.end(), z.begin(), z.end());
    }
    return all;
  }

  Numbers normalised(Numbers z, const Numbers& means, const Numbers& variances) const {
    for (std::size_t i = 0; i < z.size(); ++i) {
      const int c = static_cast<int>(i % shape.out_channels);
      z[i] = (z[i] - means[c]) / std::sqrt(variances[c] + 1e-5);
      if (!ratio.empty()) z[i] = ratio[c] * z[i] + distance[c];
      z[i] = scale[c] * z[i] + shift[c];
    }
    return z;
  }

  /// With batch statistics, (images, size/2, size/2, out).
  Numbers forward() {
    const Numbers z = pooled();
    const double count = double(z.size()) / shape.out_channels;
    mean.assign(shape.out_channels, 0);
    variance.assign(shape.out_channels, 0);
    for (std::size_t i = 0; i < z.size(); ++i) mean[i % shape.out_channels] += z[i] / count;
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double off = z[i] - mean[i % shape.out_channels];
      variance[i % shape.out_channels] += off * off / count;
    }
    return normalised(z, mean, variance);
  }
};

struct NaiveAttention {
  Numbers weights;  // (regions)
  Numbers pooled;   // (channels)
};

/// AttentionPooling in double: map (channels, regions), query (channels).
inline NaiveAttention naiveAttentionPooling(AttentionWeights kind, const Numbers& map, const Numbers& query) {
  const std::size_t channels = query.size(), regions = map.size() / channels;
  NaiveAttention result{Numbers(regions), Numbers(channels)};
  double sum = 0;
  for (std::size_t i = 0; i < regions; ++i) {
    double score = 0;
    for (std::size_t c = 0; c < channels; ++c) score += query[c] * map[c * regions + i];
    result.weights[i] = kind == AttentionWeights::kSoftmax ? std::exp(score) : score;
    sum += result.weights[i];
  }
  for (std::size_t i = 0; i < regions; ++i) {
    if (kind == AttentionWeights::kSoftmax) result.weights[i] /= sum;
    for (std::size_t c = 0; c < channels; ++c) result.pooled[c] += result.weights[i] * map[c * regions + i];
  }
  return result;
}

/// A channels-last map in another layout.
template <class T>
AlignedBuffer<T> inLayout(const T* channels_last, const MapShape& map) {
  AlignedBuffer<T> numbers(std::size_t(map.positions()) * map.channels);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[map.at(i / map.channels, i % map.channels)] = channels_last[i];
  }
  return numbers;
}

/// A ConvBlock with the naive one's numbers, and what it makes of them.
template <class T>
struct FastConvBlock {
  FastConvBlock(const NaiveConvBlock& naive, bool input_gradient, int thread_count)
      : images(naive.images),
        threads(thread_count),
        block(parameters, "block", naive.shape, input_gradient, thread_count),
        x(naive.x.size()),
        scratch(std::size_t(thread_count) * naive.shape.size * naive.shape.size * naive.shape.out_channels),
        dx(naive.x.size()) {
    set("block.conv.weight", naive.weight);
    set("block.conv.bias", naive.bias);
    set("block.norm.weight", naive.scale);
    set("block.norm.bias", naive.shift);
    for (std::size_t i = 0; i < naive.x.size(); ++i) x[i] = fromFloat<T>(static_cast<float>(naive.x[i]));
    goals.resize(images, naive.shape.goal_channels);
    for (Eigen::Index i = 0; i < goals.size(); ++i) goals.data()[i] = static_cast<float>(naive.goals[i]);
    dgoals = Matrix::Zero(images, naive.shape.goal_channels);
    block.loadWeights();
    block.reserve(images);
  }

  void set(const std::string& name, const Numbers& numbers) {
    for (const TensorSlice& slice : parameters.parameterSlices()) {
      for (std::size_t i = 0; slice.name == name && i < slice.size; ++i) {
        parameters.values()[slice.offset + i] = static_cast<float>(numbers.at(i));
      }
    }
  }

  std::size_t inputSize() const { return x.size() / images; }
  const float* goal(int image) const { return goals.cols() > 0 ? goals.row(image).data() : nullptr; }
  T* scratchOf(int thread) { return scratch.data() + scratch.size() / threads * thread; }

  Numbers forward() {
    for (int i = 0; i < images; ++i) {
      const int thread = i % threads;
      block.convolve(thread, x.data() + i * inputSize(), scratchOf(thread));
      block.pool(thread, i, scratchOf(thread), goal(i));
    }
    block.finishForward(images, normalisation);
    Numbers all;
    AlignedBuffer<T> out(block.outputSize());
    for (int i = 0; i < images; ++i) {
      block.output(i, out.data());
      for (int j = 0; j < block.outputSize(); ++j) all.push_back(toFloat(out[j]));
    }
    return all;
  }

  /// Backward of sum(factors * output); the gradients are then in parameters, dx and dgoals.
  void backward(const Numbers& factors) {
    for (int i = 0; i < images; ++i) {
      for (int j = 0; j < block.outputSize(); ++j) {
        block.outputGradient(i)[j] = fromFloat<T>(static_cast<float>(factors[i * block.outputSize() + j]));
      }
      block.sumOutputGradient(i);
    }
    block.beginBackward(images);
    const ImageShares shares(images);
    for (int share = 0; share < shares.count; ++share) {
      const int thread = share % threads;
      for (int i = shares.first(share); i < shares.first(share + 1); ++i) {
        block.unpool(i, false, scratchOf(thread));
        block.backward(thread, share, i == shares.first(share), x.data() + i * inputSize(), scratchOf(thread),
                       dx.data() + i * inputSize());
      }
    }
    block.finishBackward(images, shares, goals, dgoals, threads);
  }

  Numbers predict(bool all_threads) {
    block.loadRunningStatistics();
    Numbers all;
    AlignedBuffer<T> out(block.outputSize());
    const ConvBlockShape& shape = block.shape();
    const MapShape map{shape.size, shape.size, shape.image_channels, block.predictionLayout()};
    for (int i = 0; i < images; ++i) {
      const AlignedBuffer<T> in = inLayout(x.data() + i * inputSize(), map);
      if (all_threads) {
        block.predictOnAllThreads(in.data(), goal(i), scratchOf(0), MapLayout::kChannelsLast, out.data(), threads);
      } else {
        block.predict(i % threads, in.data(), goal(i), scratchOf(i % threads), MapLayout::kChannelsLast, out.data());
      }
      for (int j = 0; j < block.outputSize(); ++j) all.push_back(toFloat(out[j]));
    }
    return all;
  }

  Numbers gradient(const std::string& name) const {
    return tensor(name, parameters.parameterSlices(), parameters.gradients());
  }
  Numbers buffer(const std::string& name) const {
    return tensor(name, parameters.bufferSlices(), parameters.buffers());
  }

  static Numbers tensor(const std::string& name, const std::vector<TensorSlice>& slices,
                        const Eigen::VectorXf& numbers) {
    for (const TensorSlice& slice : slices) {
      if (slice.name != name) continue;
      const float* from = numbers.data() + slice.offset;
      return Numbers(from, from + slice.size);
    }
    return {};
  }

  int images;
  int threads;
  Normalisation normalisation = Normalisation::kBatch;
  Parameters parameters;
  ConvBlock<T> block;
  AlignedBuffer<T> x, scratch, dx;
  Matrix goals, dgoals;
};

/// The largest difference, as a share of the largest expected number, which counts as 0.01 at least.
inline double worstError(const Numbers& values, const Numbers& expected) {
  double worst = values.size() == expected.size() ? 0 : INFINITY;
  double largest = 0.01;
  for (double number : expected) largest = std::max(largest, std::abs(number));
  for (std::size_t i = 0; i < std::min(values.size(), expected.size()); ++i) {
    const double error = std::abs(values[i] - expected[i]) / largest;
    if (!(error <= worst)) worst = error;
  }
  return worst;
}

}  // namespace early_fusion::nn
