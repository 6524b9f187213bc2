#include "early_fusion/core/names.h"

#include <gtest/gtest.h>

#include <map>

#include "early_fusion/core/error.h"

namespace early_fusion::core {
namespace {

const std::vector<std::string> kNames = {"mug", "bowl", "plate"};

TEST(Names, AreJoinedInTheirOrder) {
  EXPECT_EQ(joined(kNames), "mug, bowl, plate");
  EXPECT_EQ(joined({"", "mug"}, " | "), " | mug");
  EXPECT_EQ(joined({}), "");
  EXPECT_EQ(joined(keys(std::map<std::string, int>{{"b", 1}, {"a", 2}})), "a, b");
}

TEST(Names, ForeignOnesAreListedByExcerpts) {
  EXPECT_EQ(listed(kNames), "mug, bowl, plate");
  EXPECT_EQ(listed({std::string(50, 'x'), "b\n"}), std::string(40, 'x') + "... (50 bytes), b?");
  const std::string most = listed(std::vector<std::string>(32, "a"));
  EXPECT_EQ(most.substr(most.size() - 6), ", a, a");
  const std::string many = listed(std::vector<std::string>(100000, "a"));
  EXPECT_EQ(many, most + ", ... (100000 names)");
}

TEST(Names, AreSplitAtCommasWithoutSpacesAroundThem) {
  EXPECT_EQ(splitNames(" mug,tomato soup ,, bowl"), (std::vector<std::string>{"mug", "tomato soup", "bowl"}));
  EXPECT_TRUE(splitNames(" , ").empty());
}

TEST(Names, AnUnknownOneIsAnErrorThatListsTheKnown) {
  EXPECT_EQ(indexOf("bowl", kNames, "item"), 1);
  try {
    indexOf("cup", kNames, "item");
    FAIL() << "found";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "unknown item 'cup'; known are mug, bowl, plate");
  }
}

}  // namespace
}  // namespace early_fusion::core
