#include <iostream>

#include "command.h"
#include "early_fusion/core/error.h"

int main(int argc, char** argv) {
  CLI::App app(
      "Trains, scores and shows policies that point a pan-tilt camera at requested objects and collect them\n"
      "(Walsman et al., \"Early Fusion for Goal Directed Robotic Vision\", IROS 2019), without ROS.");
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  early_fusion::cli::addCommands(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    std::cerr << "early_fusion: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
