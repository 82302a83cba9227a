// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// What is particular to dermis, flexitac, m1616, pressure-mat and wuji; protocol_test.cpp holds what all must do.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "dermis/bytes/devices/protocol.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis_wire.h"
#include "support/places.hpp"

namespace dermis::bytes::devices {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::unique_ptr<Decoder> decoder_of(const std::string& name, std::optional<FrameShape> shape = {}) {
  return std::move(make_decoder({.name = name, .shape = shape})).value();
}

std::unique_ptr<Encoder> encoder_of(const std::string& name, FrameShape shape) {
  return std::move(make_encoder({.name = name, .shape = shape})).value();
}

/// Frames of bytes that end there, if `ended`.
std::vector<RawFrame> decode(Decoder& decoder, std::span<const std::uint8_t> bytes, bool ended = true) {
  std::vector<RawFrame> frames;
  RawFrame frame;
  while (!bytes.empty()) {
    const std::size_t size = std::min(bytes.size(), Decoder::kMaxPush);
    decoder.push(bytes.first(size));
    bytes = bytes.subspan(size);
    while (decoder.next(frame)) frames.push_back(frame);
  }
  if (ended) decoder.finish();
  while (decoder.next(frame)) frames.push_back(frame);
  return frames;
}

RawFrame frame_of(std::vector<float> counts) {
  RawFrame frame;
  frame.counts = std::move(counts);
  return frame;
}

RawFrame random_frame(std::size_t taxels, std::uint64_t max_count, Random& random) {
  std::vector<float> counts(taxels);
  for (float& count : counts) count = static_cast<float>(random.below(max_count + 1));
  return frame_of(counts);
}

/// The bytes of docs/wire-protocol.md.
const Bytes kDocumentedFrame = {0x04, 0x01, 0x07, 0x05, 0x01, 0x01, 0x03, 0xA8, 0x61, 0x01, 0x06,
                                0x2E, 0x09, 0xE4, 0x0C, 0x02, 0x02, 0x02, 0x01, 0x01, 0x02, 0x0A,
                                0x09, 0x2C, 0x01, 0xFF, 0x03, 0xAB, 0xB4, 0x13, 0x5B, 0x00};

RawFrame documented_frame() {
  RawFrame frame = frame_of({0, 10, 300, 1023});
  frame.temperature_celsius = 23.5;
  frame.supply_v = 3.3;
  frame.acquisition.sequence = 5;
  frame.acquisition.device_time = std::chrono::milliseconds(25);
  return frame;
}

TEST(DermisWire, reads_the_documented_frame) {
  const auto decoder = decoder_of("dermis");
  EXPECT_FALSE(decoder->shape());
  const std::vector<RawFrame> frames = decode(*decoder, kDocumentedFrame);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(decoder->shape(), (FrameShape{2, 2}));
  EXPECT_EQ(frames[0].counts, documented_frame().counts);
  EXPECT_DOUBLE_EQ(frames[0].temperature_celsius.value_or(0), 23.5);
  EXPECT_DOUBLE_EQ(frames[0].supply_v.value_or(0), 3.3);
  EXPECT_EQ(frames[0].acquisition, documented_frame().acquisition);
}

TEST(DermisWire, writes_the_documented_frame) {
  Bytes bytes;
  encoder_of("dermis", {2, 2})->encode(documented_frame(), bytes);
  EXPECT_EQ(bytes, kDocumentedFrame);
}

TEST(DermisWire, leaves_empty_what_the_device_does_not_measure) {
  const auto encoder = encoder_of("dermis", {1, 2});
  Bytes bytes;
  encoder->encode(documented_frame(), bytes);
  bytes.clear();
  encoder->encode(frame_of({1, 2}), bytes);
  RawFrame frame = documented_frame();
  const auto decoder = decoder_of("dermis", FrameShape{1, 2});
  decoder->push(bytes);
  ASSERT_TRUE(decoder->next(frame));
  EXPECT_FALSE(frame.temperature_celsius);
  EXPECT_FALSE(frame.supply_v);
  EXPECT_FALSE(frame.acquisition.device_time);
}

/// Numbers and times [us] that the device sends -> what the decoder makes of them.
std::vector<RawFrame> decode_numbers(const std::vector<std::pair<std::uint64_t, std::int64_t>>& sent,
                                     Decoder& decoder) {
  const auto encoder = encoder_of("dermis", {1, 1});
  Bytes bytes;
  for (const auto& [sequence, microseconds] : sent) {
    RawFrame frame = frame_of({1});
    frame.acquisition.sequence = sequence;
    frame.acquisition.device_time = std::chrono::microseconds(microseconds);
    encoder->encode(frame, bytes);
  }
  return decode(decoder, bytes);
}

TEST(DermisWire, counts_numbers_and_time_on_where_they_wrap) {
  const std::uint64_t wrap = std::uint64_t{1} << 32U;
  const auto decoder = decoder_of("dermis");
  const auto frames = decode_numbers(
      {{wrap - 2, 4294900000}, {wrap - 1, 4294950000}, {wrap + 3, 4295150000}, {wrap + 4, 4295200000}}, *decoder);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames[2].acquisition.sequence, wrap + 3);
  EXPECT_EQ(frames[2].acquisition.device_time, std::chrono::microseconds(4295150000));
  EXPECT_EQ(frames[2].acquisition.lost_before, 3U);
  EXPECT_EQ(frames[3].acquisition.sequence, wrap + 4);
  EXPECT_EQ(frames[3].acquisition.lost_before, 0U);
  EXPECT_EQ(decoder->counts().lost_frames, 3U);
}

TEST(DermisWire, takes_a_step_back_for_a_restart) {
  const auto decoder = decoder_of("dermis");
  const auto frames = decode_numbers({{5000, 9000000}, {5001, 9005000}, {0, 1000}, {2, 11000}}, *decoder);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames[2].acquisition.sequence, 0U);
  EXPECT_EQ(frames[2].acquisition.device_time, std::chrono::microseconds(1000));
  EXPECT_EQ(frames[3].acquisition.lost_before, 1U);
  EXPECT_EQ(decoder->counts().lost_frames, 1U);
}

TEST(DermisWire, knows_a_restart_with_a_higher_number_by_the_clock) {
  const auto decoder = decoder_of("dermis");
  const auto frames = decode_numbers({{5, 9000000}, {900, 1000}}, *decoder);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].acquisition.device_time, std::chrono::microseconds(1000));
  EXPECT_EQ(decoder->counts().lost_frames, 0U);
}

TEST(DermisWire, a_jump_beyond_a_million_is_no_loss) {
  const auto decoder = decoder_of("dermis");
  (void)decode_numbers({{1, 0}, {1000002, 10}, {2000004, 20}}, *decoder);
  EXPECT_EQ(decoder->counts().lost_frames, 1000000U);
}

TEST(DermisWire, counts_what_was_lost_while_the_cable_was_out) {
  const auto decoder = decoder_of("dermis");
  (void)decode_numbers({{1, 0}, {2, 5000}}, *decoder);
  (void)decode_numbers({{10, 50000}}, *decoder);
  EXPECT_EQ(decoder->counts().lost_frames, 7U);
}

std::vector<std::uint64_t> sequences_of(const std::vector<RawFrame>& frames) {
  std::vector<std::uint64_t> sequences;
  for (const RawFrame& frame : frames) sequences.push_back(frame.acquisition.sequence.value_or(0));
  return sequences;
}

TEST(DermisWire, drops_datagrams_that_come_late_or_twice) {
  const auto decoder = make_decoder({.name = "dermis", .datagrams = true}).value();
  const auto frames = decode_numbers({{70, 7000},
                                      {71, 7100},
                                      {71, 7100},  // twice
                                      {73, 7300},
                                      {72, 7200},  // late
                                      {11, 1100},
                                      {74, 7400},
                                      {10, 1000},  // 64 back: a restart
                                      {11, 1100},
                                      {11, 1200}},  // a device that does not count
                                     *decoder);
  EXPECT_EQ(sequences_of(frames), (std::vector<std::uint64_t>{70, 71, 73, 74, 10, 11, 11}));
  const DecoderCounts& counts = decoder->counts();
  EXPECT_EQ(counts.lost_frames, 1U) << "72";
  EXPECT_EQ(counts.damaged_frames, 0U);
  EXPECT_GT(counts.skipped_bytes, 3 * 20U);
}

TEST(DermisWire, drops_datagrams_that_come_late_where_numbers_wrap) {
  const std::uint64_t wrap = std::uint64_t{1} << 32U;
  const auto decoder = make_decoder({.name = "dermis", .datagrams = true}).value();
  const auto frames = decode_numbers(
      {{wrap - 1, 4294967290}, {wrap, 4294967300}, {wrap - 1, 4294967290}, {wrap + 1, 4294967400}}, *decoder);
  EXPECT_EQ(sequences_of(frames), (std::vector<std::uint64_t>{wrap - 1, wrap, wrap + 1}));
}

TEST(DermisWire, drops_other_versions_flags_and_shapes) {
  // The CRC of each is right: made by the encoder of another shape, or by hand from a packet without zeros.
  const auto decoder = decoder_of("dermis", FrameShape{2, 2});
  Bytes bytes = kDocumentedFrame;
  encoder_of("dermis", {2, 3})->encode(frame_of({1, 2, 3, 4, 5, 6}), bytes);
  encoder_of("dermis", {4, 1})->encode(frame_of({1, 2, 3, 4}), bytes);
  EXPECT_EQ(decode(*decoder, bytes).size(), 1U);
  EXPECT_EQ(decoder->counts().damaged_frames, 2U);
}

TEST(DermisWire, bounds_what_it_keeps_of_endless_bytes) {
  const auto decoder = decoder_of("dermis", FrameShape{2, 2});
  const Bytes endless(Decoder::kMaxPush, 0x55);
  for (int k = 0; k < 4; ++k) EXPECT_TRUE(decode(*decoder, endless, false).empty());
  EXPECT_EQ(decoder->counts().skipped_bytes, 4 * endless.size());
  EXPECT_TRUE(decode(*decoder, Bytes{0}, false).empty());
  EXPECT_EQ(decode(*decoder, kDocumentedFrame).size(), 1U);
}

TEST(DermisWire, carries_packets_of_every_pattern_of_zeros) {
  Random random(1);
  for (const std::size_t taxels : {1U, 100U, 116U, 117U, 118U, 243U, 244U, 245U, 1000U}) {
    for (const double share_of_zeros : {0.0, 0.002, 0.1, 0.5, 1.0}) {
      RawFrame frame = frame_of(std::vector<float>(taxels));
      for (float& count : frame.counts) count = random.uniform() < share_of_zeros ? 0.0F : 257.0F;
      Bytes bytes;
      encoder_of("dermis", {1, taxels})->encode(frame, bytes);
      const auto frames = decode(*decoder_of("dermis"), bytes);
      ASSERT_EQ(frames.size(), 1U) << taxels << " " << share_of_zeros;
      EXPECT_EQ(frames[0].counts, frame.counts);
    }
  }
}

void append_byte(std::uint8_t byte, void* bytes) {
  static_cast<Bytes*>(bytes)->push_back(byte);
}

TEST(Firmware, sends_what_the_library_sends) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const FrameShape shape = {1 + random.below(20), 1 + random.below(20)};
    RawFrame frame = random_frame(shape.taxel_count(), seed % 2 == 0 ? 3 : 65535, random);
    dermis_wire_header header = {};
    header.rows = static_cast<std::uint16_t>(shape.rows);
    header.cols = static_cast<std::uint16_t>(shape.cols);
    frame.acquisition.sequence = header.sequence = static_cast<std::uint32_t>(random.bits());
    header.time_us = static_cast<std::uint32_t>(random.bits());
    header.has_time = random.below(2) == 0;
    if (header.has_time) frame.acquisition.device_time = std::chrono::microseconds(header.time_us);
    header.temperature_centi_celsius = static_cast<std::int16_t>(random.below(10000)) - 5000;
    header.has_temperature = random.below(2) == 0;
    if (header.has_temperature) frame.temperature_celsius = header.temperature_centi_celsius / 100.0;
    header.supply_mv = static_cast<std::uint16_t>(1 + random.below(65535));
    header.has_supply = random.below(2) == 0;
    if (header.has_supply) frame.supply_v = header.supply_mv / 1000.0;

    Bytes of_firmware;
    dermis_wire wire = {};
    wire.put_byte = append_byte;
    wire.context = &of_firmware;
    dermis_wire_begin(&wire, &header);
    for (const float count : frame.counts) dermis_wire_reading(&wire, static_cast<std::uint16_t>(count));
    dermis_wire_end(&wire);
    Bytes of_library;
    encoder_of("dermis", shape)->encode(frame, of_library);
    ASSERT_EQ(of_firmware, of_library);
  }
}

TEST(Firmware, the_example_sends_frames) {
  const std::string program = "'" + support::firmware_example().string() + "'";
  std::FILE* output = popen(program.c_str(), "r");  // NOLINT(cert-env33-c): the path is of the build
  ASSERT_NE(output, nullptr);
  Bytes bytes(100000);
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), output));
  ASSERT_EQ(pclose(output), 0);
  const auto decoder = decoder_of("dermis");
  const auto frames = decode(*decoder, bytes);
  ASSERT_EQ(frames.size(), 100U);
  EXPECT_EQ(decoder->shape(), (FrameShape{4, 6}));
  EXPECT_EQ(decoder->counts(), (DecoderCounts{.frames = 100, .skipped_bytes = 1}));  // the zero of power-up
  EXPECT_EQ(frames[9].counts[2], 900.0F);
  EXPECT_EQ(frames[9].counts[3], 3.0F);
  EXPECT_EQ(frames[9].acquisition.device_time, std::chrono::milliseconds(45));
  EXPECT_DOUBLE_EQ(frames[9].temperature_celsius.value_or(0), 23.5);
  EXPECT_DOUBLE_EQ(frames[9].supply_v.value_or(0), 3.3);
}

Bytes flexitac_bytes(FrameShape shape, const std::vector<RawFrame>& frames) {
  Bytes bytes;
  const auto encoder = encoder_of("flexitac", shape);
  for (const RawFrame& frame : frames) encoder->encode(frame, bytes);
  return bytes;
}

std::vector<RawFrame> random_frames(std::size_t frame_count, FrameShape shape, Random& random) {
  std::vector<RawFrame> frames;
  for (std::size_t k = 0; k < frame_count; ++k) frames.push_back(random_frame(shape.taxel_count(), 255, random));
  return frames;
}

void expect_counts(const std::vector<RawFrame>& frames, const std::vector<RawFrame>& expected) {
  ASSERT_EQ(frames.size(), expected.size());
  for (std::size_t k = 0; k < frames.size(); ++k) ASSERT_EQ(frames[k].counts, expected[k].counts) << "frame " << k;
}

TEST(Flexitac, finds_the_size_of_arrays_that_are_built) {
  for (const FrameShape shape : {FrameShape{12, 32}, FrameShape{16, 16}, FrameShape{16, 32}, FrameShape{32, 32}}) {
    Random random(shape.taxel_count());
    const auto frames = random_frames(20, shape, random);
    const auto decoder = decoder_of("flexitac");
    expect_counts(decode(*decoder, flexitac_bytes(shape, frames)), frames);
    EXPECT_EQ(decoder->shape(), shape);
  }
}

TEST(Flexitac, begins_in_the_middle_of_a_frame) {
  Random random(2);
  const auto frames = random_frames(20, {16, 16}, random);
  const Bytes bytes = flexitac_bytes({16, 16}, frames);
  for (const std::size_t begin : {1U, 2U, 100U, 257U}) {
    const auto decoder = decoder_of("flexitac");
    expect_counts(decode(*decoder, std::span(bytes).subspan(begin)), {frames.begin() + 1, frames.end()});
    EXPECT_EQ(decoder->counts().skipped_bytes, 258 - begin);
  }
}

TEST(Flexitac, has_no_shape_for_a_size_that_is_not_known) {
  Random random(3);
  const auto decoder = decoder_of("flexitac");
  EXPECT_TRUE(decode(*decoder, flexitac_bytes({8, 10}, random_frames(500, {8, 10}, random))).empty());
  EXPECT_FALSE(decoder->shape());
  // Twice the size of half a known one: headers stand where those of 16x32 would.
  EXPECT_TRUE(decode(*decoder, flexitac_bytes({5, 51}, random_frames(500, {5, 51}, random))).empty());
}

/// Readings that look like a header, in all frames at `offset`.
void imitate_header(std::vector<RawFrame>& frames, std::size_t offset) {
  for (RawFrame& frame : frames) {
    frame.counts[offset] = 0xAA;
    frame.counts[offset + 1] = 0x55;
  }
}

TEST(Flexitac, never_takes_readings_for_a_header) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    for (const bool is_given : {false, true}) {
      auto frames = random_frames(60, {16, 16}, random);
      imitate_header(frames, random.below(255));
      frames[30].counts = frames[29].counts;
      for (std::size_t k = 40; k < 60; ++k) frames[k].counts.assign(256, 7.0F);  // the readings change at last
      const auto decoder = decoder_of("flexitac", is_given ? std::optional(FrameShape{16, 16}) : std::nullopt);
      const auto decoded =
          decode(*decoder, std::span<const std::uint8_t>(flexitac_bytes({16, 16}, frames)).subspan(99));
      ASSERT_GE(decoded.size(), 20U);
      ASSERT_LE(decoded.size(), 59U);
      expect_counts(decoded, {frames.end() - static_cast<std::ptrdiff_t>(decoded.size()), frames.end()});
    }
  }
}

TEST(Flexitac, keeps_its_place_beside_readings_that_stand_still) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    auto frames = random_frames(60, {16, 16}, random);
    std::vector<RawFrame> still(frames.begin() + 10, frames.end());
    imitate_header(still, 5 + random.below(120));
    std::copy(still.begin(), still.end(), frames.begin() + 10);
    Bytes bytes = flexitac_bytes({16, 16}, frames);
    const auto damage = bytes.begin() + static_cast<std::ptrdiff_t>(30 * std::size_t{258} + 2 + random.below(250));
    random.below(2) == 0 ? bytes.erase(damage) : bytes.insert(damage, 1);
    const auto decoded = decode(*decoder_of("flexitac", FrameShape{16, 16}), bytes);
    // Where they stand in the middle of the frame, a second frame is needed to tell them from the header.
    const std::size_t lost = 60 - decoded.size();
    ASSERT_GE(lost, 1U);
    ASSERT_LE(lost, 2U);
    frames.erase(frames.begin() + 30, frames.begin() + 30 + static_cast<std::ptrdiff_t>(lost));
    expect_counts(decoded, frames);
  }
}

TEST(Flexitac, delivers_nothing_while_nothing_tells_the_header) {
  auto frames = std::vector<RawFrame>(200, frame_of(std::vector<float>(256, 20.0F)));
  imitate_header(frames, 77);
  const auto decoder = decoder_of("flexitac", FrameShape{16, 16});
  EXPECT_TRUE(decode(*decoder, std::span<const std::uint8_t>(flexitac_bytes({16, 16}, frames)).subspan(50)).empty());
}

TEST(Flexitac, stays_in_step_when_readings_begin_to_look_like_a_header) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    // Two readings stand still at AA 55 from the tenth frame on.
    std::vector<RawFrame> frames = random_frames(60, {16, 16}, random);
    std::vector<RawFrame> later(frames.begin() + 10, frames.end());
    imitate_header(later, random.below(255));
    std::copy(later.begin(), later.end(), frames.begin() + 10);
    Bytes bytes = flexitac_bytes({16, 16}, frames);
    const std::size_t damaged = 20;
    const std::size_t at = damaged * 258 + random.below(258);
    const std::size_t dropped = 1 + random.below(100);
    const std::size_t last_damaged = (at + dropped - 1) / 258;
    bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                bytes.begin() + static_cast<std::ptrdiff_t>(at + dropped));
    const auto decoder = decoder_of("flexitac");
    const auto decoded = decode(*decoder, bytes);
    // All but the damaged ones, and the one before where its next header is gone.
    ASSERT_GE(decoded.size(), 60 - (last_damaged - damaged + 1) - 1);
    for (const RawFrame& frame : decoded) {
      EXPECT_TRUE(std::any_of(frames.begin(), frames.end(), [&](const auto& f) { return f.counts == frame.counts; }));
    }
  }
}

TEST(Flexitac, delivers_the_frames_beside_a_header_with_a_flipped_bit) {
  Random random(5);
  const auto frames = random_frames(20, {16, 16}, random);
  Bytes bytes = flexitac_bytes({16, 16}, frames);
  bytes[10 * 258 + 1] ^= 4;
  auto expected = frames;
  expected.erase(expected.begin() + 10);
  const auto decoder = decoder_of("flexitac");
  expect_counts(decode(*decoder, bytes), expected);
  EXPECT_EQ(decoder->counts().damaged_frames, 1U);
}

TEST(Flexitac, waits_for_the_next_header) {
  Random random(6);
  const auto frames = random_frames(10, {16, 16}, random);
  const Bytes bytes = flexitac_bytes({16, 16}, frames);
  const auto decoder = decoder_of("flexitac", FrameShape{16, 16});
  EXPECT_EQ(decode(*decoder, bytes, false).size(), 9U);
  EXPECT_EQ(decode(*decoder, {}, true).size(), 1U);
}

/// What comes of `bytes` when the device pauses behind them.
std::vector<RawFrame> decode_and_pause(Decoder& decoder, std::span<const std::uint8_t> bytes) {
  std::vector<RawFrame> frames = decode(decoder, bytes, false);
  decoder.idle();
  const std::vector<RawFrame> last = decode(decoder, {}, false);
  frames.insert(frames.end(), last.begin(), last.end());
  return frames;
}

TEST(Flexitac, delivers_the_last_frame_when_the_device_pauses) {
  Random random(11);
  const auto frames = random_frames(40, {16, 16}, random);
  const Bytes bytes = flexitac_bytes({16, 16}, frames);
  const auto decoder = decoder_of("flexitac", FrameShape{16, 16});
  std::size_t begin = 0;
  std::size_t delivered = 0;
  for (std::size_t count = 1; begin < frames.size(); begin += count++) {
    count = std::min(count, frames.size() - begin);
    SCOPED_TRACE(begin);
    const auto piece = std::span(bytes).subspan(begin * 258, count * 258);
    const auto expected = std::span(frames).subspan(begin, count);
    expect_counts(decode_and_pause(*decoder, piece), {expected.begin(), expected.end()});
    delivered += count;
  }
  EXPECT_EQ(delivered, 40U);
  EXPECT_EQ(decoder->counts().skipped_bytes, 0U);
}

TEST(Flexitac, keeps_a_frame_that_a_pause_has_cut) {
  Random random(12);
  const auto frames = random_frames(6, {16, 16}, random);
  const Bytes bytes = flexitac_bytes({16, 16}, frames);
  for (const std::size_t cut : {std::size_t{1}, std::size_t{2}, std::size_t{100}, std::size_t{257}}) {
    SCOPED_TRACE(cut);
    const auto decoder = decoder_of("flexitac", FrameShape{16, 16});
    const std::size_t paused_at = 774 + cut;  // three frames and some bytes
    auto delivered = decode_and_pause(*decoder, std::span(bytes).first(paused_at));
    for (std::size_t at = paused_at; at < bytes.size(); ++at) {  // what comes after the pause waits again
      const auto more = decode(*decoder, std::span(bytes).subspan(at, 1), false);
      delivered.insert(delivered.end(), more.begin(), more.end());
    }
    EXPECT_EQ(delivered.size(), 5U);
    const auto last = decode(*decoder, {}, true);
    delivered.insert(delivered.end(), last.begin(), last.end());
    expect_counts(delivered, frames);
    EXPECT_EQ(decoder->counts().skipped_bytes, 0U);
  }
}

TEST(Flexitac, finds_its_place_in_a_pause_after_the_rest_of_a_frame) {
  Random random(13);
  const auto frames = random_frames(3, {16, 16}, random);
  const Bytes bytes = flexitac_bytes({16, 16}, frames);
  const auto decoder = decoder_of("flexitac", FrameShape{16, 16});
  expect_counts(decode_and_pause(*decoder, std::span(bytes).subspan(150)), {frames.begin() + 1, frames.end()});
}

TEST(Flexitac, a_pause_makes_no_frame_of_bytes_too_few_or_too_many) {
  Random random(14);
  const auto frames = random_frames(12, {16, 16}, random);
  for (const int change : {-1, 1}) {
    SCOPED_TRACE(change);
    Bytes bytes = flexitac_bytes({16, 16}, frames);
    if (change < 0) bytes.pop_back();
    if (change > 0) bytes.push_back(0);
    const auto decoder = decoder_of("flexitac", FrameShape{16, 16});
    EXPECT_EQ(decode_and_pause(*decoder, bytes).size(), 11U);
  }
}

TEST(Flexitac, reads_a_stream_of_a_single_frame) {
  Random random(7);
  const auto frames = random_frames(1, {3, 5}, random);
  expect_counts(decode(*decoder_of("flexitac", FrameShape{3, 5}), flexitac_bytes({3, 5}, frames)), frames);
}

Bytes m1616_bytes(const std::vector<RawFrame>& frames, std::size_t trailer) {
  Bytes bytes;
  for (const RawFrame& frame : frames) {
    bytes.insert(bytes.end(), {0xAA, 0xAB, 0xAC});
    for (const float count : frame.counts) {
      const auto value = static_cast<unsigned>(count);
      bytes.push_back(static_cast<std::uint8_t>(value / 256));
      bytes.push_back(static_cast<std::uint8_t>(value % 256));
    }
    for (std::size_t i = 0; i < trailer; ++i) bytes.push_back(static_cast<std::uint8_t>(17 * i + frame.counts.size()));
  }
  return bytes;
}

TEST(M1616, takes_both_readings_of_its_packet_size) {
  for (const std::size_t trailer : {4U, 1U}) {
    Random random(8);
    std::vector<RawFrame> frames;
    for (int k = 0; k < 10; ++k) frames.push_back(random_frame(256, 4095, random));
    expect_counts(decode(*decoder_of("m1616"), m1616_bytes(frames, trailer)), frames);
  }
}

TEST(M1616, delivers_the_last_frame_when_the_device_pauses) {
  Random random(15);
  std::vector<RawFrame> frames;
  for (int k = 0; k < 10; ++k) frames.push_back(random_frame(256, 4095, random));
  expect_counts(decode_and_pause(*decoder_of("m1616"), m1616_bytes(frames, 4)), frames);
}

TEST(PressureMat, asks_once_and_does_not_wait) {
  const auto decoder = decoder_of("pressure-mat");
  EXPECT_EQ(decoder->request(), "start_reading\n");
  Bytes bytes(1568, 207);
  bytes[28] = 1;
  bytes.insert(bytes.end(), {0xFF, 0xFE, 0xFE, 0xFF});
  const auto frames = decode(*decoder, bytes, false);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].counts[28], 1.0F);
  EXPECT_EQ(decoder->shape(), (FrameShape{56, 28}));
  EXPECT_EQ(decoder->request(), "");
  (void)decode(*decoder, {}, true);
  EXPECT_EQ(decoder->request(), "start_reading\n") << "after it was unplugged";

  const auto encoder = encoder_of("pressure-mat", {56, 28});
  EXPECT_EQ(encoder->request(), "start_reading\n");
  encoder->encode(frames[0], bytes);
  EXPECT_EQ(encoder->request(), "");
}

TEST(PressureMat, takes_readings_that_look_like_its_trailer) {
  Random random(9);
  std::vector<RawFrame> frames;
  Bytes bytes(700, 3);  // the end of a frame
  bytes.insert(bytes.end(), {0xFF, 0xFE, 0xFE, 0xFF});
  const auto encoder = encoder_of("pressure-mat", {56, 28});
  for (int k = 0; k < 20; ++k) {
    RawFrame& frame = frames.emplace_back(random_frame(1568, 255, random));
    const auto at = frame.counts.begin() + static_cast<std::ptrdiff_t>(random.below(1565));
    std::copy_n(std::vector<float>{255, 254, 254, 255}.begin(), 4, at);
    encoder->encode(frame, bytes);
  }
  expect_counts(decode(*decoder_of("pressure-mat"), bytes), frames);
}

/// The CRC bit by bit, as Wuji's form is defined.
std::uint16_t crc_16_ccitt(std::span<const std::uint8_t> bytes) {
  unsigned crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= static_cast<unsigned>(byte) << 8U;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x8000U) != 0 ? (crc << 1U) ^ 0x1021U : crc << 1U;
    crc &= 0xFFFFU;
  }
  return static_cast<std::uint16_t>(crc);
}

void put_little(Bytes& bytes, std::size_t at, std::uint64_t value, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

/// A frame by the offsets of wujihandcpp, data/tactile.hpp.
Bytes wuji_bytes(std::size_t size, const std::vector<float>& readings, std::uint16_t sequence, std::uint32_t time_ms) {
  Bytes bytes(size);
  put_little(bytes, 0, 0x55AA, 2);
  put_little(bytes, 2, size, 2);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (size == 3088) put_little(bytes, 8 + 4 * i, std::bit_cast<std::uint32_t>(readings[i]), 4);
    if (size == 1550) put_little(bytes, 6 + 2 * i, static_cast<std::uint16_t>(static_cast<int>(readings[i])), 2);
  }
  put_little(bytes, size - 8, sequence, 2);
  put_little(bytes, size - 6, time_ms, 4);
  put_little(bytes, size - 2, crc_16_ccitt(std::span(bytes).subspan(2, size - 4)), 2);
  return bytes;
}

TEST(Wuji, the_crc_has_its_published_check_value) {
  const std::string check = "123456789";
  EXPECT_EQ(crc_16_ccitt(Bytes(check.begin(), check.end())), 0x29B1);
}

TEST(Wuji, takes_the_crc_of_any_bytes_and_no_other) {
  Random random(12);
  for (int k = 0; k < 300; ++k) {
    const std::size_t size = k % 2 == 0 ? 3088 : 1550;
    Bytes bytes = wuji_bytes(size, {}, 0, 0);
    for (std::size_t i = 4; i < size - 2; ++i) bytes[i] = static_cast<std::uint8_t>(random.bits());
    put_little(bytes, size - 2, crc_16_ccitt(std::span(bytes).subspan(2, size - 4)), 2);
    ASSERT_EQ(decode(*decoder_of("wuji"), bytes).size(), 1U) << k;
    bytes[2 + random.below(size - 2)] ^= static_cast<std::uint8_t>(1U << random.below(8));
    ASSERT_EQ(decode(*decoder_of("wuji"), bytes).size(), 0U) << k;
  }
}

TEST(Wuji, reads_both_forms) {
  std::vector<float> fractions(768, 0.25F);
  fractions[5] = std::numeric_limits<float>::quiet_NaN();
  fractions[767] = 1.0F;
  std::vector<float> integers(768, -3.0F);
  integers[767] = 4095.0F;
  Bytes bytes = wuji_bytes(3088, fractions, 65534, 4294967290);
  const Bytes other = wuji_bytes(1550, integers, 1, 14);
  bytes.insert(bytes.end(), other.begin(), other.end());
  const auto decoder = decoder_of("wuji");
  const auto frames = decode(*decoder, bytes);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].counts[0], 0.25F);
  EXPECT_TRUE(std::isnan(frames[0].counts[5]));
  EXPECT_EQ(frames[0].counts[767], 1.0F);
  EXPECT_EQ(frames[1].counts, integers);
  EXPECT_EQ(frames[1].acquisition.sequence, 65537U);
  EXPECT_EQ(frames[1].acquisition.device_time, std::chrono::milliseconds((std::int64_t{1} << 32) + 14));
  EXPECT_EQ(decoder->counts(), (DecoderCounts{.frames = 2, .lost_frames = 2}));
}

TEST(Wuji, begins_anew_with_a_clock_that_leaps_beyond_all_time) {
  const std::vector<float> readings(768, 3.0F);
  const auto decoder = decoder_of("wuji");
  RawFrame frame;
  Nanos latest{};
  std::size_t restarts = 0;
  for (std::uint32_t k = 0; k < 9000; ++k) {  // by 2^31 - 1 ms each: 2^63 ns are 4295 of them
    decoder->push(wuji_bytes(1550, readings, static_cast<std::uint16_t>(k), k * INT32_MAX));
    ASSERT_TRUE(decoder->next(frame));
    ASSERT_TRUE(frame.acquisition.device_time);
    const Nanos time = *frame.acquisition.device_time;
    ASSERT_GE(time, Nanos{});
    if (k > 0 && time < latest) ++restarts;
    latest = time;
  }
  EXPECT_EQ(restarts, 4U);
  EXPECT_EQ(decoder->counts().lost_frames, 0U);
}

TEST(Wuji, drops_frames_that_come_late_or_twice) {
  const std::vector<float> readings(768, 3.0F);
  Bytes bytes;
  for (const std::uint16_t sequence : std::initializer_list<std::uint16_t>{65535, 65535, 1, 0, 2}) {
    const Bytes one = wuji_bytes(1550, readings, sequence, 1000 + static_cast<std::uint16_t>(sequence + 1) * 10U);
    bytes.insert(bytes.end(), one.begin(), one.end());
  }
  const auto decoder = decoder_of("wuji");
  EXPECT_EQ(sequences_of(decode(*decoder, bytes)), (std::vector<std::uint64_t>{65535, 65537, 65538}));
  EXPECT_EQ(decoder->counts(), (DecoderCounts{.frames = 3, .lost_frames = 1, .late_frames = 1, .repeated_frames = 1}));
}

TEST(Wuji, finds_a_frame_inside_a_damaged_one) {
  const std::vector<float> readings(768, 0.5F);
  const Bytes whole = wuji_bytes(3088, readings, 7, 100);
  Bytes bytes(whole.begin(), whole.begin() + 1000);  // cut by a lost piece
  bytes.insert(bytes.end(), whole.begin(), whole.end());
  bytes.insert(bytes.end(), 2088, 0);
  const auto decoder = decoder_of("wuji");
  EXPECT_EQ(decode(*decoder, bytes).size(), 1U);
  EXPECT_EQ(decoder->counts().damaged_frames, 1U);
  EXPECT_EQ(decoder->frame_end(), 4088U);
}

TEST(Wuji, sends_the_long_form_for_fractions_and_the_short_one_for_integers) {
  const auto encoder = encoder_of("wuji", {24, 32});
  RawFrame fractions = frame_of(std::vector<float>(768, 0.125F));
  fractions.acquisition.sequence = 9;
  fractions.acquisition.device_time = std::chrono::microseconds(7900);
  Bytes bytes;
  encoder->encode(fractions, bytes);
  EXPECT_EQ(bytes, wuji_bytes(3088, fractions.counts, 9, 7));
  RawFrame integers = frame_of(std::vector<float>(768, 900.0F));
  integers.time = std::chrono::milliseconds(70000);
  bytes.clear();
  encoder->encode(integers, bytes);
  EXPECT_EQ(bytes, wuji_bytes(1550, integers.counts, 10, 70000));
}

}  // namespace
}  // namespace dermis::bytes::devices
