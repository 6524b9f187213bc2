#include "early_fusion/core/excerpt.h"

#include <gtest/gtest.h>

namespace early_fusion::core {
namespace {

TEST(Excerpt, ShortTextsStayAsTheyAre) {
  EXPECT_EQ(excerpt(""), "");
  EXPECT_EQ(excerpt("größer, 杯子, 🍎"), "größer, 杯子, 🍎");
  EXPECT_EQ(excerpt(std::string(80, 'x')), std::string(80, 'x'));
}

TEST(Excerpt, CutsBetweenCharactersAndSaysHowLongTheTextIs) {
  EXPECT_EQ(excerpt(std::string(100000, '[')), std::string(80, '[') + "... (100000 bytes)");
  EXPECT_EQ(excerpt("äöü", 2), "äö... (6 bytes)");
}

TEST(Excerpt, ControlCharactersAndBytesThatAreNotUtf8BecomeQuestionMarks) {
  EXPECT_EQ(excerpt(std::string("a\nb\0c\x1b[31m\x7f", 11)), "a?b?c?[31m?");
  EXPECT_EQ(excerpt("\xff\xc3"), "??");                 // no character begins with ff; c3 lacks its second byte
  EXPECT_EQ(excerpt("\xc0\xaf\xed\xa0\x80"), "?????");  // an overlong '/', and half of a surrogate pair
}

}  // namespace
}  // namespace early_fusion::core
