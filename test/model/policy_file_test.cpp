#include "early_fusion/model/policy_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <set>

#include "early_fusion/core/file.h"
#include "error_of.h"
#include "small_networks.h"

namespace early_fusion::model {
namespace {

using PolicyFileTest = SmallNetworkTest;

INSTANTIATE_TEST_SUITE_P(Kinds, PolicyFileTest, testing::ValuesIn(everySmallNetwork()), networkName);

TEST_P(PolicyFileTest, SavesAndLoadsTheSamePolicy) {
  PolicyOptions options = GetParam();
  options.dropout = 0.25;
  options.horizontal_fov_deg = 47.5;
  const auto policy = makeSmall(options, 5);
  const TestBatch batch(4, kSmallImage, kSmallItems, 3);
  train(*policy, batch, 2);
  nn::WeightsFile file = savePolicy(*policy, {{"preset", "fast"}});
  EXPECT_EQ(file.metadata.at("preset"), "fast");
  file.tensors["adam.first_moment"] = {"U8", {1}, "x"};  // a checkpoint holds more than the policy
  const auto loaded = loadPolicy(nn::WeightsFile::parse(file.serialize(), "memory"), "memory", options.precision);
  EXPECT_EQ(loaded->options().kind, options.kind);
  EXPECT_EQ(loaded->options().fusion_block, options.fusion_block);
  EXPECT_EQ(loaded->options().dropout, 0.25);
  EXPECT_EQ(loaded->options().image_size, 32);
  EXPECT_EQ(loaded->options().horizontal_fov_deg, 47.5);
  EXPECT_EQ(loaded->vocabulary(), policy->vocabulary());
  Probabilities before, after;
  policy->predict(batch.observations(), before);
  loaded->predict(batch.observations(), after);
  EXPECT_EQ(before, after);
  EXPECT_EQ(policy->lossAndGradients(batch.samples, 9), loaded->lossAndGradients(batch.samples, 9));
}

TEST(PolicyFile, HoldsWhatItsKindNeedsAndNoMore) {
  const std::set<std::string> always = {"format", "kind", "vocabulary", "actions", "horizontal_fov_deg"};
  for (const PolicyKind& kind : policyKinds()) {
    PolicyOptions options = smallOptions();
    options.kind = kind.name;
    std::set<std::string> expected = always, found;
    expected.insert(kind.options.begin(), kind.options.end());
    for (const auto& [key, value] : savePolicy(*makeSmall(options), {}).metadata) found.insert(key);
    EXPECT_EQ(found, expected) << kind.name;
  }
  const nn::WeightsFile file = savePolicy(*makeSmall(smallOptions()), {});
  EXPECT_EQ(file.metadata.at("actions"), R"(["PAN_LEFT","PAN_RIGHT","TILT_UP","TILT_DOWN","COLLECT","REMOVE","IDLE"])");
  EXPECT_EQ(file.metadata.at("horizontal_fov_deg"), "60");
}

TEST(PolicyFile, SaysWhetherThereIsASpatialGridAndNotHowThatWasChosen) {
  PolicyOptions options = smallOptions();
  EXPECT_EQ(savePolicy(*makeSmall(options), {}).metadata.at("spatial_grid"), "false");
  options.spatial_grid = "true";
  EXPECT_EQ(savePolicy(*makeSmall(options), {}).metadata.at("spatial_grid"), "true");
  options.kind = "attention_map";
  options.spatial_grid = "auto";
  EXPECT_EQ(savePolicy(*makeSmall(options), {}).metadata.at("spatial_grid"), "true");
}

/// The error of loadPolicy() for a changed file.
std::string loadErrorAfter(const std::function<void(nn::WeightsFile&)>& change) {
  nn::WeightsFile file = savePolicy(*makeSmall(smallOptions()), {});
  change(file);
  const std::string error = errorOf([&] { loadPolicy(file, "run/weights.safetensors"); });
  EXPECT_EQ(error.rfind("run/weights.safetensors", 0), 0u) << error;
  return error;
}

void setNumber(nn::StoredTensor& tensor, std::size_t index, float number) {
  std::memcpy(&tensor.bytes[index * sizeof number], &number, sizeof number);
}

TEST(PolicyFile, NamesWhatIsWrongWithMetadata) {
  const std::vector<std::tuple<std::string, std::string, std::string>> cases = {
      {"format", "early_fusion/9", "metadata 'format' is 'early_fusion/9'"},
      {"kind", "resnet", "resnet"},
      {"channels", "many", "many"},
      {"channels", "24", "channels: '24'"},
      {"fusion_block", "9", "9"},
      {"spatial_grid", "yes", "spatial_grid: 'yes'"},
      {"image_size", "33", "image_size: '33'"},
      {"vocabulary", "mug, bowl", "metadata 'vocabulary' is not a JSON list"},
      {"vocabulary", "[\"mug\",\"mug\"]", "metadata 'vocabulary'"},
      {"vocabulary", "[]", "vocabulary"},
      {"actions", "PAN_LEFT, IDLE", "metadata 'actions' is PAN_LEFT, IDLE; this version has [\"PAN_LEFT\""},
      {"actions", R"(["PAN_RIGHT","PAN_LEFT","TILT_UP","TILT_DOWN","COLLECT","REMOVE","IDLE"])", "in this order"},
      {"actions", R"(["PAN_LEFT","PAN_RIGHT","TILT_UP","TILT_DOWN","COLLECT","REMOVE"])", "\"REMOVE\"]; this version"},
      {"horizontal_fov_deg", "0", "horizontal_fov_deg: '0' is out of range"},
      {"horizontal_fov_deg", "wide", "horizontal_fov_deg: 'wide'"}};
  for (const auto& one : cases) {
    const std::string error =
        loadErrorAfter([&](nn::WeightsFile& file) { file.metadata[std::get<0>(one)] = std::get<1>(one); });
    EXPECT_NE(error.find(std::get<2>(one)), std::string::npos) << error;
  }
  for (const char* key : {"format", "kind", "channels", "fusion_block", "spatial_grid", "dropout", "image_size",
                          "vocabulary", "actions", "horizontal_fov_deg"}) {
    const std::string error = loadErrorAfter([&](nn::WeightsFile& file) { file.metadata.erase(key); });
    EXPECT_NE(error.find(std::string("metadata '") + key + "' is missing"), std::string::npos) << error;
  }
}

TEST(PolicyFile, NamesWhatIsWrongWithATensor) {
  using Change = std::function<void(nn::WeightsFile&)>;
  const std::vector<std::pair<Change, std::string>> cases = {
      {[](nn::WeightsFile& f) { f.tensors.erase("block2.conv.bias"); }, "'block2.conv.bias' is missing"},
      {[](nn::WeightsFile& f) { f.tensors.erase("block4.norm.running_var"); }, "'block4.norm.running_var' is missing"},
      {[](nn::WeightsFile& f) { f.tensors["hidden.weight"].dtype = "I32"; }, "'hidden.weight' has type I32"},
      {[](nn::WeightsFile& f) {
         f.tensors["hidden.weight"].shape = {64, 16};
       },
       "'hidden.weight' has shape (64,16); by the file's metadata it must be (16,64)"},
      {[](nn::WeightsFile& f) { f.metadata["channels"] = "32"; }, "'block1.conv.weight' has shape (16,9,3,3)"},
      {[](nn::WeightsFile& f) { f.metadata["vocabulary"] = R"(["mug"])"; }, "'embedding.weight' has shape (16,6)"},
      {[](nn::WeightsFile& f) { setNumber(f.tensors["output.bias"], 3, std::nanf("")); },
       "'output.bias' holds nan at index 3"},
      {[](nn::WeightsFile& f) { setNumber(f.tensors["output.bias"], 3, INFINITY); }, "'output.bias' holds inf"},
      {[](nn::WeightsFile& f) { setNumber(f.tensors["block1.norm.running_var"], 0, -1.f); },
       "'block1.norm.running_var' holds -1"}};
  for (const auto& [change, part] : cases) {
    const std::string error = loadErrorAfter(change);
    EXPECT_NE(error.find(part), std::string::npos) << error;
  }
}

TEST(PolicyFile, ShippedWeightsLoad) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(core::shareFolder() + "/models")) {
    if (entry.path().extension() != ".safetensors") continue;
    SCOPED_TRACE(entry.path().string());
    const std::string path = entry.path().string();
    const auto policy = loadPolicy(nn::WeightsFile::read(path), path, "f32");
    EXPECT_EQ(policy->options().horizontal_fov_deg, 60);
    EXPECT_EQ(policy->vocabulary().size(), 16);
    ++files;
  }
  EXPECT_GE(files, 3);
}

}  // namespace
}  // namespace early_fusion::model
