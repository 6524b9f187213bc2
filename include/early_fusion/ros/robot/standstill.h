#pragma once

#include <optional>
#include <vector>

namespace early_fusion::nodes {

/// Since when a unit stands still, by what is measured of it: angles of joints or components of a pose.
class Standstill {
 public:
  /// @param tolerance values that differ by more than this from where a rest began are a motion.
  Standstill(std::size_t values, double tolerance) : tolerance_(tolerance), rests_(values) {}

  /// A measurement. Angles that differ by whole turns are equal. @param now_sec of a clock that does not jump.
  void add(std::size_t index, double value, double now_sec);

  /// Since when all values rest, in the clock of add(); empty if some are not known yet.
  std::optional<double> since() const;

 private:
  struct Rest {
    double value;
    double since_sec;
  };

  double tolerance_;
  std::vector<std::optional<Rest>> rests_;
};

}  // namespace early_fusion::nodes
