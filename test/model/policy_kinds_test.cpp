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

TEST(PolicyKinds, RefuseBadOptionsAndAnEmptyVocabulary) {
  PolicyOptions options = smallOptions();
  options.channels = 20;
  expectError([&] { makeSmall(options); }, "channels: '20'");
  expectError([] { makePolicy(smallOptions(), core::Vocabulary(), 1); }, "vocabulary is empty");
}

}  // namespace
}  // namespace early_fusion::model
