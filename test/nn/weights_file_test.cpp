#include "early_fusion/nn/weights_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"

namespace early_fusion::nn {
namespace {

WeightsFile sample() {
  WeightsFile file;
  file.metadata = {{"kind", "early_fusion"}, {"note", "quotes \" and \n and ü"}};
  file.tensors["b.weight"] = {"F32", {2, 3}, std::string(24, 'x')};
  file.tensors["a.count"] = {"I64", {1}, std::string("\1\0\0\0\0\0\0\0", 8)};
  file.tensors["frames"] = {"U8", {3}, "abc"};
  file.tensors["empty"] = {"F32", {0, 5}, ""};
  file.tensors["scalar"] = {"F32", {}, "1234"};
  return file;
}

/// A file with this header, and `data` behind it.
std::string withHeader(const std::string& header, const std::string& data = "") {
  std::string bytes;
  for (int i = 0; i < 8; ++i) bytes += static_cast<char>(header.size() >> (8 * i) & 0xff);
  return bytes + header + data;
}

std::string errorOf(const std::string& bytes) {
  try {
    WeightsFile::parse(bytes, "some.safetensors");
  } catch (const core::Error& error) {
    EXPECT_EQ(std::string(error.what()).rfind("some.safetensors", 0), 0u) << error.what();
    return error.what();
  }
  return "no error";
}

void expectError(const std::string& bytes, const std::string& part) {
  const std::string error = errorOf(bytes);
  EXPECT_NE(error.find(part), std::string::npos) << error;
}

TEST(WeightsFile, RoundTripsThroughBytesAndDisk) {
  const WeightsFile file = sample();
  const std::string path = std::filesystem::temp_directory_path() /
                           ("early_fusion_weights_test" + std::to_string(::getpid()) + ".safetensors");
  file.write(path);
  const WeightsFile read = WeightsFile::read(path);
  std::filesystem::remove(path);
  EXPECT_EQ(read.metadata, file.metadata);
  ASSERT_EQ(read.tensors.size(), file.tensors.size());
  for (const auto& [name, tensor] : file.tensors) {
    EXPECT_EQ(read.tensors.at(name).dtype, tensor.dtype) << name;
    EXPECT_EQ(read.tensors.at(name).shape, tensor.shape) << name;
    EXPECT_EQ(read.tensors.at(name).bytes, tensor.bytes) << name;
  }
  EXPECT_EQ(read.serialize(), file.serialize());
}

TEST(WeightsFile, AlignsTensorsForTheirTypes) {
  const std::string bytes = sample().serialize();
  const std::size_t header = static_cast<unsigned char>(bytes[0]) + 256u * static_cast<unsigned char>(bytes[1]);
  EXPECT_EQ((8 + header) % 8, 0u);
  EXPECT_NE(bytes.find("\"data_offsets\":[0,8],\"dtype\":\"I64\""), std::string::npos) << bytes.substr(8, header);
}

TEST(WeightsFile, ReportsEveryTruncation) {
  const std::string bytes = sample().serialize();
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const std::string error = errorOf(bytes.substr(0, length));
    const bool reported = error.find("truncated") != std::string::npos || error.find("damaged") != std::string::npos;
    EXPECT_TRUE(reported) << "at " << length << ": " << error;
  }
}

TEST(WeightsFile, EveryBitThatFlipsIsReportedAsDamage) {
  const std::string bytes = sample().serialize();
  ASSERT_TRUE(WeightsFile::parse(bytes, "s").has_digest);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string flipped = bytes;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << bit % 8);
    const std::string error = errorOf(flipped);
    EXPECT_NE(error.find("the file is damaged"), std::string::npos) << "bit " << bit << ": " << error;
  }
}

TEST(WeightsFile, FilesOfOtherProgramsNeedNoDigest) {
  const WeightsFile file = WeightsFile::parse(
      withHeader(R"({"__metadata__":{"format":"pt"},"w":{"dtype":"U8","shape":[2],"data_offsets":[0,2]}})", "ab"), "s");
  EXPECT_FALSE(file.has_digest);
  EXPECT_EQ(file.metadata.at("format"), "pt");
  EXPECT_EQ(file.tensors.at("w").bytes, "ab");
}

TEST(WeightsFile, RefusesDeepHeadersBeforeItParsesThem) {
  const std::string deep = std::string(150000, '[') + std::string(150000, ']');
  for (const std::string& header :
       {R"({"w":{"dtype":"F32","shape":)" + deep + R"(,"data_offsets":[0,0]}})",
        R"({"w":{"dtype":)" + deep + R"(,"shape":[1],"data_offsets":[0,4]}})",
        R"({"w":{"dtype":"F32","shape":[1],"data_offsets":)" + deep + "}}", R"({"__metadata__":{"a":)" + deep + "}}"}) {
    EXPECT_EQ(errorOf(withHeader(header, "1234")),
              "some.safetensors: not a safetensors file: its header is nested more than 8 deep");
  }
  const std::string brackets = R"({"__metadata__":{"a":"[[[[[[[[[[{{{{{\"[[[["}})";  // in a text they are no nesting
  EXPECT_EQ(errorOf(withHeader(brackets)), "no error");
}

TEST(WeightsFile, ShowsOnlyTheStartOfForeignValues) {
  const std::string lots(100000, 'x');
  for (const std::string& header :
       {R"({"w":{"dtype":")" + lots + R"(","shape":[1],"data_offsets":[0,1]}})",
        R"({"w":{"dtype":"F32","shape":")" + lots + R"(","data_offsets":[0,1]}})",
        R"({"w":{"dtype":"F32","shape":[1],"data_offsets":")" + lots + R"("}})", R"({")" + lots + R"(":3})",
        R"({"__metadata__":{")" + lots + R"(":[")" + lots + R"("]}})", "{\"" + lots,
        R"({"a":1,")" + lots + R"(":1,")" + lots + R"(":1})"}) {
    const std::string error = errorOf(withHeader(header, "1"));
    EXPECT_NE(error, "no error");
    EXPECT_LT(error.size(), 400u) << error;
  }
}

TEST(WeightsFile, SaysThatATextIsNoWeightsFile) {
  EXPECT_EQ(errorOf("objects: objects.yaml\n"),
            "some.safetensors: not a safetensors file, but a text; weights files end in .safetensors");
}

TEST(WeightsFile, RefusesBytesThatBelongToNoTensor) {
  expectError(sample().serialize() + "x", "damaged");
  expectError(withHeader("{}", "x"), "1 bytes follow the last tensor");
  expectError(withHeader(R"({"a":{"dtype":"U8","shape":[2],"data_offsets":[3,5]}})", "12345"), "gap of 3 bytes");
}

TEST(WeightsFile, RefusesHeadersThatAreNone) {
  expectError(std::string(8, '\xff') + "{}", "not a safetensors file");
  expectError(withHeader("[1]"), "not a JSON object");
  expectError(withHeader("{"), "not JSON");
  expectError("PK\3\4 a zip file, as torch.save writes", "not a safetensors file");
  expectError(withHeader(R"({"__metadata__":{"a":1}})"), "metadata 'a' is not a text");
  expectError(withHeader(R"({"a":{"dtype":"U8","shape":[1],"data_offsets":[0,1]},)"
                         R"("a":{"dtype":"U8","shape":[1],"data_offsets":[0,1]}})",
                         "1"),
              "names 'a' twice");
}

TEST(WeightsFile, RefusesTensorsThatDoNotFit) {
  const auto entry = [](const std::string& dtype, const std::string& shape, const std::string& offsets) {
    return withHeader(R"({"w":{"dtype":")" + dtype + R"(","shape":)" + shape + R"(,"data_offsets":)" + offsets + "}}",
                      "12345678");
  };
  EXPECT_EQ(errorOf(entry("F32", "[2]", "[0,8]")), "no error");
  expectError(entry("F33", "[2]", "[0,8]"), "tensor 'w': unknown dtype 'F33'");
  expectError(entry("F32", "[3]", "[0,8]"), "ask for 12 bytes, data_offsets give 8");
  expectError(entry("F32", "[-2]", "[0,8]"), "whole numbers of at least 0, not -2");
  expectError(entry("F32", "[2]", "[8,0]"), "end before they begin");
  expectError(entry("F32", "[2]", "[0]"), "must be [begin, end]");
  expectError(entry("F32", "\"2\"", "[0,8]"), "shape must be a list");
  expectError(entry("F32", "[4]", "[0,16]"), "truncated");
  expectError(entry("F32", "[4611686018427387904,4]", "[0,8]"), "too large");
  expectError(withHeader(R"({"w":{"dtype":"F32","shape":[2]}})"), "no 'data_offsets'");
  expectError(withHeader(R"({"w":3})"), "tensor 'w'");
}

TEST(WeightsFile, RefusesOverlaps) {
  expectError(withHeader(R"({"a":{"dtype":"U8","shape":[4],"data_offsets":[0,4]},)"
                         R"("b":{"dtype":"U8","shape":[4],"data_offsets":[2,6]}})",
                         "123456"),
              "tensor 'b': overlaps another tensor");
}

TEST(WeightsFile, RefusesToWriteWhatItCouldNotRead) {
  WeightsFile file = sample();
  file.tensors["b.weight"].bytes.pop_back();
  EXPECT_THROW(file.serialize(), core::Error);
}

TEST(WeightsFile, MetadataThatAreNotUtf8AreWrittenWithReplacements) {
  WeightsFile file = sample();
  file.metadata["note"] = "\xff is not UTF-8";
  EXPECT_EQ(WeightsFile::parse(file.serialize(), "s").metadata.at("note"), "\xef\xbf\xbd is not UTF-8");
}

TEST(WeightsFile, NamesAMissingKeyAndAMissingFile) {
  try {
    sample().meta("vocabulary", "some.safetensors");
    FAIL() << "no error";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("some.safetensors: metadata 'vocabulary' is missing"), std::string::npos);
  }
  EXPECT_THROW(WeightsFile::read("/no/such/file.safetensors"), core::Error);
}

}  // namespace
}  // namespace early_fusion::nn
