// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// protocol=auto and detect_protocol().
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "bytes/devices/decoding.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::bytes::devices {
namespace {

constexpr std::size_t kMostKept = std::size_t{256} * 1024;

/// What a device of the protocol usually is.
FrameShape usual_shape(const std::string& name) {
  if (name == "pressure-mat") return {56, 28};
  if (name == "wuji") return {24, 32};
  if (name == "stag") return {32, 32};
  if (name == "tactileglove") return {1, 54};
  return {16, 16};
}

using Counts = std::vector<std::vector<float>>;

struct Stream {
  Bytes bytes;
  std::vector<std::uint64_t> ends;  // of frames
};

/// Frames of a hand at work: most taxels idle, some pressed.
Stream stream_of(const ProtocolOptions& options, std::size_t size, std::uint64_t seed) {
  Random random(seed);
  const std::unique_ptr<Encoder> encoder = std::move(make_encoder(options)).value();
  RawFrame frame;
  frame.counts.resize(options.shape->taxel_count());
  Stream stream;
  const double top = options.name == "wuji" ? 1.0 : 255.0;
  while (stream.bytes.size() < size) {
    for (float& count : frame.counts) count = random.below(3) == 0 ? static_cast<float>(random.uniform(0, top)) : 0.0F;
    frame.acquisition.sequence = stream.ends.size();
    frame.acquisition.device_time = Nanos{stream.ends.size() * 1'000'000};
    encoder->encode(frame, stream.bytes);
    stream.ends.push_back(stream.bytes.size());
  }
  return stream;
}

Counts decoded_by(const ProtocolOptions& options, const Bytes& bytes) {
  return counts_of(push_all(*decoder_for(options), bytes));
}

TEST(ProtocolDetection, finds_each_protocol_in_its_bytes_and_delivers_every_frame) {
  for (const std::string& name : protocol_names()) {
    if (name == "auto") continue;
    ProtocolOptions options = {.name = name, .shape = usual_shape(name)};
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      SCOPED_TRACE(name + ", seed " + std::to_string(seed));
      if (name == "wiresens") options.delimited = seed % 2 == 0;
      const Stream stream = stream_of(options, 40'000, seed);
      const auto decoder = decoder_for({});
      const Counts frames = counts_of(push_all(*decoder, stream.bytes));
      ASSERT_EQ(decoder->detected_protocol(), name);
      ASSERT_EQ(decoder->shape(), options.shape);
      ASSERT_EQ(frames, decoded_by(options, stream.bytes));
      ASSERT_GE(frames.size() + 1, stream.ends.size());
      if (seed < 5) {
        ASSERT_EQ(detect_protocol(stream.bytes), name);
      }
    }
  }
}

TEST(ProtocolDetection, does_not_depend_on_how_the_bytes_are_cut) {
  for (const std::string& name : protocol_names()) {
    if (name == "auto") continue;
    SCOPED_TRACE(name);
    Bytes bytes = {0xAA, 0x55, 7, '\n', '1', ',', '2', '\n', 0x3C};
    const Stream stream = stream_of({.name = name, .shape = usual_shape(name)}, 20'000, 1);
    bytes.insert(bytes.end(), stream.bytes.begin(), stream.bytes.end());
    const auto whole = decoder_for({});
    const std::vector<RawFrame> frames = decode_all(*whole, bytes);
    EXPECT_EQ(whole->detected_protocol(), name);
    for (const std::size_t piece : {1U, 7U, 255U, 4096U}) {
      const auto cut = decoder_for({});
      EXPECT_EQ(counts_of(decode_all(*cut, bytes, piece)), counts_of(frames));
      EXPECT_EQ(cut->counts(), whole->counts());
      EXPECT_EQ(cut->frame_end(), whole->frame_end());
    }
  }
}

/// Readings of a press that wanders, so that frames and rows can be told apart.
int reading(std::size_t frame, std::size_t row, std::size_t col) {
  const double down = static_cast<double>(row) - 6.0 - 3.0 * std::sin(static_cast<double>(frame) / 5.0);
  const double right = static_cast<double>(col) - 5.0;
  return static_cast<int>(700.0 * std::exp(-(down * down + right * right) / 6.0)) +
         static_cast<int>(7 * row + 3 * col + frame) % 5;
}

std::string row_of(std::size_t frame, std::size_t row, std::size_t cols) {
  std::string text;
  for (std::size_t col = 0; col < cols; ++col) text += (col > 0 ? "," : "") + std::to_string(reading(frame, row, col));
  return text;
}

TEST(ProtocolDetection, numbers_of_another_layout_are_of_no_protocol) {
  std::string messages;
  std::string arrays;
  std::string screens;
  std::string triples;
  for (std::size_t frame = 0; frame < 40; ++frame) {
    screens += "\x1b[H";
    std::string line;
    for (std::size_t row = 0; row < 12; ++row) {
      line += (row > 0 ? "," : "") + row_of(frame, row, 10);
      screens += row_of(frame, row, 10) + "\r\n";
      for (std::size_t col = 0; col < 10; ++col) {
        triples +=
            std::to_string(row) + "," + std::to_string(col) + "," + std::to_string(reading(frame, row, col)) + "\n";
      }
    }
    messages += line + (frame % 5 == 4 ? "\nDEBUG adc ok\n" : "\n");
    arrays += "{\"id\":" + std::to_string(1 + frame % 2) + ",\"values\":[" + line + "]}\n";
    screens += "\r\n";
    triples += "\n";
  }
  for (const std::string& text : {messages, arrays, screens, triples}) {
    const Bytes bytes(text.begin(), text.end());
    const auto decoder = decoder_for({});
    EXPECT_TRUE(decode_all(*decoder, bytes).empty()) << text.substr(0, 80);
    EXPECT_EQ(decoder->detected_protocol(), "");
    EXPECT_EQ(detect_protocol(bytes), "");
  }
}

TEST(ProtocolDetection, delivers_the_last_frame_when_the_device_pauses) {
  for (const std::string name : {"flexitac", "m1616"}) {
    SCOPED_TRACE(name);
    const Stream stream = stream_of({.name = name, .shape = FrameShape{16, 16}}, 40'000, 3);
    const auto decoder = decoder_for({});
    std::size_t delivered = push_all(*decoder, stream.bytes).size();
    decoder->idle();
    RawFrame frame;
    while (decoder->next(frame)) ++delivered;
    EXPECT_EQ(delivered, stream.ends.size());
  }
}

TEST(ProtocolDetection, delivers_every_frame_where_it_is_the_pause_that_tells) {
  const Stream stream = stream_of({.name = "flexitac", .shape = FrameShape{12, 16}}, 776, 4);
  const auto decoder = decoder_for({.shape = FrameShape{12, 16}});
  decoder->push(stream.bytes);
  RawFrame frame;
  EXPECT_FALSE(decoder->next(frame));
  decoder->idle();
  std::size_t delivered = 0;
  while (decoder->next(frame)) ++delivered;
  EXPECT_EQ(delivered, 4U);
}

TEST(ProtocolDetection, uses_the_shape_that_is_given) {
  for (const std::string name : {"3dvitac", "csv", "dermis", "flexitac", "stag", "tactileglove", "wiresens"}) {
    SCOPED_TRACE(name);
    const ProtocolOptions options = {.name = name, .shape = FrameShape{6, 7}};
    const Stream stream = stream_of(options, 20'000, 2);
    const auto decoder = decoder_for({.shape = options.shape});
    EXPECT_EQ(counts_of(push_all(*decoder, stream.bytes)), decoded_by(options, stream.bytes));
    EXPECT_EQ(decoder->detected_protocol(), name);
    EXPECT_EQ(decoder->shape(), options.shape);
  }
}

TEST(ProtocolDetection, finds_wiresens_that_leaves_packets_out) {
  for (const std::optional<FrameShape> shape : {std::optional<FrameShape>{}, std::optional(FrameShape{16, 16})}) {
    const Stream stream =
        stream_of({.name = "wiresens", .shape = FrameShape{16, 16}, .nodes_per_packet = 100}, 60'000, 8);
    Random random(8);
    Bytes sent;
    constexpr std::size_t kPacket = 209;
    for (std::size_t at = 0; at + kPacket <= stream.bytes.size(); at += kPacket) {
      if (random.below(4) == 0) continue;
      sent.insert(sent.end(), &stream.bytes[at], &stream.bytes[at] + kPacket);
    }
    const auto decoder = decoder_for({.shape = shape});
    const Counts frames = counts_of(push_all(*decoder, sent));
    EXPECT_EQ(decoder->detected_protocol(), "wiresens");
    EXPECT_GT(frames.size(), stream.ends.size() - 5);
  }
}

TEST(ProtocolDetection, finds_wiresens_behind_damaged_packets) {
  Stream stream = stream_of({.name = "wiresens", .shape = FrameShape{32, 32}}, 100'000, 9);
  for (std::size_t at = 0; at < 6; ++at)
    stream.bytes.erase(stream.bytes.begin() + static_cast<std::ptrdiff_t>(900 * at));
  const ProtocolOptions known = {.shape = FrameShape{32, 32}};
  const auto decoder = decoder_for(known);
  EXPECT_EQ(counts_of(push_all(*decoder, stream.bytes)),
            decoded_by({.name = "wiresens", .shape = known.shape}, stream.bytes));
  EXPECT_EQ(decoder->detected_protocol(), "wiresens");
}

TEST(ProtocolDetection, finds_nothing_in_noise_and_keeps_no_more_than_it_may) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const std::uint64_t range = seed % 2 == 0 ? 256 : 20;  // the latter hits markers and separators more often
    Bytes noise(2 * kMostKept + 1000);
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random.below(range));
    const auto decoder = decoder_for({});
    EXPECT_TRUE(decode_all(*decoder, noise).empty());
    EXPECT_EQ(decoder->detected_protocol(), "");
    EXPECT_EQ(decoder->counts(), (DecoderCounts{.skipped_bytes = noise.size()}));
    EXPECT_EQ(detect_protocol(noise), "");
  }
}

TEST(ProtocolDetection, recovers_from_noise_at_the_beginning) {
  Random random(3);
  Bytes bytes(kMostKept + 5000);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.below(256));
  const Stream stream = stream_of({.name = "dermis", .shape = FrameShape{16, 16}}, 50'000, 4);
  bytes.insert(bytes.end(), stream.bytes.begin(), stream.bytes.end());
  const auto decoder = decoder_for({});
  EXPECT_GE(push_all(*decoder, bytes).size() + 1, stream.ends.size());
  EXPECT_EQ(decoder->detected_protocol(), "dermis");
}

TEST(ProtocolDetection, names_a_protocol_that_needs_to_be_told_more) {
  EXPECT_EQ(detect_protocol(stream_of({.name = "wiresens", .shape = FrameShape{12, 32}}, 30'000, 5).bytes), "wiresens");
  EXPECT_EQ(detect_protocol(stream_of({.name = "stag", .shape = FrameShape{32, 32}, .bit_shift = 6}, 30'000, 6).bytes),
            "stag");
}

TEST(ProtocolDetection, asks_devices_that_wait_for_a_request) {
  const auto decoder = decoder_for({});
  EXPECT_NE(decoder->request().find('a'), std::string_view::npos);
  EXPECT_EQ(decoder->request(), "start_reading\n");
  const Stream stream = stream_of({.name = "stag", .shape = FrameShape{32, 32}}, 30'000, 7);
  push_all(*decoder, stream.bytes);
  EXPECT_EQ(decoder->request(), "a");
}

}  // namespace
}  // namespace dermis::bytes::devices
