#include "early_fusion/nn/onnx_model.h"

#include <gtest/gtest.h>

namespace early_fusion::nn {
namespace {

/// The bytes that hexadecimal digits stand for.
std::string bytesOf(const std::string& digits) {
  std::string bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
  }
  return bytes;
}

TEST(OnnxModel, HasTheBytesThatTheOnnxPackageWrites) {
  OnnxModel model;
  model.addInput("x", OnnxType::kByte, {1, 200}, "In.");
  const std::string tall = model.reshape("x", {-1, 200}, "tall");
  model.addNode("Softmax", {tall}, "y",
                {{"axis", std::int64_t{1}}, {"scale", 0.5f}, {"pads", std::vector<std::int64_t>{1, 300}}});
  const float weights[] = {1.5f, -2.f};
  EXPECT_EQ(model.addConstant("w", {1, 2}, weights), "w");
  model.addOutput("y", OnnxType::kFloat, {1, 200}, "Out.");
  // SerializeToString() of the same model in python3-onnx 1.12.
  EXPECT_EQ(model.serialize("A test.", {{"a", "1"}, {"b", "\u00b5"}}),
            bytesOf("0806120c6561726c795f667573696f6e32074120746573742e3aec010a240a01780a0a74616c6c2e7368617065120474"
                    "616c6c1a0474616c6c2207526573686170650a430a0474616c6c1201791a01792207536f66746d61782a0b0a046178"
                    "69731801a001022a0f0a057363616c65150000003fa001012a0e0a0470616473400140ac02a001071206706f6c6963"
                    "792a2208021007420a74616c6c2e73686170654a10ffffffffffffffffc8000000000000002a1308010802100142"
                    "01774a080000c03f000000c052074120746573742e5a190a0178120f0a0d080212090a0208010a0308c8011a03496e"
                    "2e621a0a0179120f0a0d080112090a0208010a0308c8011a044f75742e4202100b72060a016112013172070a016212"
                    "02c2b5"));
}

}  // namespace
}  // namespace early_fusion::nn
