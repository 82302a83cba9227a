// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/ros_messages/cdr.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace dermis::bytes::ros_messages {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(Cdr, numbers_stand_at_multiples_of_their_size_behind_the_header) {
  Bytes bytes;
  CdrWriter writer(bytes);
  writer.write(std::uint8_t{1});
  writer.write(std::uint16_t{0x0302});
  writer.write(std::uint8_t{4});
  writer.write(std::uint32_t{5});
  writer.write(std::int8_t{-1});
  writer.write(1.0);
  const Bytes expected{0,    1, 0, 0,                     // header
                       1,    0, 2, 3,                     // u8, gap, u16
                       4,    0, 0, 0, 5, 0, 0,    0,      // u8, gap, u32
                       0xFF, 0, 0, 0,                     // i8, gap
                       0,    0, 0, 0, 0, 0, 0xF0, 0x3F};  // double at 16 of the fields
  EXPECT_EQ(bytes, expected);
}

TEST(Cdr, texts_and_sequences_begin_with_their_length) {
  Bytes bytes;
  CdrWriter writer(bytes);
  writer.write_text("ab");
  const std::span<std::uint8_t> place = writer.write_bytes(3);
  std::fill(place.begin(), place.end(), std::uint8_t{7});
  const Bytes expected{0, 1, 0, 0, 3, 0, 0, 0, 'a', 'b', 0, 0, 3, 0, 0, 0, 7, 7, 7};
  EXPECT_EQ(bytes, expected);
}

TEST(Cdr, what_is_written_reads_back) {
  Bytes bytes{9, 9, 9};
  CdrWriter writer(bytes);
  writer.write(std::uint8_t{200});
  writer.write(std::numeric_limits<std::int64_t>::min());
  writer.write_text("");
  writer.write(-0.0F);
  writer.write_text("array");
  writer.write(std::uint16_t{65535});
  static_cast<void>(writer.write_bytes(0));
  CdrReader reader(bytes);
  EXPECT_EQ(reader.read<std::uint8_t>(), 200);
  EXPECT_EQ(reader.read<std::int64_t>(), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(reader.read_text(), "");
  EXPECT_TRUE(std::signbit(reader.read<float>()));
  EXPECT_EQ(reader.read_text(), "array");
  EXPECT_EQ(reader.read<std::uint16_t>(), 65535);
  EXPECT_TRUE(reader.read_bytes().empty());
  EXPECT_TRUE(reader.good());
  EXPECT_EQ(reader.read<std::uint8_t>(), 0);
  EXPECT_FALSE(reader.good());
}

TEST(Cdr, every_cut_message_is_seen_and_reads_as_nothing) {
  Bytes bytes;
  CdrWriter writer(bytes);
  writer.write(std::uint64_t{1});
  writer.write_text("text");
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    SCOPED_TRACE(size);
    const std::span<const std::uint8_t> cut(bytes.data(), size);
    CdrReader reader(cut);
    static_cast<void>(reader.read<std::uint64_t>());
    EXPECT_EQ(reader.read_text(), "");
    EXPECT_FALSE(reader.good());
    EXPECT_EQ(reader.read<std::uint32_t>(), 0U);
  }
}

TEST(Cdr, other_representations_are_refused) {
  for (const std::uint8_t kind : Bytes{0, 2, 3, 7}) {  // big-endian, parameter lists, XCDR 2
    const Bytes bytes{0, kind, 0, 0, 1, 0, 0, 0};
    CdrReader reader(bytes);
    EXPECT_EQ(reader.read<std::uint32_t>(), 0U);
    EXPECT_FALSE(reader.good());
  }
}

TEST(Cdr, a_length_beyond_the_message_is_refused) {
  const Bytes bytes{0, 1, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 1, 2, 3, 4};
  CdrReader reader(bytes);
  EXPECT_TRUE(reader.read_bytes().empty());
  EXPECT_FALSE(reader.good());
}

}  // namespace
}  // namespace dermis::bytes::ros_messages
