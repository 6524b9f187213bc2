#include "early_fusion/sim/held_out_pairs.h"

#include <cmath>
#include <utility>

#include "early_fusion/core/names.h"
#include "early_fusion/core/random.h"

namespace early_fusion::sim {

namespace {

constexpr double kMaxShare = 0.9;  // some pairs must be left to train on

using Pair = std::pair<int, int>;

/// A random part of the pairs.
std::vector<Pair> drawn(std::vector<Pair> pairs, double share, core::Random& random) {
  random.shuffle(pairs);
  pairs.resize(static_cast<std::size_t>(std::lround(share * static_cast<double>(pairs.size()))));
  return pairs;
}

}  // namespace

core::OptionSet PairSplit::options() {
  core::OptionSet set("pairs");
  set.add("held_out_pairs", held_out_pairs, 0, kMaxShare, "",
          "share of the pairs of items that are held out: no request in training contains one");
  set.add("held_out_pairs_seed", held_out_pairs_seed, "decides which pairs are held out");
  return set;
}

const std::vector<std::string>& pairChoiceNames() {
  static const std::vector<std::string> names{"all", "trained", "held_out"};
  return names;
}

const std::string& pairChoiceName(PairChoice choice) { return pairChoiceNames()[static_cast<int>(choice)]; }

PairChoice pairChoiceFromName(const std::string& name) {
  return static_cast<PairChoice>(core::indexOf(name, pairChoiceNames(), "choice of pairs"));
}

HeldOutPairs::HeldOutPairs(int items, const PairSplit& split) : items_(items) {
  if (split.held_out_pairs == 0) return;
  held_out_.resize(static_cast<std::size_t>(items) * items);
  std::vector<Pair> of_two, of_one;
  for (int a = 0; a < items; ++a) {
    of_one.emplace_back(a, a);
    for (int b = a + 1; b < items; ++b) of_two.emplace_back(a, b);
  }
  core::Random random(split.held_out_pairs_seed, {core::kHeldOutPairsStream});
  for (const std::vector<Pair>& pairs : {of_two, of_one}) {
    for (const auto& [a, b] : drawn(pairs, split.held_out_pairs, random)) {
      held_out_[a * items_ + b] = held_out_[b * items_ + a] = true;
    }
  }
}

bool HeldOutPairs::areIn(const core::Request& request) const {
  if (held_out_.empty()) return false;
  for (std::size_t i = 0; i < request.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (held_out_[request[i] * items_ + request[k]]) return true;
    }
  }
  return false;
}

}  // namespace early_fusion::sim
