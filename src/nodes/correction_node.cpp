#include "early_fusion/ros/correction/correction_node.h"

#include <ros/init.h>

#include "early_fusion/ros/shared/run_node.h"

int main(int argc, char** argv) {
  namespace nodes = early_fusion::nodes;
  return nodes::runNode<nodes::CorrectionNode>(argc, argv, "correction", [] { ros::spin(); });
}
