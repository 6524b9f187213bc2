#pragma once

#include <memory>
#include <string>

namespace early_fusion::core {

class Descriptor;

/// A file that a user names for a program's output. It is checked before the work whose result it takes.
///
/// A regular file is replaced atomically when it is written, as by writeFileAtomically(). Anything else, such as a
/// FIFO, a device or /dev/fd/63 of a shell's >(...), is opened by the constructor and written to directly.
class OutputFile {
 public:
  /// @param option names the path in errors: "--json". @param path "-" is standard output.
  /// @throws Error naming option and path if it cannot be written, for instance because its folder does not exist.
  OutputFile(std::string option, std::string path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  bool isStandardOutput() const { return path_ == "-"; }

  /// To be called once. @throws Error naming the path and the reason, also for standard output.
  void write(const std::string& bytes);

 private:
  std::string option_;
  std::string path_;
  std::unique_ptr<Descriptor> direct_;  // null if the file is replaced
};

}  // namespace early_fusion::core
