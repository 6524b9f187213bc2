#include "mesh_texture.h"

#include <assimp/material.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/file.h"
#include "resource_path.h"

// Only for TGA, which OpenCV cannot decode.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_NO_FAILURE_STRINGS
#define STBI_MAX_DIMENSIONS 16384
#include <stb_image.h>

#if !defined(AI_MATKEY_BASE_COLOR)  // assimp 5.0 has glTF's names
#include <assimp/pbrmaterial.h>
#define AI_MATKEY_BASE_COLOR AI_MATKEY_GLTF_PBRMETALLICROUGHNESS_BASE_COLOR_FACTOR
#define AI_MATKEY_ROUGHNESS_FACTOR AI_MATKEY_GLTF_PBRMETALLICROUGHNESS_ROUGHNESS_FACTOR
#endif

namespace early_fusion::world {

namespace {

constexpr int kUniformSize = 4;
constexpr float kMaxSpecular = 0.5f;
constexpr float kGlossyShininess = 30.f;

/// The name of the diffuse image; empty if there is none.
std::string imageName(const aiMaterial& material) {
  for (const aiTextureType type : {aiTextureType_DIFFUSE, aiTextureType_BASE_COLOR}) {
    aiString name;
    if (material.GetTexture(type, 0, &name) == AI_SUCCESS && name.length > 0) return name.C_Str();
  }
  return "";
}

/// Uses an area filter to shrink a texture, so that fine print becomes grey instead of noise.
Texture squareTexture(const cv::Mat& bgr) {
  const int longest = std::max(bgr.cols, bgr.rows);
  int size = 1;
  while (size < longest && size < kMaxTextureSize) size *= 2;
  cv::Mat square = bgr;
  if (bgr.cols != size || bgr.rows != size) {
    const bool shrinks = bgr.cols >= size && bgr.rows >= size;
    cv::resize(bgr, square, cv::Size(size, size), 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_LINEAR);
  }
  Texture texture{size, std::vector<std::uint32_t>(static_cast<std::size_t>(size) * size)};
  for (int y = 0; y < size; ++y) {
    const cv::Vec3b* row = square.ptr<cv::Vec3b>(y);
    for (int x = 0; x < size; ++x) {
      texture.texels[static_cast<std::size_t>(y) * size + x] = row[x][2] | static_cast<std::uint32_t>(row[x][1]) << 8 |
                                                               static_cast<std::uint32_t>(row[x][0]) << 16 |
                                                               0xff000000u;
    }
  }
  return texture;
}

constexpr std::size_t kMaxTextureBytes = std::size_t{256} << 20;
constexpr std::uint64_t kMaxPixels = 64'000'000;  // of a texture: one of 8000 x 8000 fits

std::uint32_t bigEndian(const std::string& bytes, std::size_t at, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// The number of pixels that a PNG or JPEG file claims to have; 0 if it cannot be found.
std::uint64_t claimedPixels(const std::string& bytes) {
  if (bytes.compare(1, 3, "PNG") == 0 && bytes.size() >= 24) {
    return std::uint64_t{bigEndian(bytes, 16, 4)} * bigEndian(bytes, 20, 4);
  }
  if (bytes.compare(0, 2, "\xff\xd8") != 0) return 0;
  for (std::size_t at = 2; at + 9 <= bytes.size() && bytes[at] == '\xff'; at += 2 + bigEndian(bytes, at + 2, 2)) {
    const auto marker = static_cast<unsigned char>(bytes[at + 1]);
    const bool is_frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (is_frame) return std::uint64_t{bigEndian(bytes, at + 5, 2)} * bigEndian(bytes, at + 7, 2);
  }
  return 0;
}

constexpr std::uint64_t kMaxTgaPixelsPerByte = 64;  // a run of 128 pixels has at least two bytes

/// @return an empty image if the bytes are no TGA file.
cv::Mat decodeTga(const std::string& bytes) {
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  const int size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0 || width < 1 || height < 1) return cv::Mat();
  // stb_image would fill what a truncated file lacks, which takes seconds for a large image.
  const std::uint64_t pixels = static_cast<std::uint64_t>(width) * height;
  if (pixels > std::min(kMaxPixels, kMaxTgaPixelsPerByte * bytes.size())) return cv::Mat();
  unsigned char* rgb = stbi_load_from_memory(data, size, &width, &height, &channels, 3);
  if (rgb == nullptr) return cv::Mat();
  cv::Mat bgr;
  cv::cvtColor(cv::Mat(height, width, CV_8UC3, rgb), bgr, cv::COLOR_RGB2BGR);
  stbi_image_free(rgb);
  return bgr;
}

/// @return an empty image if the bytes are none. @throws Error if the image is too large.
cv::Mat decode(const std::string& bytes, const std::string& where) {
  const std::uint64_t pixels = bytes.size() < 4 ? 0 : claimedPixels(bytes);
  if (pixels > kMaxPixels) {
    throw core::Error(where + " claims to have " + std::to_string(pixels) + " pixels; the maximum is " +
                      std::to_string(kMaxPixels));
  }
  if (bytes.empty()) return cv::Mat();
  try {
    const cv::Mat image = cv::imdecode(std::vector<unsigned char>(bytes.begin(), bytes.end()), cv::IMREAD_COLOR);
    return image.empty() ? decodeTga(bytes) : image;
  } catch (const cv::Exception&) {
    return cv::Mat();
  }
}

cv::Mat decodeEmbedded(const aiTexture& embedded, const std::string& where) {
  if (embedded.mHeight == 0) {  // a PNG or JPEG file of mWidth bytes
    return decode(std::string(reinterpret_cast<const char*>(embedded.pcData), embedded.mWidth), where);
  }
  if (std::uint64_t{embedded.mWidth} * embedded.mHeight > kMaxPixels) {
    throw core::Error(where + " is larger than " + std::to_string(kMaxPixels) + " pixels");
  }
  cv::Mat bgr(embedded.mHeight, embedded.mWidth, CV_8UC3);
  for (int y = 0; y < bgr.rows; ++y) {
    for (int x = 0; x < bgr.cols; ++x) {
      const aiTexel& texel = embedded.pcData[static_cast<std::size_t>(y) * bgr.cols + x];
      bgr.at<cv::Vec3b>(y, x) = {texel.b, texel.g, texel.r};
    }
  }
  return bgr;
}

cv::Mat readImage(const aiScene& scene, const std::string& name, const std::string& mesh_path) {
  if (const aiTexture* embedded = scene.GetEmbeddedTexture(name.c_str())) {
    const std::string where = mesh_path + ": the embedded texture '" + core::excerpt(name) + "'";
    const cv::Mat image = decodeEmbedded(*embedded, where);
    if (image.empty()) throw core::Error(where + " cannot be decoded");
    return image;
  }
  std::string file;
  const std::string bytes = [&] {
    try {
      file = resourcePath(mesh_path, name);
      return core::readFile(file, kMaxTextureBytes);
    } catch (const core::Error& error) {
      throw core::Error(mesh_path + ": its texture cannot be read: " + error.what());
    }
  }();
  const cv::Mat image = decode(bytes, mesh_path + ": its texture " + file);
  if (image.empty()) {
    throw core::Error(mesh_path + ": its texture " + file +
                      " is not an image that can be decoded; use PNG, JPEG or TGA");
  }
  return image;
}

}  // namespace

aiColor4D plainColor(const aiMaterial& material) {
  aiColor4D color(0.8f, 0.8f, 0.8f, 1.f);
  if (material.Get(AI_MATKEY_COLOR_DIFFUSE, color) != AI_SUCCESS) material.Get(AI_MATKEY_BASE_COLOR, color);
  return color;
}

std::uint32_t packColor(const aiColor4D& color, bool linear) {
  const auto byte = [linear](float value) {
    float shown = std::clamp(std::isnan(value) ? 0.f : value, 0.f, 1.f);
    if (linear) shown = shown <= 0.0031308f ? 12.92f * shown : 1.055f * std::pow(shown, 1 / 2.4f) - 0.055f;  // sRGB
    return static_cast<std::uint32_t>(std::lround(255.f * shown));
  };
  return byte(color.r) | byte(color.g) << 8 | byte(color.b) << 16 | 0xff000000u;
}

bool hasImage(const aiMaterial& material) { return !imageName(material).empty(); }

Texture uniformTexture(std::uint32_t color) {
  return {kUniformSize, std::vector<std::uint32_t>(kUniformSize * kUniformSize, color)};
}

std::optional<Texture> readTexture(const aiScene& scene, const aiMaterial& material, const std::string& mesh_path) {
  const std::string name = imageName(material);
  if (name.empty()) return std::nullopt;
  try {
    return squareTexture(readImage(scene, name, mesh_path));
  } catch (const core::Error& error) {
    std::cerr << "early_fusion: " << error.what() << "; drawn in its plain colour\n";
    return std::nullopt;
  }
}

float readSpecular(const aiMaterial& material) {
  float roughness = 0.f;
  if (material.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness) == AI_SUCCESS) {
    return kMaxSpecular * std::clamp(1.f - roughness, 0.f, 1.f);
  }
  aiColor3D color(0.f, 0.f, 0.f);
  float shininess = 0.f;
  material.Get(AI_MATKEY_COLOR_SPECULAR, color);
  material.Get(AI_MATKEY_SHININESS, shininess);
  const float strength = (color.r + color.g + color.b) / 3.f * std::min(shininess / kGlossyShininess, 1.f);
  return std::isfinite(strength) ? std::clamp(strength, 0.f, kMaxSpecular) : 0.f;
}

}  // namespace early_fusion::world
