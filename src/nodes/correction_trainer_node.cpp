#include "early_fusion/ros/correction/correction_trainer_node.h"

#include <ros/init.h>

#include "early_fusion/ros/shared/run_node.h"

int main(int argc, char** argv) {
  namespace nodes = early_fusion::nodes;
  return nodes::runNode(argc, argv, "correction_trainer", nodes::CorrectionTrainerNode::Options().options(), [] {
    const nodes::CorrectionTrainerNode::Options options = nodes::loadCorrectionOptions();
    auto session = std::make_unique<early_fusion::learning::CorrectionSession>(
        options.correction, early_fusion::world::loadWorld(options.correction.world));
    if (!options.bag.empty()) {
      return nodes::trainOnBag(*session, options.bag, [](const std::string& line) { ROS_INFO("%s", line.c_str()); });
    }
    nodes::CorrectionTrainerNode node(options, std::move(session));
    ros::spin();
  });
}
