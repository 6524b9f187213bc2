#include "descriptor.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "early_fusion/core/error.h"

namespace early_fusion::core {

namespace fs = std::filesystem;

Descriptor::Descriptor(const std::string& path, int flags, unsigned mode)
    : fd_(::open(path.c_str(), flags | O_CLOEXEC, mode)) {}

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

void failWithErrno(const std::string& path, const std::string& doing) {
  throw Error(path + ": cannot " + doing + ": " + std::strerror(errno));
}

void writeAll(int fd, const std::string& bytes, const std::string& path) {
  std::size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t count = ::write(fd, bytes.data() + written, bytes.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) failWithErrno(path, "write");
    written += static_cast<std::size_t>(count);
  }
}

std::string followLinks(const std::string& path) {
  constexpr int kMaxLinks = 40;
  fs::path file(path);
  std::error_code error;
  for (int i = 0; i < kMaxLinks; ++i) {
    if (!fs::is_symlink(file, error)) return file.string();
    const fs::path next = fs::read_symlink(file, error);
    if (error) throw Error(path + ": cannot follow the link: " + error.message());
    file = next.is_absolute() ? next : file.parent_path() / next;
  }
  throw Error(path + ": its symbolic links form a cycle");
}

}  // namespace early_fusion::core
