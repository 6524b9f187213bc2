#include <iostream>

#include "command.h"
#include "early_fusion/core/error.h"
#include "early_fusion/core/stop_signals.h"

int main(int argc, char** argv) {
  CLI::App app(
      "Trains, scores and shows policies that point a pan-tilt camera at requested objects and collect them\n"
      "(Walsman et al., \"Early Fusion for Goal Directed Robotic Vision\", IROS 2019), without ROS.");
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  early_fusion::cli::addCommands(app);
  try {
    app.parse(argc, argv);
    if (!std::cout.flush()) throw early_fusion::core::Error("standard output cannot be written");
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const early_fusion::core::Stopped& stopped) {
    std::cerr << "\nearly_fusion: " << stopped.what() << "\n";
    return stopped.exitCode();
  } catch (const std::exception& error) {
    std::cerr << "early_fusion: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
