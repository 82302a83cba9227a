// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/result.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace dermis {
namespace {

Result<int> half(int number) {
  if (number % 2 != 0) return bad_input("odd");
  return number / 2;
}

TEST(Result, holds_a_value) {
  const Result<int> result = half(8);
  ASSERT_TRUE(result);
  EXPECT_TRUE(result.has_value());
  EXPECT_EQ(*result, 4);
  EXPECT_EQ(result.value(), 4);
}

TEST(Result, holds_an_error) {
  const Result<int> result = half(7);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(result.error().message, "odd");
}

TEST(Result, tells_bad_input_from_failure) {
  EXPECT_EQ(bad_input("x").kind, ErrorKind::bad_input);
  EXPECT_EQ(failed("x").kind, ErrorKind::failed);
}

TEST(Result, messages_hold_no_control_characters) {
  EXPECT_EQ(bad_input("a\nb\x1b[2Jc\x7f").message, "a?b?[2Jc?");
  EXPECT_EQ(failed("a\xC2\x9B"
                   "2Jb")
                .message,
            "a??2Jb")
      << "ESC [ of ISO 8859";
  EXPECT_EQ(failed("\xC2\xB0"
                   "C, \xC3\x9F")
                .message,
            "\xC2\xB0"
            "C, \xC3\x9F")
      << "text";
}

TEST(Result, moves_its_value_out) {
  Result<std::unique_ptr<int>> result = std::make_unique<int>(3);
  const std::unique_ptr<int> value = *std::move(result);
  EXPECT_EQ(*value, 3);
}

TEST(Result, gives_access_to_members) {
  Result<std::string> result = std::string("abc");
  result->push_back('d');
  EXPECT_EQ(result->size(), 4U);
}

TEST(Result, of_bool_tells_the_value_from_success) {
  const Result<bool> end = false;
  EXPECT_TRUE(end);
  EXPECT_FALSE(*end);
}

TEST(Status, is_success_when_done) {
  const Status status = Done{};
  EXPECT_TRUE(status);
}

#ifndef NDEBUG
TEST(ResultDeathTest, asserts_on_reading_the_value_of_an_error) {
  const Result<int> result = half(7);
  EXPECT_DEATH(static_cast<void>(*result), "has_value");
}
#endif

}  // namespace
}  // namespace dermis
