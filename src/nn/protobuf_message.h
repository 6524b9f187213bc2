#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace early_fusion::nn {

/// The bytes of a protobuf message, to which fields are added by their numbers.
/// Source: https://protobuf.dev/programming-guides/encoding
class ProtobufMessage {
 public:
  const std::string& bytes() const { return bytes_; }

  void add(int field, std::int64_t value) {
    addVarint(tag(field, kVarint));
    addVarint(static_cast<std::uint64_t>(value));
  }

  void add(int field, float value) {
    static_assert(sizeof value == 4);
    addVarint(tag(field, kFourBytes));
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(&bytes_[at], &value, sizeof value);
  }

  /// A text in UTF-8, or bytes.
  void add(int field, const std::string& text) {
    addVarint(tag(field, kLengthAndBytes));
    addVarint(text.size());
    bytes_ += text;
  }

  void add(int field, const ProtobufMessage& message) { add(field, message.bytes_); }

 private:
  static constexpr std::uint64_t kVarint = 0, kLengthAndBytes = 2, kFourBytes = 5;

  static std::uint64_t tag(int field, std::uint64_t wire_type) {
    return static_cast<std::uint64_t>(field) << 3 | wire_type;
  }

  /// Seven bits a byte, the lowest first. The top bit says that another byte follows.
  void addVarint(std::uint64_t value) {
    for (; value >= 128; value >>= 7) bytes_ += static_cast<char>((value & 127) | 128);
    bytes_ += static_cast<char>(value);
  }

  std::string bytes_;
};

}  // namespace early_fusion::nn
