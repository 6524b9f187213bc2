#include "early_fusion/core/vocabulary.h"

#include <gtest/gtest.h>

#include "early_fusion/core/error.h"

namespace early_fusion::core {
namespace {

TEST(Vocabulary, RequestsAreSortedAndKeepRepetitions) {
  const Vocabulary vocabulary({"mug", "bowl", "plate"});
  EXPECT_EQ(vocabulary.request({"plate", "mug", "plate"}), (Request{0, 2, 2}));
  EXPECT_EQ(vocabulary.names(Request{0, 2, 2}), (std::vector<std::string>{"mug", "plate", "plate"}));
}

TEST(Vocabulary, ARequestIsCountedByItem) {
  const Request request{0, 2, 2};
  EXPECT_EQ(countOf(request, 2), 2);
  EXPECT_EQ(countOf(request, 1), 0);
  EXPECT_EQ(countOf(request, -1), 0);
}

TEST(Vocabulary, UnknownItemIsAnErrorThatListsTheKnown) {
  try {
    Vocabulary({"mug", "bowl"}).index("cup");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "unknown item 'cup'; known are mug, bowl");
  }
}

TEST(Vocabulary, RefusesEmptyAndRepeatedNames) {
  EXPECT_THROW(Vocabulary({"mug", ""}), Error);
  EXPECT_THROW(Vocabulary({"mug", "mug"}), Error);
}

TEST(Vocabulary, RefusesItemsOutOfRange) {
  const Vocabulary vocabulary({"mug"});
  EXPECT_THROW(vocabulary.name(1), Error);
  EXPECT_THROW(vocabulary.name(-1), Error);
}

}  // namespace
}  // namespace early_fusion::core
