#include "early_fusion/ros/trainer_node.h"

#include <ros/init.h>

#include "early_fusion/ros/run_node.h"

int main(int argc, char** argv) {
  namespace nodes = early_fusion::nodes;
  return nodes::runNode<nodes::TrainerNode>(argc, argv, "trainer", [] { ros::spin(); });
}
