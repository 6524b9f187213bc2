#pragma once

#include <map>
#include <string>

namespace early_fusion::nodes {

/// Decides which transforms a tf2 buffer is to have. It leaves out those that tf2 would refuse with a warning for each:
/// repetitions, and those of a second publisher whose stamps are far behind. When the time jumps back, as with a bag
/// that is played in a loop, the buffer has to begin anew.
class TransformGate {
 public:
  enum class Verdict { kTake, kLeaveOut, kBeginAnew };  // kBeginAnew: empty the buffer, then take it

  /// @param cache_sec the length of the buffer's history: tf2 refuses older transforms.
  explicit TransformGate(double cache_sec) : cache_sec_(cache_sec) {}

  /// @param publisher its node. @param now_sec of a clock that does not jump.
  Verdict judge(const std::string& child_frame, const std::string& publisher, double stamp_sec, double now_sec);

  /// Names two nodes that publish the transform that was judged last with stamps far apart; else empty.
  const std::string& rivals() const { return rivals_; }

  void forget() { newest_.clear(); }

 private:
  struct Newest {
    double stamp_sec;
    double came_at_sec;
    std::string publisher;
  };

  double cache_sec_;
  std::map<std::string, Newest> newest_;  // by the child frame
  std::string rivals_;
};

}  // namespace early_fusion::nodes
