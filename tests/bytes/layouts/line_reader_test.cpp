// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/layouts/line_reader.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace dermis::bytes::layouts {
namespace {

void push(LineReader& lines, std::string_view text) {
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  lines.push(bytes);
}

std::string next(LineReader& lines) {
  const std::span<const std::uint8_t> line = lines.next();
  return {line.begin(), line.end()};
}

TEST(LineReader, gives_lines_with_their_end_as_soon_as_it_has_come) {
  LineReader lines(100);
  push(lines, "ab\nc");
  EXPECT_EQ(next(lines), "ab\n");
  EXPECT_EQ(next(lines), "");
  push(lines, "d\n");
  EXPECT_EQ(next(lines), "cd\n");
  EXPECT_EQ(lines.position(), 6U);
}

TEST(LineReader, a_line_may_end_with_any_byte) {
  LineReader lines(100, '\r');
  push(lines, "a\nb\rc\r");
  EXPECT_EQ(next(lines), "a\nb\r");
  EXPECT_EQ(next(lines), "c\r");
}

TEST(LineReader, what_is_longer_than_a_line_comes_in_pieces) {
  LineReader lines(4);
  push(lines, "abcdefg\n");
  EXPECT_EQ(next(lines), "abcd");
  EXPECT_EQ(next(lines), "efg\n");
}

TEST(LineReader, lines_that_are_not_forgotten_are_read_again) {
  LineReader lines(100);
  push(lines, "a\nb\nc");
  EXPECT_EQ(next(lines), "a\n");
  lines.forget();
  EXPECT_EQ(next(lines), "b\n");
  EXPECT_EQ(lines.kept(), 2U);
  lines.rewind();
  EXPECT_EQ(next(lines), "b\n");
  EXPECT_EQ(lines.forget_all(), 3U);
  EXPECT_EQ(next(lines), "");
}

}  // namespace
}  // namespace dermis::bytes::layouts
