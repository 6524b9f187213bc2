#include "early_fusion/ros/shared/health.h"

#include <ros/console.h>

namespace early_fusion::nodes {

namespace {

constexpr double kCheckPeriodSec = 0.1;

}  // namespace

Health::Health(Reporter reporter, const NodeContext& context)
    : reporter_(std::move(reporter)), updater_(context.node, ::ros::NodeHandle(context.name), context.name) {
  updater_.setHardwareID("none");
  updater_.add("status", [this](diagnostic_updater::DiagnosticStatusWrapper& status) { report(status); });
  ::ros::NodeHandle node = context.node;
  // The updater's own update() goes by ROS time, which stands still without a clock.
  timer_ = node.createWallTimer(::ros::WallDuration(kCheckPeriodSec), [this](const ::ros::WallTimerEvent&) {
    const bool due = ::ros::WallTime::now() - last_report_ >= ::ros::WallDuration(updater_.getPeriod());
    if (due) updater_.force_update();
  });
}

void Health::count(const std::string& event) { ++events_[event].total; }

void Health::drop(const std::string& kind, const std::string& detail) {
  Counter& counter = drops_[kind];
  ++counter.total;
  if (!counter.warning.due()) return;
  ROS_WARN("dropped (%s, %lu so far): %s", kind.c_str(), static_cast<unsigned long>(counter.total), detail.c_str());
}

void Health::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const ::ros::WallTime now = ::ros::WallTime::now();
  const double elapsed_sec = std::max((now - last_report_).toSec(), 1e-3);
  last_report_ = now;
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "running");
  for (auto& [event, counter] : events_) {
    status.add(event, counter.total);
    status.addf(event + " per second", "%.1f", (counter.total - counter.reported) / elapsed_sec);
    counter.reported = counter.total;
  }
  for (auto& [kind, counter] : drops_) {
    status.add("dropped: " + kind, counter.total);
    if (counter.total > counter.reported)
      status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, "dropped: " + kind);
    counter.reported = counter.total;
  }
  if (reporter_) reporter_(status);
}

void addDiagnosticPeriod(core::OptionSet& options, double& period_sec) {
  options.add("diagnostic_period", period_sec, 0.1, 3600, "s", "time between two reports on /diagnostics");
}

}  // namespace early_fusion::nodes
