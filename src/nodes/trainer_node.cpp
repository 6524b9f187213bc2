#include "early_fusion/ros/trainer/trainer_node.h"

#include <ros/init.h>

#include "early_fusion/ros/shared/run_node.h"
#include "early_fusion/ros/trainer/session_start.h"

int main(int argc, char** argv) {
  namespace nodes = early_fusion::nodes;
  return nodes::runNode(argc, argv, "trainer", nodes::TrainerNode::Options().options(), [] {
    const nodes::TrainerNode::Options options = nodes::loadTrainerOptions();
    const auto world = early_fusion::world::loadWorld(options.session.world);
    nodes::TrainerNode node(options, nodes::startSession(options.session, world));
    const auto workers = nodes::startLocalWorkers(options, world);
    ros::spin();
  });
}
