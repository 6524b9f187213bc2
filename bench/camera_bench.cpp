// Time from a camera's image to the policy node's action, and the node's memory: roslaunch bench/camera_bench.launch
#include <early_fusion/Action.h>
#include <early_fusion/Request.h>
#include <ros/callback_queue.h>
#include <ros/network.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <signal.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpcClient.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "early_fusion/core/random.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::bench {
namespace {

struct CameraBenchOptions {
  int images = 900;
  double rate_hz = 30;
  int busy = 1;
  bool frames = false;
};

/// Processes that do nothing but compute, until the object ends.
class BusyProcesses {
 public:
  explicit BusyProcesses(int count) {
    for (int i = 0; i < count; ++i) {
      const pid_t child = fork();
      if (child == 0) {
        for (volatile double x = 1;;) x = x * 1.0000001;
      }
      children_.push_back(child);
    }
  }
  ~BusyProcesses() {
    for (const pid_t child : children_) kill(child, SIGKILL);
  }

 private:
  std::vector<pid_t> children_;
};

/// An image of noise.
/// @param frame a frame as the simulator sends it, 128 x 128 in rgb8, instead of a camera's Bayer image of 640 x 480.
sensor_msgs::ImagePtr noise(bool frame, std::uint64_t number) {
  auto image = boost::make_shared<sensor_msgs::Image>();
  image->width = frame ? 128 : 640;
  image->height = frame ? 128 : 480;
  image->encoding = frame ? "rgb8" : "bayer_rggb8";
  image->step = frame ? 3 * image->width : image->width;
  image->data.resize(image->step * image->height);
  core::Random random(number);
  for (std::uint8_t& value : image->data) value = static_cast<std::uint8_t>(random.next());
  return image;
}

/// The process of a node, or 0 if it does not answer.
int processOf(const std::string& node) {
  XmlRpc::XmlRpcValue arguments, response, uri;
  arguments[0] = arguments[1] = node;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::master::execute("lookupNode", arguments, response, uri, false)) return 0;
  if (!ros::network::splitURI(uri, host, port)) return 0;
  XmlRpc::XmlRpcClient client(host.c_str(), port);
  XmlRpc::XmlRpcValue caller;
  caller[0] = node;
  return client.execute("getPid", caller, response) ? static_cast<int>(response[2]) : 0;
}

/// Resident memory of a process [MB].
double residentMb(int process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/statm");
  double total = 0, resident = 0;
  file >> total >> resident;
  return resident * sysconf(_SC_PAGESIZE) / 1e6;
}

/// Processor time that a process has used [ms].
double processorMs(int process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  std::getline(file, text);
  std::istringstream fields(text.substr(std::min(text.size(), text.rfind(')') + 1)));  // after the name
  std::string field;
  double ticks = 0;
  for (int i = 3; fields >> field && i <= 15; ++i) {
    if (i >= 14) ticks += std::stod(field);  // in user mode and in the kernel
  }
  return 1e3 * ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

/// Sends images with requests and waits for each action.
class CameraBench {
 public:
  explicit CameraBench(bool frames)
      : images_({noise(frames, 1), noise(frames, 2), noise(frames, 3)}),
        image_publisher_(node_.advertise<sensor_msgs::Image>(nodes::kImageTopic, 10)),
        request_publisher_(node_.advertise<Request>(nodes::kRequestTopic, 10)),
        action_subscriber_(node_.subscribe<Action>(
            nodes::kActionTopic, 10, [this](const ActionConstPtr& action) { answered_ = action->header.stamp; },
            ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay())) {}

  void waitForPolicy() {
    while (ros::ok() && (image_publisher_.getNumSubscribers() == 0 || request_publisher_.getNumSubscribers() == 0 ||
                         action_subscriber_.getNumPublishers() == 0)) {
      ros::WallDuration(0.1).sleep();
    }
  }

  /// The time from the image to its action [ms].
  double ask(std::uint32_t step) {
    const sensor_msgs::ImagePtr image = images_[step % images_.size()];
    image->header.stamp = ros::Time(1, step);
    Request request;
    request.header = image->header;
    request.step = step;
    request.items = {"mug"};
    const ros::WallTime began = ros::WallTime::now();
    image_publisher_.publish(image);
    request_publisher_.publish(request);
    while (ros::ok() && answered_ != image->header.stamp)
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(1));
    return (ros::WallTime::now() - began).toSec() * 1e3;
  }

 private:
  ros::NodeHandle node_;
  const std::vector<sensor_msgs::ImagePtr> images_;
  ros::Publisher image_publisher_, request_publisher_;
  ros::Subscriber action_subscriber_;
  ros::Time answered_;
};

void run(const CameraBenchOptions& options) {
  CameraBench bench(options.frames);
  bench.waitForPolicy();
  for (std::uint32_t warm_up = 0; warm_up < 30; ++warm_up) bench.ask(warm_up);
  const int process = processOf(ros::names::resolve("policy"));
  const BusyProcesses busy(options.busy);
  std::vector<double> times;
  double early_mb = 0;
  const double processor_before = processorMs(process);
  ros::WallRate rate(options.rate_hz > 0 ? options.rate_hz : 1e6);
  for (int i = 0; i < options.images && ros::ok(); ++i) {
    times.push_back(bench.ask(30 + i));
    if (i == options.images / 10) early_mb = residentMb(process);
    if (options.rate_hz > 0) rate.sleep();
  }
  std::sort(times.begin(), times.end());
  std::printf(
      "%zu %s at %.0f Hz beside %d busy processes: median %.2f ms, 99 %% %.2f ms; "
      "%.2f ms of processor an image; memory of the node %.1f MB after a tenth of them, %.1f MB at the end\n",
      times.size(), options.frames ? "frames" : "Bayer images of 640 x 480", options.rate_hz, options.busy,
      times[times.size() / 2], times[times.size() * 99 / 100],
      (processorMs(process) - processor_before) / static_cast<double>(times.size()), early_mb, residentMb(process));
}

}  // namespace
}  // namespace early_fusion::bench

int main(int argc, char** argv) {
  ros::init(argc, argv, "camera_bench");
  early_fusion::bench::CameraBenchOptions options;
  std::vector<std::string> arguments;
  ros::removeROSArgs(argc, argv, arguments);
  CLI::App app("Time from a camera's image to the policy node's action, and the node's memory.");
  app.add_option("--images", options.images, "number of images")->check(CLI::Range(10, 10000000));
  app.add_option("--rate", options.rate_hz, "images a second; 0: each image when the last one is answered");
  app.add_option("--busy", options.busy, "number of busy processes beside")->check(CLI::Range(0, 64));
  app.add_flag("--frames", options.frames, "send frames as the simulator does, not a camera's Bayer images");
  std::reverse(arguments.begin() + 1, arguments.end());
  arguments.erase(arguments.begin());
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  }
  early_fusion::bench::run(options);
}
