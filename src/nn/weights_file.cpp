#include "early_fusion/nn/weights_file.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"

namespace early_fusion::nn {

namespace {

using Json = nlohmann::json;

constexpr std::uint64_t kLengthBytes = 8;
constexpr std::uint64_t kMostHeaderBytes = 100'000'000;  // the format's own limit
constexpr const char* kMetadataKey = "__metadata__";

const std::map<std::string, std::uint64_t>& typeSizes() {
  static const std::map<std::string, std::uint64_t> sizes = {
      {"BOOL", 1}, {"U8", 1},  {"I8", 1},  {"F8_E4M3", 1}, {"F8_E5M2", 1}, {"U16", 2}, {"I16", 2}, {"F16", 2},
      {"BF16", 2}, {"U32", 4}, {"I32", 4}, {"F32", 4},     {"U64", 8},     {"I64", 8}, {"F64", 8}};
  return sizes;
}

/// The place of a tensor's bytes, counted from the end of the header.
struct Extent {
  std::uint64_t begin;
  std::uint64_t end;
  std::string name;
};

[[noreturn]] void fail(const std::string& where, const std::string& what) { throw core::Error(where + ": " + what); }

std::uint64_t littleEndian(const std::string& bytes) {
  std::uint64_t value = 0;
  for (std::uint64_t i = 0; i < kLengthBytes; ++i) {
    value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  }
  return value;
}

std::uint64_t headerLength(const std::string& bytes, const std::string& source) {
  if (bytes.size() < kLengthBytes) fail(source, "truncated: a safetensors file starts with 8 bytes of header length");
  const std::uint64_t length = littleEndian(bytes);
  if (length > kMostHeaderBytes) {
    fail(source, "not a safetensors file: its header would be " + std::to_string(length) + " bytes long");
  }
  if (length > bytes.size() - kLengthBytes) {
    fail(source,
         "truncated: the header has " + std::to_string(length) + " bytes, the file " + std::to_string(bytes.size()));
  }
  return length;
}

Json parseHeader(const std::string& text, const std::string& source) {
  // If a name is listed twice, nlohmann::json drops one tensor without an error.
  std::vector<std::set<std::string>> keys;
  const auto watch = [&](int, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second) {
      fail(source, "the header names '" + parsed.get<std::string>() + "' twice");
    }
    return true;
  };
  try {
    Json header = Json::parse(text, watch);
    if (!header.is_object()) fail(source, "not a safetensors file: its header is not a JSON object");
    return header;
  } catch (const Json::exception& error) {
    fail(source, std::string("not a safetensors file: its header is not JSON: ") + error.what());
  }
}

std::uint64_t unsignedNumber(const Json& value, const std::string& where, const std::string& what) {
  if (!value.is_number_unsigned()) fail(where, what + " must be whole numbers of at least 0, not " + value.dump());
  return value.get<std::uint64_t>();
}

/// The number of bytes by dtype and shape. @throws Error if it overflows.
std::uint64_t byteCount(const StoredTensor& tensor, const std::string& where) {
  const auto type = typeSizes().find(tensor.dtype);
  if (type == typeSizes().end()) fail(where, "unknown dtype '" + tensor.dtype + "'");
  std::uint64_t count = type->second;
  for (std::int64_t edge : tensor.shape) {
    if (__builtin_mul_overflow(count, static_cast<std::uint64_t>(edge), &count)) fail(where, "its shape is too large");
  }
  return count;
}

StoredTensor parseEntry(const Json& entry, const std::string& where, Extent& extent) {
  for (const char* key : {"dtype", "shape", "data_offsets"}) {
    if (!entry.is_object() || !entry.contains(key)) fail(where, std::string("the header has no '") + key + "'");
  }
  StoredTensor tensor;
  if (!entry["dtype"].is_string()) fail(where, "dtype must be a text, not " + entry["dtype"].dump());
  tensor.dtype = entry["dtype"].get<std::string>();
  if (!entry["shape"].is_array()) fail(where, "shape must be a list, not " + entry["shape"].dump());
  for (const Json& edge : entry["shape"]) {
    const std::uint64_t value = unsignedNumber(edge, where, "the edges of shape");
    if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
      fail(where, "its shape is too large");
    }
    tensor.shape.push_back(static_cast<std::int64_t>(value));
  }
  const Json& offsets = entry["data_offsets"];
  if (!offsets.is_array() || offsets.size() != 2)
    fail(where, "data_offsets must be [begin, end], not " + offsets.dump());
  extent.begin = unsignedNumber(offsets[0], where, "data_offsets");
  extent.end = unsignedNumber(offsets[1], where, "data_offsets");
  if (extent.begin > extent.end) fail(where, "data_offsets end before they begin: " + offsets.dump());
  const std::uint64_t wanted = byteCount(tensor, where);
  if (extent.end - extent.begin != wanted) {
    fail(where, "dtype and shape ask for " + std::to_string(wanted) + " bytes, data_offsets give " +
                    std::to_string(extent.end - extent.begin));
  }
  return tensor;
}

/// Tensors must fill the file from the header to its end, without gaps and without overlaps.
void checkLayout(std::vector<Extent> extents, std::uint64_t size, const std::string& source) {
  std::sort(extents.begin(), extents.end(), [](const Extent& a, const Extent& b) {
    return std::tie(a.begin, a.end, a.name) < std::tie(b.begin, b.end, b.name);
  });
  std::uint64_t end = 0;
  for (const Extent& extent : extents) {
    const std::string where = source + ": tensor '" + extent.name + "'";
    if (extent.begin < end) fail(where, "overlaps another tensor");
    if (extent.begin > end) fail(where, "follows a gap of " + std::to_string(extent.begin - end) + " bytes");
    end = extent.end;
    if (end > size) {
      fail(where,
           "truncated: it ends at byte " + std::to_string(end) + " of the data, which has " + std::to_string(size));
    }
  }
  if (end < size) fail(source, std::to_string(size - end) + " bytes follow the last tensor");
}

std::map<std::string, std::string> parseMetadata(const Json& metadata, const std::string& source) {
  if (!metadata.is_object()) fail(source, "the header's __metadata__ is not a map");
  std::map<std::string, std::string> texts;
  for (const auto& [key, value] : metadata.items()) {
    if (!value.is_string()) fail(source, "metadata '" + key + "' is not a text but " + value.dump());
    texts[key] = value.get<std::string>();
  }
  return texts;
}

}  // namespace

WeightsFile WeightsFile::parse(const std::string& bytes, const std::string& source) {
  const std::uint64_t length = headerLength(bytes, source);
  const Json header = parseHeader(bytes.substr(kLengthBytes, length), source);
  const std::uint64_t start = kLengthBytes + length;
  WeightsFile file;
  std::vector<Extent> extents;
  for (const auto& [name, entry] : header.items()) {
    if (name == kMetadataKey) {
      file.metadata = parseMetadata(entry, source);
      continue;
    }
    Extent extent{0, 0, name};
    file.tensors[name] = parseEntry(entry, source + ": tensor '" + name + "'", extent);
    extents.push_back(extent);
  }
  checkLayout(extents, bytes.size() - start, source);
  for (const Extent& extent : extents) {
    file.tensors[extent.name].bytes = bytes.substr(start + extent.begin, extent.end - extent.begin);
  }
  return file;
}

WeightsFile WeightsFile::read(const std::string& path) { return parse(core::readFile(path), path); }

std::string WeightsFile::serialize() const {
  Json header = Json::object();
  if (!metadata.empty()) header[kMetadataKey] = metadata;
  // The widest types first, so that every tensor is aligned for its type; by name within one width.
  std::vector<std::pair<std::uint64_t, const std::string*>> order;
  for (const auto& [name, tensor] : tensors) {
    const std::string where = "tensor '" + name + "'";
    const std::uint64_t wanted = byteCount(tensor, where);
    if (tensor.bytes.size() != wanted) {
      fail(where, "dtype and shape ask for " + std::to_string(wanted) + " bytes, it has " +
                      std::to_string(tensor.bytes.size()));
    }
    order.push_back({typeSizes().at(tensor.dtype), &name});
  }
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string data;
  for (const auto& [size, name] : order) {
    const StoredTensor& tensor = tensors.at(*name);
    header[*name] = {{"dtype", tensor.dtype},
                     {"shape", tensor.shape},
                     {"data_offsets", {data.size(), data.size() + tensor.bytes.size()}}};
    data += tensor.bytes;
  }
  std::string text;
  try {
    text = header.dump();
  } catch (const Json::exception& error) {
    throw core::Error(std::string("metadata must be UTF-8 text: ") + error.what());
  }
  text.resize((text.size() + 7) / 8 * 8, ' ');
  std::string bytes;
  for (std::uint64_t i = 0; i < kLengthBytes; ++i) bytes += static_cast<char>(text.size() >> (8 * i) & 0xff);
  return bytes + text + data;
}

void WeightsFile::write(const std::string& path) const { core::writeFileAtomically(path, serialize()); }

const std::string& WeightsFile::meta(const std::string& key, const std::string& source) const {
  const auto found = metadata.find(key);
  if (found == metadata.end()) fail(source, "metadata '" + key + "' is missing: these are not the weights of a policy");
  return found->second;
}

}  // namespace early_fusion::nn
