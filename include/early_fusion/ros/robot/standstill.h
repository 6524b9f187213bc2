#pragma once

#include <optional>
#include <vector>

namespace early_fusion::nodes {

/// Since when a unit stands still, by what is measured of it: angles of joints or components of a pose.
class Standstill {
 public:
  /// @param tolerance values that differ by more than this from where a rest began are a motion.
  Standstill(std::size_t values, double tolerance) : tolerance_(tolerance), rests_(values) {}

  /// A measurement. Angles that differ by whole turns are equal. One that is older than the newest is ignored.
  /// @param at_sec when it was made, in a clock that does not jump.
  void add(std::size_t index, double value, double at_sec);

  /// A time span in the clock of add().
  struct Span {
    double since_sec;
    double until_sec;
  };

  /// During which all values are known to rest: until the newest measurement of the one that is measured least
  /// recently. Empty if some are not known yet.
  std::optional<Span> rest() const;

 private:
  struct Rest {
    double value;  // where it began
    Span span;
  };

  double tolerance_;
  std::vector<std::optional<Rest>> rests_;
};

}  // namespace early_fusion::nodes
