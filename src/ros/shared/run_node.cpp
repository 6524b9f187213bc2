#include "early_fusion/ros/shared/run_node.h"

#include <ros/console.h>
#include <ros/init.h>
#include <ros/names.h>
#include <ros/node_handle.h>
#include <ros/param.h>
#include <ros/wall_timer.h>

#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>

#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

namespace {

bool wantsHelp(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--help") == 0 || std::strcmp(argv[i], "-h") == 0) return true;
  }
  return false;
}

void reportFailure(const std::string& reason) {
  ROS_FATAL("%s", reason.c_str());
  // The session's parameter, in the node's namespace or one above. A node outside the session must not end it.
  std::string parameter;
  if (std::getenv(kSessionVariable) != nullptr && ::ros::isInitialized() &&
      ::ros::param::search(kFailureParameter, parameter)) {
    ::ros::param::set(parameter, reason);
  }
}

constexpr double kClockPatienceSec = 3;

/// Says if simulated time stands still because nobody publishes it. By wall time, once.
::ros::WallTimer warnWithoutClock() {
  const auto check = [](const ::ros::WallTimerEvent&) {
    if (!::ros::Time::isSimTime() || !::ros::Time::now().isZero()) return;
    ROS_WARN(
        "the parameter /use_sim_time is true, but nobody has published %s for %.0f s, so time stands still at 0; "
        "play the bag with --clock, start the simulator, or: rosparam set /use_sim_time false, and start again",
        ::ros::names::resolve("/clock").c_str(), kClockPatienceSec);
  };
  return ::ros::NodeHandle().createWallTimer(::ros::WallDuration(kClockPatienceSec), check, true);
}

}  // namespace

int runNode(int argc, char** argv, const std::string& name, const core::OptionSet& options,
            const std::function<void()>& run) {
  if (wantsHelp(argc, argv)) {
    std::cout << name << "_node [_parameter:=value ...] [topic:=other_topic ...]\nPrivate parameters:\n"
              << describeParameters(options);
    return 0;
  }
  try {
    ::ros::init(argc, argv, name);
    ::ros::start();  // keeps the console alive after the node's last handle, so that the reason of a failure is logged
    const ::ros::WallTimer clock_check = warnWithoutClock();
    run();
    return 0;
  } catch (const std::exception& error) {
    reportFailure(error.what());
    return 1;
  }
}

}  // namespace early_fusion::nodes
