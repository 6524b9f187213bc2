#include "early_fusion/model/policy_options.h"

#include <gtest/gtest.h>

#include "error_of.h"

namespace early_fusion::model {
namespace {

TEST(PolicyOptions, RefusesBadValuesNamingThem) {
  const auto with = [](const std::function<void(PolicyOptions&)>& change) {
    return [change] {
      PolicyOptions options;
      change(options);
      options.options().validate("policy");
    };
  };
  expectError(with([](PolicyOptions& o) { o.kind = "resnet"; }), "kind: 'resnet' is not one of the choices");
  expectError(with([](PolicyOptions& o) { o.channels = 20; }), "channels: '20' is not a multiple of 16");
  expectError(with([](PolicyOptions& o) { o.channels = 512; }),
              "channels: '512' is out of range; allowed: a multiple of 16 in [16, 256]");
  expectError(with([](PolicyOptions& o) { o.fusion_block = 4; }), "fusion_block: '4'");
  expectError(with([](PolicyOptions& o) { o.spatial_grid = "yes"; }), "spatial_grid: 'yes'");
  expectError(with([](PolicyOptions& o) { o.dropout = 1; }), "dropout: '1'");
  expectError(with([](PolicyOptions& o) { o.image_size = 100; }), "image_size: '100' is not a multiple of 16");
  expectError(with([](PolicyOptions& o) { o.precision = "fp8"; }), "precision: 'fp8'");
}

TEST(PolicyOptions, TheKindDecidesOnTheSpatialGridWhereTheUserDoesNot) {
  PolicyOptions options;
  EXPECT_TRUE(options.usesSpatialGrid(true));
  EXPECT_FALSE(options.usesSpatialGrid(false));
  options.spatial_grid = "true";
  EXPECT_TRUE(options.usesSpatialGrid(false));
  options.spatial_grid = "false";
  EXPECT_FALSE(options.usesSpatialGrid(true));
}

}  // namespace
}  // namespace early_fusion::model
