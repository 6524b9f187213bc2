#include "early_fusion/ros/trainer/session_monitor_node.h"

#include <ros/init.h>

#include "early_fusion/ros/shared/run_node.h"

int main(int argc, char** argv) {
  namespace nodes = early_fusion::nodes;
  return nodes::runNode<nodes::SessionMonitorNode>(argc, argv, "session_monitor", [] { ros::spin(); });
}
