#include "early_fusion/core/file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/names.h"

namespace early_fusion::core {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& doing) {
  throw Error(path + ": cannot " + doing + ": " + std::strerror(errno));
}

/// A file descriptor that closes itself.
class Descriptor {
 public:
  Descriptor(const std::string& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0644)) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

void writeAndSync(const std::string& path, const std::string& bytes) {
  const Descriptor file(path, O_WRONLY | O_CREAT | O_TRUNC);
  if (file.get() < 0) fail(path, "write");
  std::size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t count = ::write(file.get(), bytes.data() + written, bytes.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, "write");
    written += static_cast<std::size_t>(count);
  }
  if (::fsync(file.get()) != 0) fail(path, "sync");
}

}  // namespace

std::string readFile(const std::string& path) {
  const Descriptor file(path, O_RDONLY);
  if (file.get() < 0) fail(path, "read");
  std::string contents;
  std::array<char, 65536> block;
  for (;;) {
    const ssize_t count = ::read(file.get(), block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, "read");
    if (count == 0) return contents;
    contents.append(block.data(), static_cast<std::size_t>(count));
  }
}

void writeFileAtomically(const std::string& path, const std::string& bytes) {
  const fs::path target(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(path + ": cannot create the folder " + folder.string() + ": " + error.message());
  const std::string temporary = path + ".tmp" + std::to_string(::getpid());
  try {
    writeAndSync(temporary, bytes);
    if (::rename(temporary.c_str(), path.c_str()) != 0) fail(path, "replace it by the new file");
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  const Descriptor directory(folder.string(), O_RDONLY | O_DIRECTORY);
  if (directory.get() >= 0) ::fsync(directory.get());
}

std::string resolvePath(const std::string& base_file, const std::string& path) {
  if (fs::path(path).is_absolute()) return path;
  return (fs::path(base_file).parent_path() / path).lexically_normal().string();
}

std::string shareFolder() {
  const char* chosen = std::getenv("EARLY_FUSION_SHARE");
  std::vector<std::string> tried;
  for (const char* folder : {chosen, EARLY_FUSION_SOURCE_SHARE, EARLY_FUSION_INSTALL_SHARE}) {
    if (folder == nullptr) continue;
    std::error_code unreadable;
    if (fs::is_directory(fs::path(folder) / "config", unreadable)) return folder;
    tried.push_back(folder);
    if (folder == chosen) break;
  }
  throw Error("no config/ folder in " + joined(tried) + "; set EARLY_FUSION_SHARE to the package's folder");
}

std::string findConfig(const std::string& folder, const std::string& name_or_file) {
  const fs::path path(name_or_file);
  if (path.extension() == ".yaml" || path.extension() == ".yml" || path.has_parent_path()) return name_or_file;
  const fs::path known_folder = fs::path(shareFolder()) / "config" / folder;
  const fs::path file = known_folder / (name_or_file + ".yaml");
  std::error_code error;
  if (!name_or_file.empty() && fs::exists(file, error)) return file.string();
  std::vector<std::string> known;
  for (const auto& entry : fs::directory_iterator(known_folder, error)) {
    if (entry.path().extension() == ".yaml") known.push_back(entry.path().stem().string());
  }
  std::sort(known.begin(), known.end());
  throw Error("'" + excerpt(name_or_file) + "' is neither one of the known " + folder + " (" + joined(known) +
              ") nor a .yaml file");
}

}  // namespace early_fusion::core
