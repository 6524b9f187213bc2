#include "early_fusion/model/policy_kinds.h"

#include <gtest/gtest.h>

#include <set>

#include "error_of.h"
#include "small_networks.h"

namespace early_fusion::model {
namespace {

TEST(PolicyKinds, NamesAreDistinctAndTheFirstIsTheDefault) {
  const std::vector<std::string> names = policyKindNames();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  EXPECT_EQ(names.front(), PolicyOptions().kind);
  expectError([] { policyKind("resnet"); }, "resnet");
}

TEST(PolicyKinds, TheirOptionsAreOptionsOfPolicies) {
  PolicyOptions options;
  const core::OptionSet set = options.options();
  for (const PolicyKind& kind : policyKinds()) {
    for (const std::string& option : kind.options) EXPECT_TRUE(set.has(option)) << kind.name << ": " << option;
  }
}

TEST(PolicyKinds, MakeAPolicyOfTheirName) {
  for (const std::string& name : policyKindNames()) {
    PolicyOptions options = smallOptions();
    options.kind = name;
    const auto policy = makeSmall(options, 1), other = makeSmall(options, 2);
    EXPECT_EQ(policy->options().kind, name);
    EXPECT_EQ(policy->vocabulary(), testVocabulary(kSmallItems));
    EXPECT_NE(policy->parameters().values(), other->parameters().values()) << "the seed must decide the weights";
  }
}

TEST(PolicyKinds, HaveAsManyParametersAsTheirDesignSays) {
  struct Expected {
    const char* kind;
    int channels;
    const char* spatial_grid;
    Eigen::Index parameters;
  };
  const Expected cases[] = {{"early_fusion", 16, "auto", 27495},         {"early_fusion", 256, "auto", 6583815},
                            {"early_fusion", 16, "true", 27783},         {"late_fusion", 16, "auto", 25447},
                            {"late_fusion", 32, "auto", 97991},          {"late_fusion", 64, "auto", 384391},
                            {"late_fusion", 128, "auto", 1522439},       {"late_fusion", 256, "auto", 6059527},
                            {"late_fusion", 16, "true", 25735},          {"attention_map", 16, "auto", 9607},
                            {"attention_map", 16, "false", 9319},        {"attention_map", 32, "auto", 34055},
                            {"attention_map", 64, "auto", 127495},       {"attention_map", 128, "auto", 492551},
                            {"attention_map", 256, "auto", 1935367},     {"softmax_attention_map", 16, "auto", 9607},
                            {"softmax_attention_map", 16, "false", 9319}};
  for (const Expected& expected : cases) {
    PolicyOptions options;
    options.kind = expected.kind;
    options.channels = expected.channels;
    options.spatial_grid = expected.spatial_grid;
    const auto policy = makePolicy(options, testVocabulary(16), 1);
    EXPECT_EQ(policy->parameters().values().size(), expected.parameters)
        << expected.kind << ", " << expected.channels << " channels, spatial_grid " << expected.spatial_grid;
  }
}

TEST(PolicyKinds, RefuseBadOptionsAndAnEmptyVocabulary) {
  PolicyOptions options = smallOptions();
  options.channels = 20;
  expectError([&] { makeSmall(options); }, "channels: '20'");
  expectError([] { makePolicy(smallOptions(), core::Vocabulary(), 1); }, "vocabulary is empty");
}

}  // namespace
}  // namespace early_fusion::model
