#include "weights_header.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"

namespace early_fusion::nn {

namespace {

using core::excerpt;
using Json = nlohmann::json;

constexpr const char* kMetadataKey = "__metadata__";
constexpr int kMaxDepth = 8;  // the format needs three: the header, a tensor, its shape

[[noreturn]] void fail(const std::string& where, const std::string& what) { throw core::Error(where + ": " + what); }

/// The functions that read JSON call themselves for each level, so a deep header would overflow the stack.
void checkDepth(const std::string& json, const std::string& source) {
  int depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_text && c == '\\') ++i;  // the next character is escaped
    if (c == '"') in_text = !in_text;
    if (in_text) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kMaxDepth) {
      fail(source, "not a safetensors file: its header is nested more than " + std::to_string(kMaxDepth) + " deep");
    }
  }
}

Json parseJson(const std::string& text, const std::string& source) {
  checkDepth(text, source);
  // If a name is listed twice, nlohmann::json drops one tensor without an error.
  std::vector<std::set<std::string>> keys;
  const auto watch = [&](int, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second) {
      fail(source, "the header names '" + excerpt(parsed.get<std::string>()) + "' twice");
    }
    return true;
  };
  try {
    Json header = Json::parse(text, watch);
    if (!header.is_object()) fail(source, "not a safetensors file: its header is not a JSON object");
    return header;
  } catch (const Json::exception& error) {
    fail(source, "not a safetensors file: its header is not JSON: " + excerpt(error.what(), 160));
  }
}

std::uint64_t unsignedNumber(const Json& value, const std::string& where, const std::string& what) {
  if (!value.is_number_unsigned()) {
    fail(where, what + " must be whole numbers of at least 0, not " + excerpt(value.dump()));
  }
  return value.get<std::uint64_t>();
}

StoredTensor parseEntry(const Json& entry, const std::string& where, Extent& extent) {
  for (const char* key : {"dtype", "shape", "data_offsets"}) {
    if (!entry.is_object() || !entry.contains(key)) fail(where, std::string("the header has no '") + key + "'");
  }
  StoredTensor tensor;
  if (!entry["dtype"].is_string()) fail(where, "dtype must be a text, not " + excerpt(entry["dtype"].dump()));
  tensor.dtype = entry["dtype"].get<std::string>();
  if (!entry["shape"].is_array()) fail(where, "shape must be a list, not " + excerpt(entry["shape"].dump()));
  for (const Json& edge : entry["shape"]) {
    const std::uint64_t value = unsignedNumber(edge, where, "the edges of shape");
    if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
      fail(where, "its shape is too large");
    }
    tensor.shape.push_back(static_cast<std::int64_t>(value));
  }
  const Json& offsets = entry["data_offsets"];
  if (!offsets.is_array() || offsets.size() != 2) {
    fail(where, "data_offsets must be [begin, end], not " + excerpt(offsets.dump()));
  }
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
void checkLayout(const std::vector<Extent>& extents, std::uint64_t size, const std::string& source) {
  std::uint64_t end = 0;
  for (const Extent& extent : extents) {
    const std::string where = source + ": tensor '" + excerpt(extent.name) + "'";
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
    if (!value.is_string()) {
      fail(source, "metadata '" + excerpt(key) + "' is not a text but " + excerpt(value.dump()));
    }
    texts[key] = value.get<std::string>();
  }
  return texts;
}

}  // namespace

std::uint64_t elementSize(const std::string& dtype, const std::string& where) {
  static const std::map<std::string, std::uint64_t> sizes = {
      {"BOOL", 1}, {"U8", 1},  {"I8", 1},  {"F8_E4M3", 1}, {"F8_E5M2", 1}, {"U16", 2}, {"I16", 2}, {"F16", 2},
      {"BF16", 2}, {"U32", 4}, {"I32", 4}, {"F32", 4},     {"U64", 8},     {"I64", 8}, {"F64", 8}};
  const auto size = sizes.find(dtype);
  if (size == sizes.end()) fail(where, "unknown dtype '" + excerpt(dtype) + "'");
  return size->second;
}

std::uint64_t byteCount(const StoredTensor& tensor, const std::string& where) {
  std::uint64_t count = elementSize(tensor.dtype, where);
  for (std::int64_t edge : tensor.shape) {
    if (__builtin_mul_overflow(count, static_cast<std::uint64_t>(edge), &count)) fail(where, "its shape is too large");
  }
  return count;
}

WeightsHeader parseWeightsHeader(const std::string& text, std::uint64_t data_bytes, const std::string& source) {
  const Json json = parseJson(text, source);
  WeightsHeader header;
  for (const auto& [name, entry] : json.items()) {
    if (name == kMetadataKey) {
      header.metadata = parseMetadata(entry, source);
      continue;
    }
    Extent extent{0, 0, name};
    header.tensors[name] = parseEntry(entry, source + ": tensor '" + excerpt(name) + "'", extent);
    header.extents.push_back(extent);
  }
  std::sort(header.extents.begin(), header.extents.end(), [](const Extent& a, const Extent& b) {
    return std::tie(a.begin, a.end, a.name) < std::tie(b.begin, b.end, b.name);
  });
  checkLayout(header.extents, data_bytes, source);
  return header;
}

}  // namespace early_fusion::nn
