// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/terminal_picture.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace dermis::out::report {
namespace {

/// 2 x 3 taxels.
TerminalPicture picture() {
  TerminalPicture picture;
  picture.name = "chest";
  picture.unit = "N";
  picture.shape = {2, 3};
  picture.values = {0.0, 1.0, 2.0, 5.0, 10.0, std::numeric_limits<double>::quiet_NaN()};
  picture.high = 10.0;
  picture.statistics.rate_hz = 99.96;
  picture.statistics.lost_frames = 4;
  picture.statistics.damaged_frames = 1;
  return picture;
}

/// Without the codes that colour and clear.
std::vector<std::string> lines_of(const std::string& screen) {
  std::vector<std::string> lines{""};
  for (std::size_t k = 0; k < screen.size(); ++k) {
    if (screen[k] == '\x1b') {
      while (screen[k] != 'm' && screen[k] != 'K') ++k;
    } else if (screen[k] == '\r') {
      lines.emplace_back();
      ++k;
    } else {
      lines.back() += screen[k];
    }
  }
  return lines;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

TEST(TerminalPicture, letters_stand_for_colours_where_there_are_none) {
  const auto lines = lines_of(terminal_screen(picture(), {4, 60}, TerminalColours::without));
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0], "chest  2x3  100.0 frames/s  4 lost  1 damaged");
  EXPECT_EQ(lines[1], "0  ..:::--==++**###%%@ 10 N");
  EXPECT_EQ(lines[2], "  ..::");  // each taxel is two columns wide
  EXPECT_EQ(lines[3], "++@@??");  // no value: a question mark
}

TEST(TerminalPicture, a_source_that_has_ended_is_said_to_have) {
  TerminalPicture ended = picture();
  ended.has_ended = true;
  EXPECT_TRUE(lines_of(terminal_screen(ended, {4, 60}, TerminalColours::without))[0].ends_with("damaged  ended"));
}

TEST(TerminalPicture, taxels_are_squares_of_half_blocks_that_fill_the_screen) {
  const std::string screen = terminal_screen(picture(), {6, 40}, TerminalColours::rgb);
  EXPECT_EQ(lines_of(screen).size(), 6U);
  // 8 pixels high, so 4 pixels a taxel: 4 lines of 12 blocks, and 20 of the scale
  EXPECT_EQ(count_of(screen, "\u2580"), 4U * 12U + 20U);
  EXPECT_GT(count_of(screen, "\x1b[38;2;"), 0U);
  EXPECT_EQ(count_of(screen, "\x1b[38;5;"), 0U);
  EXPECT_GT(count_of(terminal_screen(picture(), {6, 40}, TerminalColours::cube), "\x1b[38;5;"), 0U);
}

TEST(TerminalPicture, where_taxels_do_not_fit_the_largest_of_the_neighbours_is_shown) {
  TerminalPicture wide = picture();
  wide.shape = {4, 8};
  wide.values.assign(32, 0.0);
  wide.values[9] = 10.0;
  const auto lines = lines_of(terminal_screen(wide, {4, 30}, TerminalColours::without));
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[2], "@@      ");
  EXPECT_EQ(lines[3], "        ");
}

TEST(TerminalPicture, contacts_stand_beside_the_taxels_where_there_is_room) {
  TerminalPicture touched = picture();
  touched.has_contacts = true;
  touched.report.total_force_n = 12.5;
  Contact contact;
  contact.id = 7;
  contact.force_n = 12.5;
  contact.position = {0.0123, 0.0456};
  contact.phase = ContactPhase::held;
  touched.report.contacts = {contact, contact};
  touched.report.contacts[1].phase = ContactPhase::release;
  const std::string wide = terminal_screen(touched, {6, 60}, TerminalColours::without);
  EXPECT_EQ(count_of(wide, "total   12.50 N"), 1U);
  EXPECT_EQ(count_of(wide, "#7      12.50 N    12.3   45.6 mm"), 1U);  // what was released is not shown
  const std::string narrow = terminal_screen(touched, {6, 38}, TerminalColours::without);
  EXPECT_EQ(count_of(narrow, "total"), 0U);
}

TEST(TerminalPicture, no_line_is_wider_than_the_terminal) {
  TerminalPicture named = picture();
  named.name = std::string(100, 'x');
  for (const std::size_t columns : {3U, 10U, 25U, 79U}) {
    for (const std::string& line : lines_of(terminal_screen(named, {5, columns}, TerminalColours::without))) {
      EXPECT_LE(line.size(), columns);
    }
  }
}

}  // namespace
}  // namespace dermis::out::report
