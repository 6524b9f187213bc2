// A stream of requests and images, as the policy node pairs and answers them.
#include <boost/make_shared.hpp>

#include "early_fusion/model/policy_file.h"
#include "early_fusion/model/policy_kinds.h"
#include "early_fusion/ros/policy/acting_policy.h"
#include "early_fusion/ros/policy/request_pairing.h"
#include "fuzz_target.h"

using namespace early_fusion;

namespace {

constexpr int kFrameSize = 16;
constexpr std::size_t kCapacity = 8, kMaxBytes = 1 << 20;

nodes::ActingPolicy makeActing() {
  model::PolicyOptions options;
  options.image_size = kFrameSize;
  nodes::ActingPolicy acting;
  const auto policy = model::makePolicy(options, core::Vocabulary({"mug", "bowl", "plate"}), 1);
  acting.load(model::savePolicy(*policy, {}), "policy", {"argmax", 0, "f32"});
  return acting;
}

Request readRequest(fuzz::Reader& input) {
  Request request;
  request.header.stamp.sec = input.number<std::uint8_t>();
  request.episode = input.number<std::uint8_t>();
  request.step = input.number<std::uint32_t>();
  const int items = input.number<std::uint8_t>();
  for (int i = 0; i < items && !input.empty(); ++i) request.items.push_back(input.text());
  return request;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static nodes::ActingPolicy policy = makeActing();
  static const core::Image frame(kFrameSize, kFrameSize);
  fuzz::Reader input(data, size);
  nodes::RequestPairing pairing(kCapacity, kMaxBytes);
  while (!input.empty()) {
    std::optional<nodes::RequestPairing::Pair> pair;
    if (input.number<std::uint8_t>() % 2 == 0) {
      const auto image = boost::make_shared<sensor_msgs::Image>();
      image->header.stamp.sec = input.number<std::uint8_t>();
      pair = pairing.add(image);
    } else {
      pair = pairing.add(boost::make_shared<Request>(readRequest(input)));
    }
    if (!pair) continue;
    fuzz::require(pair->first->header.stamp == pair->second->header.stamp, "two stamps in a pair");
    const Request& request = *pair->second;
    fuzz::allowError([&] {
      const nodes::Decision decision = policy.decide(frame, request.items, request.episode, request.step);
      fuzz::require(decision.frames >= 1 && decision.frames <= 3, "the number of frames");
      if (!request.items.empty()) policy.likeliestItem(decision.action);
    });
  }
  return 0;
}
