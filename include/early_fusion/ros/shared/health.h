#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/ros/shared/node_context.h"
#include "early_fusion/ros/shared/wall_throttle.h"

namespace early_fusion::nodes {

/// A node's report on /diagnostics (REP-107): counts and rates of events, dropped messages, and the node's own values.
///
/// The level is WARN if messages were dropped since the last report. For use from the node's callbacks, in one thread.
class Health {
 public:
  /// Adds the node's own values, such as the current weights, to a report.
  using Reporter = std::function<void(diagnostic_updater::DiagnosticStatusWrapper&)>;

  explicit Health(Reporter reporter = {}, const NodeContext& context = NodeContext());

  /// Counts one event of a kind ("images"). Reported as a total and a rate.
  void count(const std::string& event);

  /// Counts a message that cannot be used, and logs a warning, at most once in 5 s for each kind.
  /// @param kind a few words that are the same for all messages of the kind: "stale action".
  /// @param detail names the offending value and says what to do.
  void drop(const std::string& kind, const std::string& detail);

 private:
  struct Counter {
    std::uint64_t total = 0;
    std::uint64_t reported = 0;
    WallThrottle warning{5};  // seconds between two lines of the log
  };

  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  Reporter reporter_;
  std::map<std::string, Counter> events_;
  std::map<std::string, Counter> drops_;
  ::ros::WallTime last_report_ = ::ros::WallTime::now();
  diagnostic_updater::Updater updater_;
  ::ros::WallTimer timer_;
};

/// Declares the parameter that diagnostic_updater reads, so that it is a known option with a range.
void addDiagnosticPeriod(core::OptionSet& options, double& period_sec);

}  // namespace early_fusion::nodes
