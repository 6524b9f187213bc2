#include "early_fusion/core/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "descriptor.h"
#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"

namespace early_fusion::core {

namespace fs = std::filesystem;

OutputFile::OutputFile(std::string option, std::string path) : option_(std::move(option)), path_(std::move(path)) {
  if (path_.empty()) throw Error(option_ + ": the name of the file is empty");
  if (isStandardOutput()) return;
  struct stat status {};
  const bool exists = ::stat(path_.c_str(), &status) == 0;
  const std::string target = followLinks(path_);
  // /dev/stdout leads to a file of /proc that stands for an open file, which must not be replaced.
  const bool is_open_file = target.rfind("/proc/", 0) == 0 || path_.rfind("/dev/", 0) == 0;
  if (exists && S_ISDIR(status.st_mode)) throw Error(option_ + ": " + path_ + " is a folder; name a file");
  if (exists && (!S_ISREG(status.st_mode) || is_open_file)) {
    direct_ = std::make_unique<Descriptor>(path_, O_WRONLY | O_APPEND);
    if (direct_->get() < 0) failWithErrno(option_ + ": " + path_, "write");
    return;
  }
  const fs::path parent = fs::path(target).parent_path();
  const std::string folder = parent.empty() ? "." : parent.string();
  std::error_code unreadable;
  if (!fs::is_directory(folder, unreadable)) {
    throw Error(option_ + ": " + path_ + ": there is no folder " + folder + "; make it first");
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) failWithErrno(option_ + ": " + path_, "write in its folder");
}

OutputFile::~OutputFile() = default;

void OutputFile::write(const std::string& bytes) {
  if (isStandardOutput()) {
    writeAll(STDOUT_FILENO, bytes, option_ + ": standard output");
  } else if (direct_) {
    writeAll(direct_->get(), bytes, option_ + ": " + path_);
    direct_.reset();  // a reader at the other end of a FIFO sees its end
  } else {
    writeFileAtomically(path_, bytes);
  }
}

}  // namespace early_fusion::core
