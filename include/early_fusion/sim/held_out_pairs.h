#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "early_fusion/core/options.h"
#include "early_fusion/core/vocabulary.h"

namespace early_fusion::sim {

/// How the pairs of items are divided into trained and held-out pairs, so that a policy can be tested on combinations
/// that it has never seen (Walsman et al. 2019). Options of training.
struct PairSplit {
  double held_out_pairs = 0;              ///< share of the pairs that are held out; 0: none
  std::uint64_t held_out_pairs_seed = 1;  ///< decides which

  core::OptionSet options();
};

/// Which requests episodes have: any, only those without a held-out pair, or only those with one.
enum class PairChoice { kAll, kTrained, kHeldOut };

/// Their names as option values: all, trained, held_out.
const std::vector<std::string>& pairChoiceNames();
const std::string& pairChoiceName(PairChoice choice);

/// @throws Error naming the known ones.
PairChoice pairChoiceFromName(const std::string& name);

/// The pairs of items that are held out from training. A pair is unordered, and an item twice is a pair, too.
///
/// The split depends on the number of items, the share and the seed only. The pairs of two items and the pairs of an
/// item twice are divided separately, each by the share. So half of 16 items' 120 + 16 pairs are 60 + 8, which are 128
/// of the 256 ordered pairs.
class HeldOutPairs {
 public:
  HeldOutPairs(int items, const PairSplit& split);

  /// Whether any two of the requested items are a held-out pair. So nothing that is left of a request without one has
  /// one.
  bool areIn(const core::Request& request) const;

  /// Whether an episode may have this request.
  bool allow(PairChoice choice, const core::Request& request) const {
    return choice == PairChoice::kAll || areIn(request) == (choice == PairChoice::kHeldOut);
  }

 private:
  int items_;
  std::vector<bool> held_out_;  // (items, items), symmetric; empty if nothing is held out
};

}  // namespace early_fusion::sim
