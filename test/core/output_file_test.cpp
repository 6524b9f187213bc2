#include "early_fusion/core/output_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <future>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"

namespace early_fusion::core {
namespace {

namespace fs = std::filesystem;

class OutputFileTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string errorOf(const std::string& path) {
    try {
      OutputFile file("--json", path);
      file.write("x");
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  const fs::path folder_ = fs::temp_directory_path() / ("early_fusion_output_test" + std::to_string(::getpid()));
};

TEST_F(OutputFileTest, ARegularFileAppearsWhenItIsWritten) {
  OutputFile file("--json", folder_ / "a");
  EXPECT_FALSE(fs::exists(folder_ / "a"));
  file.write("text");
  EXPECT_EQ(readFile(folder_ / "a"), "text");
}

TEST_F(OutputFileTest, AFifoIsWrittenToAndStaysOne) {
  const std::string path = folder_ / "fifo";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  std::future<std::string> read = std::async(std::launch::async, [&] {
    std::ifstream stream(path);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  });
  OutputFile file("--json", path);
  file.write("text");
  EXPECT_EQ(read.get(), "text");
  EXPECT_TRUE(fs::is_fifo(path));
}

TEST_F(OutputFileTest, AFullDeviceIsAnErrorAndADeviceStaysOne) {
  EXPECT_EQ(errorOf("/dev/full"), "--json: /dev/full: cannot write: No space left on device");
  EXPECT_EQ(errorOf("/dev/null"), "no error");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(OutputFileTest, WhatCannotBeWrittenIsAnErrorBeforeTheWork) {
  const auto refusal = [](const std::string& path) -> std::string {
    try {
      OutputFile("--json", path);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string missing = folder_ / "no";
  EXPECT_EQ(refusal(missing + "/a"), "--json: " + missing + "/a: there is no folder " + missing + "; make it first");
  EXPECT_EQ(refusal(folder_), "--json: " + folder_.string() + " is a folder; name a file");
  EXPECT_EQ(refusal(""), "--json: the name of the file is empty");
  EXPECT_FALSE(fs::exists(missing));
}

}  // namespace
}  // namespace early_fusion::core
