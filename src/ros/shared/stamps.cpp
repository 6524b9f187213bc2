#include "early_fusion/ros/shared/stamps.h"

#include <cmath>
#include <cstdio>

namespace early_fusion::nodes {

namespace {

constexpr double kMaxClockDifferenceSec = 1;  // clocks of one robot differ by far less, and images come far sooner

}  // namespace

::ros::WallTime madeAt(const ::ros::Time& stamp, double max_age_sec) {
  const ::ros::WallTime now = ::ros::WallTime::now();
  if (stamp.isZero()) return now;
  const double age_sec = (::ros::Time::now() - stamp).toSec();
  return age_sec > 0 && age_sec < max_age_sec ? now - ::ros::WallDuration(age_sec) : now;
}

std::string clockHint(const std::string& whose, const ::ros::Time& stamp, const ::ros::Time& now) {
  const double behind_sec = (now - stamp).toSec();
  if (stamp.isZero() || std::abs(behind_sec) < kMaxClockDifferenceSec) return "";
  char difference[64];
  std::snprintf(difference, sizeof(difference), "%.1f s %s now", std::abs(behind_sec),
                behind_sec > 0 ? "behind" : "ahead of");
  return "; the stamp of " + whose + " is " + difference +
         ": check the clock of the machine that stamps it (NTP), or play a bag with --clock and /use_sim_time true";
}

}  // namespace early_fusion::nodes
