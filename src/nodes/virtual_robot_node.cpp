#include "early_fusion/ros/virtual_robot/virtual_robot_node.h"

#include <ros/init.h>

#include "early_fusion/ros/shared/run_node.h"

int main(int argc, char** argv) {
  namespace nodes = early_fusion::nodes;
  return nodes::runNode<nodes::VirtualRobotNode>(argc, argv, "virtual_robot", [] { ros::spin(); });
}
