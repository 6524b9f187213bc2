#include "early_fusion/ros/robot/pan_tilt_driver_node.h"

#include <ros/init.h>

#include "early_fusion/ros/shared/run_node.h"

int main(int argc, char** argv) {
  namespace nodes = early_fusion::nodes;
  return nodes::runNode<nodes::PanTiltDriverNode>(argc, argv, "pan_tilt_driver", [] { ros::spin(); });
}
