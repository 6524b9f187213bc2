#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "early_fusion/core/options.h"

namespace early_fusion::nodes {

/// What a node tells /diagnostics (REP-107): how often things happen, what it dropped, and what it adds itself.
///
/// Level WARN while messages were dropped since the last report. One thread: the node's callbacks.
class Health {
 public:
  /// Adds values of the moment, such as the weights in use, to a report.
  using Reporter = std::function<void(diagnostic_updater::DiagnosticStatusWrapper&)>;

  explicit Health(Reporter reporter = {});

  /// One more of `event` ("images"): reported as a total and a rate.
  void count(const std::string& event);

  /// A message that cannot be used. Counted, and logged as a warning at most once in 5 s for each kind.
  /// @param kind a few words, the same for all messages of its kind: "stale action".
  /// @param detail names the offending value, and what to do about it.
  void drop(const std::string& kind, const std::string& detail);

 private:
  struct Counter {
    std::uint64_t total = 0;
    std::uint64_t reported = 0;
    ::ros::WallTime last_warning;
  };

  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  Reporter reporter_;
  std::map<std::string, Counter> events_;
  std::map<std::string, Counter> drops_;
  ::ros::WallTime last_report_ = ::ros::WallTime::now();
  diagnostic_updater::Updater updater_;
  ::ros::WallTimer timer_;
};

/// The parameter that diagnostic_updater reads by itself, declared so that it is known and in range.
void addDiagnosticPeriod(core::OptionSet& options, double& period_sec);

}  // namespace early_fusion::nodes
