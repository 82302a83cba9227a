// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/one_line.hpp"

#include <gtest/gtest.h>

namespace dermis {
namespace {

TEST(OneLine, leaves_letters_of_all_languages) {
  EXPECT_EQ(one_line("chest, Rücken, 胸"), "chest, Rücken, 胸");
}

TEST(OneLine, has_nothing_that_controls_a_terminal) {
  EXPECT_EQ(one_line("a\x1b[2Jb\nc\x7f"), "a?[2Jb?c?");
  EXPECT_EQ(one_line("a\xc2\x9b"
                     "2J"),
            "a??2J");
}

}  // namespace
}  // namespace dermis
