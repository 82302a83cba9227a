// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// What is particular to stag, tactileglove and wiresens; what holds for all protocols is in protocol_test.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "bytes/devices/decoding.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::bytes::devices {
namespace {

using Counts = std::vector<std::vector<float>>;

Counts random_counts(std::size_t frames, std::size_t taxels, std::uint64_t bound, std::uint64_t seed) {
  Random random(seed);
  Counts counts(frames, std::vector<float>(taxels));
  for (std::vector<float>& frame : counts) {
    for (float& count : frame) count = static_cast<float>(random.below(bound));
  }
  return counts;
}

void append(Bytes& bytes, const Bytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

// ---- stag, after the lines of TouchStreamer

void append_digits(Bytes& bytes, float value, int bit_shift) {
  const int count = static_cast<int>(value);
  bytes.push_back(static_cast<std::uint8_t>((count >> bit_shift) + 11));
  bytes.push_back(static_cast<std::uint8_t>(count % (1 << bit_shift) + 11));
}

Bytes stag_reply(int index, const std::vector<float>& counts, int bit_shift) {
  Bytes bytes = {static_cast<std::uint8_t>(index + 11)};
  for (const float count : counts) append_digits(bytes, count, bit_shift);
  bytes.push_back('\n');
  return bytes;
}

Bytes stag_rows(int index, const std::vector<float>& counts, std::size_t cols, int bit_shift) {
  Bytes bytes;
  for (std::size_t row = 0; row < counts.size() / cols; ++row) {
    append(bytes, {static_cast<std::uint8_t>(index + 11), static_cast<std::uint8_t>(row + 11)});
    for (std::size_t col = 0; col < cols; ++col) append_digits(bytes, counts[row * cols + col], bit_shift);
    bytes.push_back('\n');
  }
  return bytes;
}

TEST(Stag, reads_replies_and_streamed_rows) {
  for (const int bit_shift : {5, 6}) {
    const Counts frames = random_counts(300, 1024, 4096, 1);
    Bytes replies;
    Bytes rows;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      append(replies, stag_reply(static_cast<int>(i % 200), frames[i], bit_shift));
      append(rows, stag_rows(static_cast<int>(i % 2), frames[i], 32, bit_shift));
    }
    const auto asked = decoder_for({.name = "stag", .bit_shift = bit_shift});
    EXPECT_EQ(counts_of(push_all(*asked, replies)), frames);
    EXPECT_EQ(asked->request(), "a");
    EXPECT_EQ(asked->counts(), (DecoderCounts{.frames = 300}));
    const auto streaming = decoder_for({.name = "stag", .bit_shift = bit_shift});
    EXPECT_EQ(counts_of(push_all(*streaming, rows)), frames);
    EXPECT_EQ(streaming->request(), "");
    EXPECT_EQ(streaming->counts(), (DecoderCounts{.frames = 300}));
  }
}

TEST(Stag, counts_leaps_of_the_index_as_lost_and_drops_a_frame_that_repeats_it) {
  const Counts frames = random_counts(5, 6, 4096, 2);
  Bytes bytes;
  const std::vector<int> indices = {1, 2, 5, 5, 0};
  for (std::size_t i = 0; i < frames.size(); ++i) append(bytes, stag_rows(indices[i], frames[i], 3, 5));
  const auto decoder = decoder_for({.name = "stag", .shape = FrameShape{2, 3}});
  const std::vector<RawFrame> decoded = push_all(*decoder, bytes);
  EXPECT_EQ(counts_of(decoded), (Counts{frames[0], frames[1], frames[2], frames[4]}));
  EXPECT_EQ(decoded[2].acquisition.lost_before, 2U);
  EXPECT_EQ(decoder->counts().lost_frames, 2U);
  EXPECT_EQ(decoder->counts().damaged_frames, 1U);
}

TEST(Stag, delivers_no_frame_with_a_row_missing_or_of_another_frame) {
  const Counts frames = random_counts(3, 12, 4096, 3);
  const std::size_t line = 3 + 2 * 3;
  for (std::size_t row = 0; row < 4; ++row) {
    Bytes missing = stag_rows(2, frames[1], 3, 5);
    Bytes foreign = missing;
    const auto begin = static_cast<std::ptrdiff_t>(row * line);
    missing.erase(missing.begin() + begin, missing.begin() + begin + line);
    foreign[row * line] = 9 + 11;
    for (const Bytes& damaged : {missing, foreign}) {
      Bytes bytes = stag_rows(1, frames[0], 3, 5);
      append(bytes, damaged);
      append(bytes, stag_rows(3, frames[2], 3, 5));
      const auto decoder = decoder_for({.name = "stag", .shape = FrameShape{4, 3}});
      EXPECT_EQ(counts_of(push_all(*decoder, bytes)), (Counts{frames[0], frames[2]})) << row;
    }
  }
}

TEST(Stag, refuses_readings_that_the_other_bit_shift_would_give) {
  const Counts frames = random_counts(20, 1024, 4096, 4);
  Bytes bytes;
  for (std::size_t i = 0; i < frames.size(); ++i) append(bytes, stag_reply(static_cast<int>(i), frames[i], 6));
  const auto decoder = decoder_for({.name = "stag", .bit_shift = 5});
  EXPECT_TRUE(push_all(*decoder, bytes).empty());
  EXPECT_FALSE(make_decoder({.name = "stag", .bit_shift = 7}));
}

// ---- tactileglove

Bytes glove_frame(const std::vector<float>& counts) {
  Bytes bytes;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto count = static_cast<unsigned>(counts[i]);
    append(bytes, {static_cast<std::uint8_t>(0x3C + i), 0x01, static_cast<std::uint8_t>((i % 16) << 4 | count >> 8),
                   static_cast<std::uint8_t>(count), 0x00});
  }
  return bytes;
}

TEST(TactileGlove, learns_the_number_of_taxels) {
  for (const std::size_t taxels : {1U, 7U, 54U, 64U, 195U}) {
    const Counts frames = random_counts(5, taxels, 4096, taxels);
    Bytes bytes;
    for (const std::vector<float>& frame : frames) append(bytes, glove_frame(frame));
    const auto decoder = decoder_for({.name = "tactileglove"});
    EXPECT_EQ(counts_of(decode_all(*decoder, bytes)), frames) << taxels;
    EXPECT_EQ(decoder->shape(), (FrameShape{1, taxels}));
  }
}

TEST(TactileGlove, begins_with_the_first_whole_frame) {
  const Counts frames = random_counts(6, 54, 4096, 8);
  Bytes bytes;
  for (const std::vector<float>& frame : frames) append(bytes, glove_frame(frame));
  bytes.erase(bytes.begin(), bytes.begin() + 77);
  const auto decoder = decoder_for({.name = "tactileglove"});
  EXPECT_EQ(counts_of(decode_all(*decoder, bytes)), Counts(frames.begin() + 1, frames.end()));
}

TEST(TactileGlove, refuses_more_taxels_than_have_an_index) {
  EXPECT_FALSE(make_decoder({.name = "tactileglove", .shape = FrameShape{14, 15}}));
  EXPECT_TRUE(make_decoder({.name = "tactileglove", .shape = FrameShape{14, 14}}));
}

// ---- wiresens, after GenericReceiver.py::unpackBytesPacket

struct Device {
  std::size_t taxels = 256;
  std::size_t nodes = 120;
  bool delimited = true;

  /// All packets through `frames`, one behind the other; the last may reach beyond them with zeros.
  [[nodiscard]] std::vector<Bytes> packets(const Counts& frames) const {
    std::vector<float> readings;
    for (const std::vector<float>& frame : frames) readings.insert(readings.end(), frame.begin(), frame.end());
    std::vector<Bytes> all;
    for (std::size_t first = 0; first < readings.size(); first += nodes) {
      const std::size_t start = first % taxels;
      Bytes packet = {42, static_cast<std::uint8_t>(start), static_cast<std::uint8_t>(start >> 8U)};
      for (std::size_t i = first; i < first + nodes; ++i) {
        const int reading = i < readings.size() ? static_cast<int>(readings[i]) : 0;
        append(packet, {static_cast<std::uint8_t>(reading), static_cast<std::uint8_t>(reading >> 8)});
      }
      const std::size_t number = all.size() + first_number;
      for (unsigned shift = 0; shift < 32; shift += 8) packet.push_back(static_cast<std::uint8_t>(number >> shift));
      if (delimited) append(packet, {'w', 'r'});
      all.push_back(packet);
    }
    return all;
  }

  std::size_t first_number = 0;
};

Bytes join(const std::vector<Bytes>& packets, const std::vector<std::size_t>& without = {}) {
  Bytes bytes;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    if (std::find(without.begin(), without.end(), i) == without.end()) append(bytes, packets[i]);
  }
  return bytes;
}

TEST(WireSens, reads_packets_that_straddle_frames) {
  for (const bool delimited : {true, false}) {
    for (const FrameShape shape : {FrameShape{16, 16}, FrameShape{32, 32}, FrameShape{6, 10}, FrameShape{8, 15}}) {
      const Device device = {.taxels = shape.taxel_count(),
                             .nodes = std::min<std::size_t>(120, shape.taxel_count()),
                             .delimited = delimited};
      const Counts frames = random_counts(20, shape.taxel_count(), 4096, 9);
      const auto decoder = decoder_for({.name = "wiresens", .shape = shape, .delimited = delimited});
      const std::vector<RawFrame> decoded = push_all(*decoder, join(device.packets(frames)));
      EXPECT_EQ(counts_of(decoded), frames);
      for (std::size_t i = 0; i < decoded.size(); ++i) EXPECT_EQ(decoded[i].acquisition.sequence, i);
      EXPECT_EQ(decoder->counts(), (DecoderCounts{.frames = 20}));
    }
  }
}

TEST(WireSens, holds_the_last_reading_of_taxels_that_were_not_sent) {
  const Device device;
  const Counts frames = random_counts(10, 256, 4096, 10);
  // Packet 5 holds readings 88 ... 207 of frame 2.
  const auto decoder = decoder_for({.name = "wiresens", .shape = FrameShape{16, 16}});
  const std::vector<RawFrame> decoded = push_all(*decoder, join(device.packets(frames), {5}));
  ASSERT_EQ(decoded.size(), 10U);
  for (std::size_t i = 0; i < 10; ++i) {
    Counts expected = frames;
    if (i == 2) std::copy_n(frames[1].begin() + 88, 120, expected[2].begin() + 88);
    EXPECT_EQ(decoded[i].counts, expected[i]) << i;
    EXPECT_EQ(decoded[i].acquisition.held_taxels, i == 2 ? 120U : 0U);
  }
  EXPECT_EQ(decoder->counts().lost_frames, 0U);
}

TEST(WireSens, delivers_a_frame_whose_last_packet_was_not_sent_with_the_next_packet) {
  const Device device;
  const Counts frames = random_counts(10, 256, 4096, 11);
  // Packet 2 holds the last 16 readings of frame 0 and the first 104 of frame 1.
  const auto decoder = decoder_for({.name = "wiresens", .shape = FrameShape{16, 16}});
  const std::vector<RawFrame> decoded = push_all(*decoder, join(device.packets(frames), {2}));
  ASSERT_EQ(decoded.size(), 10U);
  EXPECT_EQ(decoded[0].acquisition.held_taxels, 16U);
  EXPECT_TRUE(std::isnan(decoded[0].counts[255]));  // never received: there is nothing to hold
  EXPECT_EQ(decoded[1].acquisition.held_taxels, 104U);
  EXPECT_EQ(decoded[1].counts[103], frames[0][103]);
  EXPECT_EQ(decoded[2].counts, frames[2]);
}

TEST(WireSens, counts_frames_of_which_no_packet_came_as_lost) {
  const Device device = {.taxels = 60, .nodes = 60};
  const Counts frames = random_counts(10, 60, 4096, 12);
  const auto decoder = decoder_for({.name = "wiresens", .shape = FrameShape{6, 10}});
  const std::vector<RawFrame> decoded = push_all(*decoder, join(device.packets(frames), {4, 5, 6}));
  ASSERT_EQ(decoded.size(), 7U);
  EXPECT_EQ(decoded[4].acquisition.lost_before, 3U);
  EXPECT_EQ(decoded[4].acquisition.sequence, 7U);
  EXPECT_EQ(decoder->counts().lost_frames, 3U);
}

TEST(WireSens, drops_frames_of_which_a_packet_was_damaged) {
  for (const bool delimited : {true, false}) {
    const Device device = {.delimited = delimited};
    const Counts frames = random_counts(10, 256, 4096, 13);
    std::vector<Bytes> packets = device.packets(frames);
    packets[5].erase(packets[5].begin() + 100);
    const auto decoder = decoder_for({.name = "wiresens", .shape = FrameShape{16, 16}, .delimited = delimited});
    Counts expected = frames;
    expected.erase(expected.begin() + 2);
    EXPECT_EQ(counts_of(push_all(*decoder, join(packets))), expected);
    EXPECT_EQ(decoder->counts().damaged_frames, 1U);
    EXPECT_EQ(decoder->counts().lost_frames, 0U);
  }
}

TEST(WireSens, goes_on_after_a_restart_of_the_device_and_where_the_number_wraps) {
  const Device device;
  const Counts frames = random_counts(5, 256, 4096, 14);
  const std::vector<Bytes> packets = device.packets(frames);
  Bytes bytes = join({packets.begin(), packets.begin() + 7});  // stops in frame 3
  append(bytes, join(packets));
  const auto decoder = decoder_for({.name = "wiresens", .shape = FrameShape{16, 16}});
  Counts expected(frames.begin(), frames.begin() + 3);
  expected.insert(expected.end(), frames.begin(), frames.end());
  EXPECT_EQ(counts_of(push_all(*decoder, bytes)), expected);

  Device old = {.taxels = 120};
  old.first_number = 0xFFFFFFFD;
  const Counts six = random_counts(6, 120, 4096, 15);
  const auto wrapping = decoder_for({.name = "wiresens", .shape = FrameShape{10, 12}});
  const std::vector<RawFrame> decoded = push_all(*wrapping, join(old.packets(six)));
  EXPECT_EQ(counts_of(decoded), six);
  EXPECT_EQ(decoded.back().acquisition.sequence, 0x100000002U);
}

TEST(WireSens, reads_single_nodes) {
  const auto decoder = decoder_for({.name = "wiresens", .shape = FrameShape{2, 3}, .nodes_per_packet = 4});
  Bytes bytes;
  for (std::uint8_t number = 0; number < 3; ++number) {
    append(bytes, {1, 0x20, 0x4E, 1, 0, 100, number, 4, 0, 200, number, number, 0, 0, 0, 'w', 'r'});
  }
  const std::vector<RawFrame> decoded = push_all(*decoder, bytes);
  ASSERT_EQ(decoded.size(), 3U);
  EXPECT_EQ(decoded[2].counts[1], 100 + 2 * 256);
  EXPECT_EQ(decoded[2].counts[4], 200 + 2 * 256);
  EXPECT_TRUE(std::isnan(decoded[2].counts[0]));
  EXPECT_EQ(decoded[2].acquisition.held_taxels, 4U);
}

TEST(WireSens, needs_a_shape) {
  const Result<std::unique_ptr<Decoder>> decoder = make_decoder({.name = "wiresens"});
  ASSERT_FALSE(decoder);
  EXPECT_NE(decoder.error().message.find("give rows and cols"), std::string::npos);
  EXPECT_FALSE(make_decoder({.name = "wiresens", .shape = FrameShape{16, 16}, .nodes_per_packet = 0}));
  EXPECT_FALSE(make_decoder({.name = "wiresens", .shape = FrameShape{512, 512}}));
}

}  // namespace
}  // namespace dermis::bytes::devices
