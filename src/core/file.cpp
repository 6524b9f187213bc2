#include "early_fusion/core/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "descriptor.h"
#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/names.h"

namespace early_fusion::core {

namespace fs = std::filesystem;

namespace {

/// Writes the file and syncs it. @param old the status of the file that it replaces; null if there is none.
void writeAndSync(const std::string& path, const std::string& bytes, const struct stat* old) {
  const Descriptor file(path, O_WRONLY | O_CREAT | O_TRUNC);
  if (file.get() < 0) failWithErrno(path, "write");
  if (old != nullptr) {
    // Only root can keep another owner. The mode is set last, because a new owner clears some of its bits.
    const bool same_owner = ::fchown(file.get(), old->st_uid, old->st_gid) == 0;
    if (::fchmod(file.get(), old->st_mode & (same_owner ? 07777 : 0777)) != 0) failWithErrno(path, "set the mode");
  }
  writeAll(file.get(), bytes, path);
  if (::fsync(file.get()) != 0) failWithErrno(path, "sync");
}

std::string read(const std::string& path, std::size_t max_bytes) {
  // Without O_NONBLOCK, opening a FIFO would wait for a writer.
  const Descriptor file(path, O_RDONLY | O_NONBLOCK);
  if (file.get() < 0) failWithErrno(path, "read");
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) failWithErrno(path, "read");
  if (S_ISDIR(status.st_mode)) throw Error(path + ": cannot read: it is a folder");
  if (!S_ISREG(status.st_mode)) throw Error(path + ": cannot read: it is not a regular file");
  const std::string too_large = path + ": cannot read: it has more than " + std::to_string(max_bytes) + " bytes";
  if (static_cast<std::size_t>(status.st_size) > max_bytes) throw Error(too_large);
  std::string contents;
  contents.reserve(static_cast<std::size_t>(status.st_size));
  std::array<char, 65536> block;
  for (;;) {
    const ssize_t count = ::read(file.get(), block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) failWithErrno(path, "read");
    if (count == 0) return contents;
    contents.append(block.data(), static_cast<std::size_t>(count));
    if (contents.size() > max_bytes) throw Error(too_large);  // a file of /proc has size 0
  }
}

}  // namespace

std::string readFile(const std::string& path, std::size_t max_bytes) {
  return namingOutOfMemory(path, [&] { return read(path, max_bytes); });
}

void writeFileAtomically(const std::string& path, const std::string& bytes) {
  const std::string target = followLinks(path);
  const fs::path parent = fs::path(target).parent_path();
  const fs::path folder = parent.empty() ? fs::path(".") : parent;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(path + ": cannot create the folder " + folder.string() + ": " + error.message());
  struct stat old {};
  const bool replaces = ::stat(target.c_str(), &old) == 0;
  if (replaces && !S_ISREG(old.st_mode)) throw Error(path + ": cannot replace it: it is not a regular file");
  const std::string temporary = target + ".tmp" + std::to_string(::getpid());
  try {
    writeAndSync(temporary, bytes, replaces ? &old : nullptr);
    if (::rename(temporary.c_str(), target.c_str()) != 0) failWithErrno(path, "replace it by the new file");
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  const Descriptor directory(folder.string(), O_RDONLY | O_DIRECTORY);
  if (directory.get() >= 0) ::fsync(directory.get());
}

void removeTemporaryFiles(const std::string& path) {
  const fs::path target(path);
  const std::string start = target.filename().string() + ".tmp";
  std::error_code ignored;  // a file that stays does no harm
  for (const auto& entry : fs::directory_iterator(target.parent_path(), ignored)) {
    const std::string name = entry.path().filename().string();
    const bool digits = name.find_first_not_of("0123456789", start.size()) == std::string::npos;
    if (name.size() > start.size() && name.compare(0, start.size(), start) == 0 && digits) {
      fs::remove(entry.path(), ignored);
    }
  }
}

std::string resolvePath(const std::string& base_file, const std::string& path) {
  if (fs::path(path).is_absolute()) return path;
  return (fs::path(base_file).parent_path() / path).lexically_normal().string();
}

std::string lowerCaseExtension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
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
  throw Error("'" + excerpt(name_or_file) + "' is neither a name in config/" + folder + " (" + joined(known) +
              ") nor a .yaml file");
}

}  // namespace early_fusion::core
