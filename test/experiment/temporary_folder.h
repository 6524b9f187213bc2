#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"

namespace early_fusion::experiment {

/// A folder for a test's files. It is removed with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() { std::filesystem::create_directories(folder_); }
  ~TemporaryFolder() { std::filesystem::remove_all(folder_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    core::writeFileAtomically(path(name), text);
    return path(name);
  }
  bool has(const std::string& name) const { return std::filesystem::exists(path(name)); }
  std::string read(const std::string& name) const { return core::readFile(path(name)); }

 private:
  inline static int count_ = 0;
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() /
      ("early_fusion_experiment_test" + std::to_string(::getpid()) + "_" + std::to_string(count_++));
};

/// The text of the Error that `action` throws, or "accepted".
template <class Action>
std::string errorOf(Action action) {
  try {
    action();
  } catch (const core::Error& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace early_fusion::experiment
