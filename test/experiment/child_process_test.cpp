#include "early_fusion/experiment/child_process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <thread>

#include "temporary_folder.h"

namespace early_fusion::experiment {
namespace {

/// Waits for what will happen. The limit is for a test that would hang.
bool waitFor(const std::function<bool()>& condition) {
  for (int i = 0; i < 6000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return condition();
}

/// Whether a process runs. One that has ended and that nobody has waited for does not.
bool runs(const std::string& pid) {
  std::ifstream stat("/proc/" + pid + "/stat");
  std::string number, name, state;
  return static_cast<bool>(stat >> number >> name >> state) && state != "Z" && state != "X";
}

class ChildProcessTest : public testing::Test {
 protected:
  int codeOf(const std::string& script) const {
    ChildProcess child("/bin/sh", {"-c", script}, {{"COLOUR", "blue"}}, folder_.path("log"));
    EXPECT_TRUE(waitFor([&] { return child.exitCode().has_value(); }));
    return child.exitCode().value_or(-1);
  }

  /// The process id that a script has written.
  std::string pid() const {
    EXPECT_TRUE(waitFor([&] { return folder_.has("pid") && !folder_.read("pid").empty(); }));
    const std::string line = folder_.read("pid");
    return line.substr(0, line.size() - 1);
  }

  const TemporaryFolder folder_;
  const std::string sleeper_ = "echo $$ >" + folder_.path("pid.new") + "; mv " + folder_.path("pid.new") + " " +
                               folder_.path("pid") + "; exec sleep 1000";
};

TEST_F(ChildProcessTest, AppendsItsOutputToTheLogAndHasTheEnvironment) {
  EXPECT_EQ(codeOf("echo first; echo second >&2"), 0);
  EXPECT_EQ(codeOf("echo $COLOUR; cat"), 0);  // there is nothing on standard input
  EXPECT_EQ(folder_.read("log"), "first\nsecond\nblue\n");
}

TEST_F(ChildProcessTest, SaysHowItEnded) {
  EXPECT_EQ(codeOf("exit 3"), 3);
  EXPECT_EQ(codeOf("kill -9 $$"), 128 + SIGKILL);
  ChildProcess nothing("/no/such/program", {}, {}, folder_.path("log"));
  EXPECT_TRUE(waitFor([&] { return nothing.exitCode().has_value(); }));
  EXPECT_EQ(nothing.exitCode(), 127);
}

TEST_F(ChildProcessTest, DiesWithTheObject) {
  {
    ChildProcess child("/bin/sh", {"-c", sleeper_}, {}, folder_.path("log"));
    EXPECT_TRUE(runs(pid()));
    EXPECT_FALSE(child.exitCode().has_value());
  }
  EXPECT_FALSE(runs(pid()));
}

TEST_F(ChildProcessTest, DiesWithItsParentHoweverThatDies) {
  const pid_t parent = ::fork();
  if (parent == 0) {
    const ChildProcess child("/bin/sh", {"-c", sleeper_}, {}, folder_.path("log"));
    while (true) ::pause();
  }
  EXPECT_TRUE(runs(pid()));
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  EXPECT_TRUE(waitFor([&] { return !runs(pid()); }));
}

TEST_F(ChildProcessTest, CtrlCDoesNotReachIt) {
  const ChildProcess child("/bin/sh", {"-c", sleeper_}, {}, folder_.path("log"));
  EXPECT_EQ(::getpgid(std::stoi(pid())), std::stoi(pid()));
}

TEST_F(ChildProcessTest, ALogThatCannotBeWrittenIsAnError) {
  const std::string error = errorOf([] { ChildProcess("/bin/true", {}, {}, "/no/such/folder/log"); });
  EXPECT_NE(error.find("/no/such/folder/log: cannot write"), std::string::npos) << error;
}

}  // namespace
}  // namespace early_fusion::experiment
