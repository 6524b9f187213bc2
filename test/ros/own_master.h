#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "child_process.h"
#include "early_fusion/core/file.h"

namespace early_fusion::nodes {

inline int freePort() {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ::bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof(address));
  socklen_t size = sizeof(address);
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  ::close(socket);
  return ntohs(address.sin_port);
}

inline bool waitFor(const std::function<bool()>& condition, double timeout_sec = 30) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_sec);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

/// A master on a port of its own, and launch files that use it.
class OwnMaster {
 public:
  /// @param folder for logs and ROS_HOME, with a slash at its end.
  explicit OwnMaster(const std::string& folder) : OwnMaster(folder, std::to_string(freePort())) {}

  /// Whether it has started.
  bool starts() const {
    return waitFor([this] { return output().find("started core service [/rosout]") != std::string::npos; });
  }
  std::string output() const { return roscore_.output(); }
  const ChildProcess::Environment& environment() const { return environment_; }

  std::unique_ptr<ChildProcess> launch(const std::string& file, const std::vector<std::string>& arguments) {
    std::vector<std::string> command = {"roslaunch", "early_fusion", file};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const std::string log = folder_ + file + std::to_string(launches_++) + ".log";
    return std::make_unique<ChildProcess>(command, environment_, log);
  }

 private:
  OwnMaster(const std::string& folder, const std::string& port)
      : folder_(folder),
        environment_({{"ROS_MASTER_URI", "http://127.0.0.1:" + port},
                      {"ROS_IP", "127.0.0.1"},
                      {"ROS_HOME", folder + "ros_home"},
                      {"ROS_LOG_DIR", folder + "ros_home/log"},
                      {"PYTHONUNBUFFERED", "1"},
                      {"EARLY_FUSION_SHARE", core::shareFolder()}}),
        roscore_({"roscore", "-p", port}, environment_, folder + "roscore" + port + ".log") {}

  std::string folder_;
  ChildProcess::Environment environment_;
  ChildProcess roscore_;
  int launches_ = 0;
};

}  // namespace early_fusion::nodes
