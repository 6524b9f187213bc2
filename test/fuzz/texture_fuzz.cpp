// An image file that is embedded in a mesh as its texture.
#include "fuzz_target.h"
#include "mesh_texture.h"

using namespace early_fusion;

namespace {

/// A scene with one material, whose diffuse image is the embedded one. The scene deletes what it has.
std::unique_ptr<aiScene> sceneWith(const std::string& image) {
  auto scene = std::make_unique<aiScene>();
  auto* texture = new aiTexture;
  texture->mWidth = static_cast<unsigned>(image.size());
  texture->pcData = new aiTexel[image.size() / sizeof(aiTexel) + 1];
  std::memcpy(static_cast<void*>(texture->pcData), image.data(), image.size());
  scene->mNumTextures = 1;
  scene->mTextures = new aiTexture* [1] { texture };
  auto* material = new aiMaterial;
  const aiString name("*0");
  material->AddProperty(&name, AI_MATKEY_TEXTURE_DIFFUSE(0));
  scene->mNumMaterials = 1;
  scene->mMaterials = new aiMaterial* [1] { material };
  return scene;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::unique_ptr<aiScene> scene = sceneWith({reinterpret_cast<const char*>(data), size});
  fuzz::allowError([&] {
    const std::optional<world::Texture> texture = world::readTexture(*scene, *scene->mMaterials[0], "mesh");
    if (!texture) return;
    const int edge = texture->size;
    fuzz::require(edge > 0 && edge <= world::kMaxTextureSize && (edge & (edge - 1)) == 0, "the edge of a texture");
    fuzz::require(texture->texels.size() == static_cast<std::size_t>(edge) * edge, "the number of texels");
  });
  return 0;
}
