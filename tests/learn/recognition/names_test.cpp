// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/names.hpp"

#include <gtest/gtest.h>

namespace dermis::learn::recognition {
namespace {

TEST(Names, of_classes_are_plain_text) {
  for (const char* const name : {"cup", "a b, c \"d\"", "\xC3\xB6\xC3\x9F", "\xE6\x8A\xBC"}) {
    EXPECT_TRUE(check_class_name(name)) << name;
  }
  for (const char* const name : {"Gr\xF6\xDF", "a\nb", "a\tb", "\x7F", "\xC3", "\xED\xA0\x80"}) {
    const Status status = check_class_name(name);
    ASSERT_FALSE(status) << name;
    EXPECT_NE(status.error().message.find("must be UTF-8 without control characters"), std::string::npos);
    EXPECT_EQ(status.error().message.find('\n'), std::string::npos);
  }
}

TEST(Names, of_classes_are_not_that_of_the_answer_for_no_class) {
  const Status status = check_class_name("unknown");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().message, "class 'unknown' is the answer for what is like no class; give it another name");
  EXPECT_TRUE(check_class_name("Unknown"));
}

}  // namespace
}  // namespace dermis::learn::recognition
