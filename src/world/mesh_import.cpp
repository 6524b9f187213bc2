#include "mesh_import.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <assimp/DefaultIOSystem.h>
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <type_traits>
#include <vector>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/file.h"

namespace early_fusion::world {

namespace {

namespace fs = std::filesystem;

constexpr float kCreaseAngleDeg = 50.f;
constexpr std::size_t kMaxMeshBytes = std::size_t{256} << 20;
constexpr rlim_t kMaxProcessorSec = 60;
constexpr unsigned kMaxSec = 300;
constexpr rlim_t kMaxMemoryBytes = rlim_t{4} << 30;
constexpr unsigned kAfterImport = aiProcess_Triangulate | aiProcess_GenSmoothNormals | aiProcess_JoinIdenticalVertices |
                                  aiProcess_SortByPType | aiProcess_FlipUVs | aiProcess_TransformUVCoords;

/// Opens nothing but regular files of plausible size. A FIFO would wait, a device might never end.
class RegularFiles : public Assimp::DefaultIOSystem {
 public:
  /// @param missing the first file that an importer wanted and did not get.
  explicit RegularFiles(std::string& missing) : missing_(missing) {}
  bool Exists(const char* file) const override { return plausible(file) && DefaultIOSystem::Exists(file); }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    Assimp::IOStream* stream = plausible(file) ? DefaultIOSystem::Open(file, mode) : nullptr;
    if (stream == nullptr && missing_.empty()) missing_ = file;
    // Without the material file that an OBJ file names, assimp takes the one of its own name.
    if (stream != nullptr && fs::path(file).extension() == ".mtl") missing_.clear();
    return stream;
  }

 private:
  static bool plausible(const char* file) {
    std::error_code error;
    return fs::is_regular_file(file, error) && fs::file_size(file, error) <= kMaxMeshBytes && !error;
  }

  std::string& missing_;
};

std::string meshName(const std::string& path, const aiMesh& mesh) {
  return path + ": mesh '" + core::excerpt(mesh.mName.C_Str()) + "'";
}

void checkMesh(const std::string& path, const aiMesh& mesh) {
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D& at = mesh.mVertices[i];
    if (std::isfinite(at.x) && std::isfinite(at.y) && std::isfinite(at.z)) continue;
    throw core::Error(path + ": vertex " + std::to_string(i) + " of mesh '" + core::excerpt(mesh.mName.C_Str()) +
                      "' is not finite");
  }
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      if (face.mIndices[k] < mesh.mNumVertices) continue;
      throw core::Error(meshName(path, mesh) + ": face " + std::to_string(i) + " names vertex " +
                        std::to_string(face.mIndices[k]) + " of " + std::to_string(mesh.mNumVertices));
    }
  }
}

void checkScene(const std::string& path, const aiScene& scene) {
  if (scene.mNumMeshes == 0) throw core::Error(path + ": has no triangles; export a surface mesh");
  bool has_surface = false;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[i];
    if (mesh.mMaterialIndex >= scene.mNumMaterials) {
      throw core::Error(meshName(path, mesh) + " names material " + std::to_string(mesh.mMaterialIndex) + " of " +
                        std::to_string(scene.mNumMaterials));
    }
    checkMesh(path, mesh);
    for (unsigned f = 0; f < mesh.mNumFaces && !has_surface; ++f) has_surface = mesh.mFaces[f].mNumIndices > 2;
  }
  if (!has_surface) throw core::Error(path + ": has only points or lines, no triangles; export a surface mesh");
}

/// Gives each face its own vertices. Assimp keeps sharp edges only between faces that share none, so a PLY box of eight
/// vertices would get round corners.
void splitVertices(aiMesh& mesh) {
  std::vector<unsigned> corners;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    aiFace& face = mesh.mFaces[i];
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      corners.push_back(face.mIndices[k]);
      face.mIndices[k] = static_cast<unsigned>(corners.size()) - 1;
    }
  }
  const auto split = [&](auto*& elements) {
    if (elements == nullptr) return;
    auto* result = new std::remove_reference_t<decltype(*elements)>[corners.size()];  // the scene deletes it
    for (std::size_t i = 0; i < corners.size(); ++i) result[i] = elements[corners[i]];
    delete[] elements;
    elements = result;
  };
  split(mesh.mVertices);
  for (auto& colors : mesh.mColors) split(colors);
  for (auto& coordinates : mesh.mTextureCoords) split(coordinates);
  mesh.mNumVertices = static_cast<unsigned>(corners.size());
}

/// Whether a mesh lacks normals and has nothing that names its vertices.
bool canSplitVertices(const aiMesh& mesh) {
  return !mesh.HasNormals() && !mesh.HasTangentsAndBitangents() && !mesh.HasBones() && mesh.mNumAnimMeshes == 0;
}

/// Reads the file, checks what assimp gives, and only then lets it compute with the indices.
/// @param missing the first file that the mesh names and that cannot be read.
const aiScene& import(Assimp::Importer& importer, const std::string& path, std::string& missing) {
  importer.SetIOHandler(new RegularFiles(missing));  // the importer owns it
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, kCreaseAngleDeg);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  // A Collada file's coordinates are used unchanged, as in other ROS programs: z is up in the world.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const auto fail = [&] {
    const std::string reason = importer.GetErrorString();
    if (reason.find("mNumMeshes is 0") != std::string::npos) {
      throw core::Error(path + ": has no triangles; export a surface mesh");
    }
    throw core::Error(path + ": cannot be read as a mesh: " + core::excerpt(reason, 200));
  };
  const aiScene* scene = importer.ReadFile(path, aiProcess_ValidateDataStructure);
  if (scene == nullptr || scene->mRootNode == nullptr) fail();
  checkScene(path, *scene);
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    if (canSplitVertices(*scene->mMeshes[i])) splitVertices(*scene->mMeshes[i]);  // the importer's own, not constant
  }
  scene = importer.ApplyPostProcessing(kAfterImport);
  if (scene == nullptr || scene->mRootNode == nullptr) fail();
  return *scene;
}

/// The bytes that the process has mapped. The limit of the child is counted from here.
rlim_t mappedBytes() {
  std::ifstream file("/proc/self/statm");
  rlim_t pages = 0;
  file >> pages;
  return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

void lower(int resource, rlim_t value) {
  rlimit limit{};
  ::getrlimit(static_cast<__rlimit_resource>(resource), &limit);
  limit.rlim_cur = std::min(limit.rlim_cur, value);
  limit.rlim_max = std::max(limit.rlim_cur, std::min(limit.rlim_max, value + 5));
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

/// Imports the file in this process, a child, and ends it.
[[noreturn]] void tryInChild(const std::string& path, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // it has the parent's locks
  if (::getppid() != parent) ::_exit(0);
  lower(RLIMIT_CORE, 0);
  lower(RLIMIT_CPU, kMaxProcessorSec);
  lower(RLIMIT_AS, mappedBytes() + kMaxMemoryBytes);
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGXCPU, SIGALRM}) std::signal(signal, SIG_DFL);
  ::alarm(kMaxSec);  // also ends a child that waits
  try {
    Assimp::Importer importer;
    std::string missing;
    import(importer, path, missing);
  } catch (const std::exception&) {
    // The parent gets the same error.
  }
  ::_exit(0);
}

/// @throws Error if a child process that imports the file crashes or runs out of time.
void checkInChild(const std::string& path) {
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) throw core::Error(path + ": cannot start a process that reads the mesh");
  if (child == 0) tryInChild(path, parent);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return;  // another part of the program waits for all children: the result is unknown
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  const bool slow = signal == SIGXCPU || signal == SIGKILL || signal == SIGALRM;
  throw core::Error(path + ": cannot be read as a mesh: the file is damaged, assimp " +
                    (slow ? "does not finish it in time" : "crashes on it"));
}

/// Whether a line's first word is end_header. Assimp ends lines at four characters.
bool hasEndOfHeader(const std::string& ply) {
  const std::string word = "end_header", blanks = " \t", line_ends = std::string("\n\r\f\0", 4);
  for (std::size_t at = ply.find(word); at != std::string::npos; at = ply.find(word, at + 1)) {
    const std::size_t before = at == 0 ? std::string::npos : ply.find_last_not_of(blanks, at - 1);
    const std::size_t after = at + word.size();
    const bool starts_line = before == std::string::npos || line_ends.find(ply[before]) != std::string::npos;
    const bool ends_word = after == ply.size() || (blanks + line_ends).find(ply[after]) != std::string::npos;
    if (starts_line && ends_word) return true;
  }
  return false;
}

/// Assimp's importer never ends for a PLY file without the end of its header.
void checkPly(const std::string& path) {
  if (core::lowerCaseExtension(path) != ".ply" || hasEndOfHeader(core::readFile(path, kMaxMeshBytes))) return;
  throw core::Error(path + ": cannot be read as a mesh: its header has no end_header");
}

}  // namespace

const aiScene& importMesh(Assimp::Importer& importer, const std::string& path) {
  std::error_code error;
  if (fs::exists(path, error)) {
    if (!fs::is_regular_file(path, error)) {
      throw core::Error(path + ": cannot be read as a mesh: it is not a regular file");
    }
    if (fs::file_size(path, error) > kMaxMeshBytes) {
      throw core::Error(path + ": cannot be read as a mesh: it has more than " + std::to_string(kMaxMeshBytes) +
                        " bytes");
    }
    checkPly(path);
    checkInChild(path);
  }
  std::string missing;
  const aiScene& scene = import(importer, path, missing);
  importer.SetIOHandler(new Assimp::DefaultIOSystem);  // the other one, which this deletes, refers to `missing`
  if (!missing.empty()) {
    std::cerr << "early_fusion: " << path << ": " << missing
              << ", which it names, cannot be read; drawn without its materials\n";
  }
  return scene;
}

}  // namespace early_fusion::world
