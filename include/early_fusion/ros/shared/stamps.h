#pragma once

#include <ros/time.h>

#include <string>

namespace early_fusion::nodes {

/// When a message with this stamp was made, in wall time. A message without a stamp, or with one in the future, was
/// made now. @param max_age_sec an older stamp is of another clock, so it counts as now.
::ros::WallTime madeAt(const ::ros::Time& stamp, double max_age_sec);

/// How far a stamp is from `now` and what to do, for the end of an error text. Empty if it is less than a second, or if
/// there is no stamp. @param whose "the image".
std::string clockHint(const std::string& whose, const ::ros::Time& stamp, const ::ros::Time& now);

}  // namespace early_fusion::nodes
