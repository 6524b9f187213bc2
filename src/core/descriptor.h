#pragma once

#include <string>
#include <utility>

namespace early_fusion::core {

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  /// Opens `path`. @param mode of a file that is created. The descriptor is below 0 if that fails, and errno says why.
  Descriptor(const std::string& path, int flags, unsigned mode = 0644);
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

/// @throws Error "PATH: cannot DOING: REASON", with the reason from errno.
[[noreturn]] void failWithErrno(const std::string& path, const std::string& doing);

/// Writes all bytes. @throws Error naming `path`.
void writeAll(int fd, const std::string& bytes, const std::string& path);

/// The file that `path` leads to through symbolic links. It may not exist yet. @throws Error if the links form a cycle.
std::string followLinks(const std::string& path);

}  // namespace early_fusion::core
