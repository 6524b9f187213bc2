#include "early_fusion/ros/robot/tf_scene_node.h"

#include <ros/init.h>

#include "early_fusion/ros/shared/run_node.h"

int main(int argc, char** argv) {
  namespace nodes = early_fusion::nodes;
  return nodes::runNode<nodes::TfSceneNode>(argc, argv, "tf_scene", [] { ros::spin(); });
}
