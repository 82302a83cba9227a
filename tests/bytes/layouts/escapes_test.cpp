// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/layouts/escapes.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace dermis::bytes::layouts {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Escape = PacketLayout::Escape;

TEST(Escapes, are_undone_as_their_standards_say) {
  const PacketLayout cobs{{}, Escape::cobs};
  const PacketLayout slip{{}, Escape::slip};
  const PacketLayout stuffed{{}, Escape::stuffed, 0x7E, 0x7D, 0x20};
  Bytes plain;
  EXPECT_TRUE(undo_escapes(cobs, Bytes{3, 0x11, 0x22, 2, 0x33}, plain));
  EXPECT_EQ(plain, (Bytes{0x11, 0x22, 0, 0x33}));
  EXPECT_TRUE(undo_escapes(slip, Bytes{1, 0xDB, 0xDC, 0xDB, 0xDD}, plain));
  EXPECT_EQ(plain, (Bytes{1, 0xC0, 0xDB}));
  EXPECT_TRUE(undo_escapes(stuffed, Bytes{0x7D, 0x5E, 0x7D, 0x5D, 4}, plain));
  EXPECT_EQ(plain, (Bytes{0x7E, 0x7D, 4}));
  EXPECT_EQ(delimiter_of(cobs), 0);
  EXPECT_EQ(delimiter_of(slip), 0xC0);
  EXPECT_EQ(delimiter_of(stuffed), 0x7E);
}

TEST(Escapes, that_cannot_be_are_refused) {
  Bytes plain;
  EXPECT_FALSE(undo_escapes({{}, Escape::cobs}, Bytes{5, 1}, plain));
  EXPECT_FALSE(undo_escapes({{}, Escape::slip}, Bytes{1, 0xDB}, plain));
  EXPECT_FALSE(undo_escapes({{}, Escape::slip}, Bytes{0xDB, 1}, plain));
  EXPECT_FALSE(undo_escapes({{}, Escape::stuffed, 0x7E, 0x7D, 0x20}, Bytes{0x7D}, plain));
}

}  // namespace
}  // namespace dermis::bytes::layouts
