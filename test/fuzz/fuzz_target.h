#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include "early_fusion/core/error.h"

/// The target of a fuzz program, with libFuzzer's name. Returns 0. It runs in libFuzzer and in mutation_driver.cpp.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace early_fusion::fuzz {

/// Ends the program, as a finding of the fuzzer.
[[noreturn]] inline void fail(const std::string& what) {
  std::cerr << "fuzz target: " << what << std::endl;
  std::abort();
}

inline void require(bool condition, const char* what) {
  if (!condition) fail(what);
}

/// Longer texts repeat a foreign value instead of an excerpt. Lists of known names and advice need some hundred.
inline constexpr std::size_t kMaxErrorBytes = 2000;

/// Runs `work`, which may throw core::Error with a text of one line. Every other exception ends the program.
/// @return whether it threw.
template <class Work>
bool allowError(const Work& work) {
  try {
    work();
  } catch (const core::Error& error) {
    const std::string text = error.what();
    if (text.empty() || text.size() > kMaxErrorBytes) {
      fail("an error of " + std::to_string(text.size()) + " bytes: " + text.substr(0, 300));
    }
    return true;
  }
  return false;
}

/// Reads values from the input, one after the other. Behind its end, there are zeros.
class Reader {
 public:
  Reader(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  bool empty() const { return left_ == 0; }

  template <class Number>
  Number number() {
    Number value{};
    const std::size_t count = std::min(sizeof(value), left_);
    if (count > 0) std::memcpy(&value, data_, count);
    skip(count);
    return value;
  }

  /// A byte with the number of bytes, and these bytes.
  std::string text() { return bytes(number<std::uint8_t>()); }

  std::string bytes(std::size_t count) {
    count = std::min(count, left_);
    const std::string result(reinterpret_cast<const char*>(data_), count);
    skip(count);
    return result;
  }

  std::string rest() { return bytes(left_); }

 private:
  void skip(std::size_t count) {
    data_ += count;
    left_ -= count;
  }

  const std::uint8_t* data_;
  std::size_t left_;
};

/// A folder of the process for inputs that are read from files. It is removed at the end.
class InputFolder {
 public:
  InputFolder() { std::filesystem::create_directories(folder_); }
  ~InputFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  InputFolder(const InputFolder&) = delete;
  InputFolder& operator=(const InputFolder&) = delete;

  std::string write(const std::string& name, const std::string& bytes) const {
    const std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }

 private:
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("early_fusion_fuzz" + std::to_string(::getpid()));
};

}  // namespace early_fusion::fuzz
