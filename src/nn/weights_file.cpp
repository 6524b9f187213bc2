#include "early_fusion/nn/weights_file.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <string_view>

#include "early_fusion/core/digest.h"
#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/file.h"
#include "weights_header.h"

namespace early_fusion::nn {

namespace {

using Json = nlohmann::json;

constexpr std::size_t kLengthBytes = 8;
constexpr std::uint64_t kMaxHeaderBytes = 32 << 20;
constexpr const char* kMetadataKey = "__metadata__";

// The digest is an entry of the metadata. It is that of the file's bytes with 0 for each of its own digits.
constexpr const char* kDigestKey = "digest";
constexpr std::size_t kDigestDigits = 32;
constexpr std::string_view kKeyInHeader = "\"digest\":";
constexpr std::string_view kKindInHeader = "\"xxh3-128:";

[[noreturn]] void fail(const std::string& where, const std::string& what) { throw core::Error(where + ": " + what); }

std::uint64_t littleEndian(const std::string& bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < kLengthBytes; ++i) {
    value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  }
  return value;
}

/// Whether the file starts as a text does, such as a YAML file that was given by mistake.
bool isText(const std::string& bytes) {
  return std::all_of(bytes.begin(), bytes.begin() + kLengthBytes, [](char c) {
    return std::isprint(static_cast<unsigned char>(c)) || std::isspace(static_cast<unsigned char>(c));
  });
}

std::uint64_t headerLength(const std::string& bytes, const std::string& source) {
  const std::uint64_t length = littleEndian(bytes);
  if (isText(bytes)) fail(source, "not a safetensors file, but a text; weights files end in .safetensors");
  if (length > kMaxHeaderBytes) {
    fail(source, "not a safetensors file: its header would be " + std::to_string(length) + " bytes long");
  }
  if (length > bytes.size() - kLengthBytes) {
    fail(source,
         "truncated: the header has " + std::to_string(length) + " bytes, the file " + std::to_string(bytes.size()));
  }
  return length;
}

/// The place of the digest's digits. Searches the bytes, because nothing of the file is believed yet.
/// @return npos if the file has no digest.
std::size_t findDigest(const std::string& bytes) {
  const std::string_view header(bytes.data(), std::min<std::size_t>(bytes.size(), kLengthBytes + kMaxHeaderBytes));
  const std::size_t at = header.find(std::string(kKeyInHeader) + std::string(kKindInHeader));
  return at == std::string_view::npos ? at : at + kKeyInHeader.size() + kKindInHeader.size();
}

/// @throws Error if the file has a digest and differs from it.
void checkDigest(const std::string& bytes, const std::string& source) {
  const std::string advice =
      "; copy or train it again (if another program changed it on purpose, let that program drop "
      "the metadata key 'digest')";
  const std::size_t at = findDigest(bytes);
  if (at == std::string::npos) {
    // One changed byte cannot hide both halves.
    const std::string_view header(bytes.data(), std::min<std::size_t>(bytes.size(), kLengthBytes + kMaxHeaderBytes));
    if (header.find(kKeyInHeader) == std::string_view::npos && header.find(kKindInHeader) == std::string_view::npos) {
      return;
    }
    fail(source, "the file is damaged: its digest cannot be read" + advice);
  }
  std::string blank = bytes;
  const std::string stored = bytes.substr(at, kDigestDigits);
  blank.replace(at, stored.size(), stored.size(), '0');
  const std::string digest = core::digestOf(blank);
  if (digest == stored) return;
  fail(source,
       "the file is damaged: it says that its digest is " + core::excerpt(stored) + ", but it is " + digest + advice);
}

/// Tensors in the order in which they are written: the widest types first, so that every tensor is aligned for its
/// type; by name within one width. @throws Error if a tensor's bytes do not fit its dtype and shape.
std::vector<std::string> writingOrder(const std::map<std::string, StoredTensor>& tensors) {
  std::vector<std::pair<std::uint64_t, std::string>> order;
  for (const auto& [name, tensor] : tensors) {
    const std::string where = "tensor '" + name + "'";
    const std::uint64_t wanted = byteCount(tensor, where);
    if (tensor.bytes.size() != wanted) {
      fail(where, "dtype and shape ask for " + std::to_string(wanted) + " bytes, it has " +
                      std::to_string(tensor.bytes.size()));
    }
    order.emplace_back(elementSize(tensor.dtype, where), name);
  }
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> names;
  for (auto& [size, name] : order) names.push_back(std::move(name));
  return names;
}

}  // namespace

WeightsFile WeightsFile::parse(const std::string& bytes, const std::string& source) {
  if (bytes.size() < kLengthBytes) fail(source, "truncated: a safetensors file starts with 8 bytes of header length");
  checkDigest(bytes, source);
  const std::uint64_t length = headerLength(bytes, source);
  const std::uint64_t start = kLengthBytes + length;
  WeightsHeader header = parseWeightsHeader(bytes.substr(kLengthBytes, length), bytes.size() - start, source);
  WeightsFile file;
  file.metadata = std::move(header.metadata);
  file.has_digest = file.metadata.erase(kDigestKey) > 0;
  file.tensors = std::move(header.tensors);
  for (const Extent& extent : header.extents) {
    file.tensors[extent.name].bytes = bytes.substr(start + extent.begin, extent.end - extent.begin);
  }
  return file;
}

WeightsFile WeightsFile::read(const std::string& path) {
  return core::namingOutOfMemory(path, [&] { return parse(core::readFile(path), path); });
}

std::string WeightsFile::serialize() const {
  Json header = Json::object();
  header[kMetadataKey] = metadata;
  header[kMetadataKey][kDigestKey] = std::string(kKindInHeader.substr(1)) + std::string(kDigestDigits, '0');
  std::string data;
  for (const std::string& name : writingOrder(tensors)) {
    const StoredTensor& tensor = tensors.at(name);
    header[name] = {{"dtype", tensor.dtype},
                    {"shape", tensor.shape},
                    {"data_offsets", {data.size(), data.size() + tensor.bytes.size()}}};
    data += tensor.bytes;
  }
  // A path in the options may not be UTF-8. Its bytes are replaced, so that no trained weights are lost.
  std::string text = header.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize((text.size() + 7) / 8 * 8, ' ');
  if (text.size() > kMaxHeaderBytes) {
    throw core::Error("the header would have " + std::to_string(text.size()) + " bytes, more than the maximum of " +
                      std::to_string(kMaxHeaderBytes));
  }
  std::string bytes;
  for (std::size_t i = 0; i < kLengthBytes; ++i) bytes += static_cast<char>(text.size() >> (8 * i) & 0xff);
  bytes += text + data;
  return bytes.replace(findDigest(bytes), kDigestDigits, core::digestOf(bytes));
}

void WeightsFile::write(const std::string& path) const { core::writeFileAtomically(path, serialize()); }

const std::string& WeightsFile::meta(const std::string& key, const std::string& source) const {
  const auto found = metadata.find(key);
  if (found == metadata.end()) fail(source, "metadata '" + key + "' is missing: these are not the weights of a policy");
  return found->second;
}

}  // namespace early_fusion::nn
