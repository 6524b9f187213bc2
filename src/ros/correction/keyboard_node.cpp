#include "early_fusion/ros/correction/keyboard_node.h"

#include <early_fusion/Press.h>
#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <cstdio>

#include "early_fusion/core/error.h"
#include "early_fusion/ros/shared/conversions.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

namespace {

constexpr double kTimerSec = 0.01;

}  // namespace

/// A terminal whose keys come one by one and are not shown, as long as the object lives. Ctrl-C still works.
class KeyboardNode::Terminal {
 public:
  explicit Terminal(const std::string& device) : file_(device.empty() ? STDIN_FILENO : ::open(device.c_str(), O_RDWR)) {
    if (::tcgetattr(file_, &before_) != 0) {
      if (file_ > STDIN_FILENO) ::close(file_);
      throw core::Error("terminal: " + (device.empty() ? std::string("standard input") : device) +
                        " is no terminal, so keys cannot be read; run 'rosrun early_fusion keyboard_node' in a "
                        "terminal of its own");
    }
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    ::tcsetattr(file_, TCSANOW, &raw);
  }
  ~Terminal() {
    ::tcsetattr(file_, TCSANOW, &before_);
    if (file_ != STDIN_FILENO) ::close(file_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// The bytes of the keys that were pressed since the last call.
  std::string read() {
    char bytes[64];
    const ssize_t count = ::read(file_, bytes, sizeof(bytes));
    return count > 0 ? std::string(bytes, static_cast<std::size_t>(count)) : "";
  }

 private:
  int file_;
  termios before_{};
};

core::OptionSet KeyboardNode::Options::options() {
  core::OptionSet set("keyboard");
  set.add("terminal", terminal, "the terminal whose keys are read, such as /dev/pts/3; empty: standard input");
  return set;
}

KeyboardNode::KeyboardNode(const Options& options)
    : terminal_(std::make_unique<Terminal>(options.terminal)),
      press_publisher_(node_.advertise<Press>(kPressTopic, 16)) {
  request_subscriber_ = node_.subscribe<Request>(
      kRequestTopic, 1, [this](const RequestConstPtr& request) { items_ = itemList(request->items); });
  proposal_subscriber_ = node_.subscribe<Action>(kProposalTopic, 1, [this](const ActionConstPtr& action) {
    std::printf("step %u, requested: %s; the policy: %s\n", action->step, items_.c_str(), action->name.c_str());
    std::fflush(stdout);
  });
  timer_ = node_.createWallTimer(::ros::WallDuration(kTimerSec), [this](const ::ros::WallTimerEvent&) { onTimer(); });
  std::printf("Press a key wherever the policy errs:\n%s", keyMapText().c_str());
  std::fflush(stdout);
}

KeyboardNode::~KeyboardNode() = default;

void KeyboardNode::onTimer() {
  for (const char byte : terminal_->read()) {
    const std::optional<std::string> name = reader_.add(byte);
    if (!name) continue;
    Press press;
    press.name = *name;
    press_publisher_.publish(press);
  }
}

}  // namespace early_fusion::nodes
