// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/proposals/proposals.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dermis/bytes/layouts/layout.hpp"
#include "streams.hpp"

namespace dermis::bytes::proposals {
namespace {

using test::Bytes;
using test::Frame;
using test::joined;
using test::row_of;

constexpr FrameShape kShape{8, 6};

Bytes bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

std::vector<Frame> frames_of(const std::string& toml, const Bytes& bytes, std::size_t array = 0) {
  Result<layouts::Layout> layout = layouts::layout_from_toml(toml, "it.toml");
  EXPECT_TRUE(layout) << layout.error().message << toml;
  if (!layout || layout->arrays.size() <= array) return {};
  const auto decoder = layouts::make_decoder(std::make_shared<const layouts::Layout>(*std::move(layout)), array, true);
  std::vector<Frame> frames;
  RawFrame frame;
  const auto drain = [&] {
    while (decoder->next(frame)) frames.emplace_back(frame.counts.begin(), frame.counts.end());
  };
  decoder->push(bytes);
  drain();
  decoder->finish();
  drain();
  return frames;
}

/// The first proposal gives the frames, whether the shape is given or found.
void expect_frames(const Bytes& bytes, const std::vector<Frame>& frames, const Known& known) {
  const std::vector<Proposal> proposals = propose(bytes, known);
  ASSERT_FALSE(proposals.empty());
  const Proposal& best = proposals.front();
  EXPECT_LE(proposals.size(), kMostProposals);
  EXPECT_EQ(frames_of(best.toml, bytes), frames) << best.toml;
  EXPECT_EQ(best.frames, frames.size());
  EXPECT_EQ(best.shape, kShape) << best.toml;
}

struct Stream {
  const char* name;
  std::function<std::string(const Frame& frame, std::size_t k)> print;
};

std::string in_rows(const Frame& frame, const std::function<std::string(std::size_t row, const Frame&)>& print) {
  std::string text;
  for (std::size_t row = 0; row < kShape.rows; ++row) text += print(row, row_of(frame, row, kShape.cols));
  return text;
}

std::string in_taxels(const Frame& frame, const std::function<std::string(std::size_t, std::size_t, int)>& print) {
  std::string text;
  for (std::size_t i = 0; i < frame.size(); ++i) text += print(i / kShape.cols, i % kShape.cols, frame[i]);
  return text;
}

std::string number(std::size_t value) {
  return std::to_string(value);
}

const std::vector<Stream>& text_streams() {
  static const std::vector<Stream> kStreams = {
      {"a line a frame", [](const Frame& f, std::size_t) { return joined(f, ",") + "\n"; }},
      {"CR alone", [](const Frame& f, std::size_t) { return joined(f, " ") + "\r"; }},
      {"angle brackets", [](const Frame& f, std::size_t) { return "<" + joined(f, ",") + ">"; }},
      {"a list of Python",
       [](const Frame& f, std::size_t) {
         return "[" +
                in_rows(f, [](std::size_t r,
                              const Frame& row) { return (r > 0 ? ", [" : "[") + joined(row, ", ") + "]"; }) +
                "]\n";
       }},
      {"a matrix and an empty line",
       [](const Frame& f, std::size_t) {
         return in_rows(f, [](std::size_t, const Frame& row) { return joined(row, "\t") + "\t\r\n"; }) + "\r\n";
       }},
      {"a matrix on a cleared screen",
       [](const Frame& f, std::size_t) {
         return "\x1b[2J\x1b[H" + in_rows(f, [](std::size_t, const Frame& row) { return joined(row, " ") + "\r\n"; });
       }},
      {"a matrix as numpy prints it",
       [](const Frame& f, std::size_t) {
         return in_rows(f, [](std::size_t r, const Frame& row) {
           return (r == 0 ? "[[" : " [") + joined(row, " ", "%4d") + (r + 1 == kShape.rows ? "]]\n" : "]\n");
         });
       }},
      {"rows by number from 1 on",
       [](const Frame& f, std::size_t) {
         return in_rows(
             f, [](std::size_t r, const Frame& row) { return "Row" + number(r + 1) + ": " + joined(row, " ") + "\n"; });
       }},
      {"a log with times",
       [](const Frame& f, std::size_t k) {
         return "I (" + number(4000 + 20 * k) + ") tactile: " + joined(f, " ") + "\r\n";
       }},
      {"JSON",
       [](const Frame& f, std::size_t k) {
         return "{\"t\": " + number(10 * k) + ", \"seq\": " + number(k) + ", \"data\": [" + joined(f, ", ") +
                "], \"temp\": 23.5}\n";
       }},
      {"a time of day",
       [](const Frame& f, std::size_t k) { return "18:45:" + number(10 + k) + ".500;" + joined(f, ";") + "\n"; }},
      {"a message every fifth line",
       [](const Frame& f, std::size_t k) { return (k % 4 == 3 ? "DEBUG adc ok\n" : "") + joined(f, ",") + "\n"; }},
      {"triples and an empty line",
       [](const Frame& f, std::size_t) {
         return in_taxels(f, [](std::size_t r, std::size_t c,
                                int v) { return number(r) + "," + number(c) + "," + std::to_string(v) + "\n"; }) +
                "\n";
       }},
      {"an index and a reading",
       [](const Frame& f, std::size_t) {
         return in_taxels(f, [](std::size_t r, std::size_t c, int v) {
           return number(r * kShape.cols + c) + ": " + std::to_string(v) + "\n";
         });
       }},
      {"hexadecimal digits", [](const Frame& f, std::size_t) { return joined(f, " ", "%04X") + "\n"; }},
      {"packed hexadecimal digits", [](const Frame& f, std::size_t) { return joined(f, "", "%03X") + "\n"; }},
      {"marked hexadecimal digits", [](const Frame& f, std::size_t) { return "0x" + joined(f, ",0x", "%X") + "\n"; }},
      {"bars", [](const Frame& f, std::size_t) { return joined(f, "|") + "\n"; }},
      {"the time at the end",
       [](const Frame& f, std::size_t k) { return joined(f, " ") + " " + number(500 + 10 * k) + "\n"; }},
  };
  return kStreams;
}

/// What stands between the mark or delimiters of a packet, by the number of the frame.
struct PacketStream {
  const char* name;
  std::function<Bytes(const Frame& frame, std::size_t k)> send;
};

Bytes with_checksum(Bytes bytes, std::uint16_t checksum) {
  test::add_number(bytes, checksum, 2);
  return bytes;
}

const std::vector<PacketStream>& packet_streams() {
  static const std::vector<PacketStream> kStreams = {
      {"a mark and u8",
       [](const Frame& f, std::size_t) {
         Bytes bytes = {0xFF, 0xFF};
         for (const int value : f) bytes.push_back(static_cast<std::uint8_t>(std::min(value / 4, 254)));
         return bytes;
       }},
      {"a mark and u16be",
       [](const Frame& f, std::size_t) {
         Bytes bytes = {0xAA, 0x55};
         test::add_readings(bytes, f, 2, true);
         return bytes;
       }},
      {"a counter and u12be",
       [](const Frame& f, std::size_t k) {
         Bytes bytes = {0xA5, 0x5A, static_cast<std::uint8_t>(k)};
         test::add_packed(bytes, f, 12);
         return bytes;
       }},
      {"a clock, CRC-16 and CR LF",
       [](const Frame& f, std::size_t k) {
         Bytes bytes = {0xAA, 0x55};
         test::add_number(bytes, 3000 + 10 * k, 4);
         test::add_readings(bytes, f);
         bytes = with_checksum(bytes, test::crc16_modbus(bytes));
         bytes.insert(bytes.end(), {'\r', '\n'});
         return bytes;
       }},
      {"COBS with a counter and CRC-16",
       [](const Frame& f, std::size_t k) {
         Bytes bytes = {static_cast<std::uint8_t>(k)};
         test::add_readings(bytes, f);
         return test::with_cobs(with_checksum(bytes, test::crc16_ccitt(bytes)));
       }},
      {"SLIP and u16be",
       [](const Frame& f, std::size_t) {
         Bytes bytes;
         test::add_readings(bytes, f, 2, true);
         return test::with_slip(bytes);
       }},
  };
  return kStreams;
}

TEST(Proposals, the_first_reads_text_whose_shape_is_given) {
  const std::vector<Frame> frames = test::pressed_frames(kShape);
  for (const Stream& stream : text_streams()) {
    std::string text;
    for (std::size_t k = 0; k < frames.size(); ++k) text += stream.print(frames[k], k);
    SCOPED_TRACE(stream.name);
    expect_frames(bytes_of(text), frames, {.rows = kShape.rows, .cols = kShape.cols});
  }
}

TEST(Proposals, the_first_finds_the_shape_of_text) {
  const std::vector<Frame> frames = test::pressed_frames(kShape);
  for (const Stream& stream : text_streams()) {
    std::string text;
    for (std::size_t k = 0; k < frames.size(); ++k) text += stream.print(frames[k], k);
    SCOPED_TRACE(stream.name);
    expect_frames(bytes_of(text), frames, {});
  }
}

TEST(Proposals, the_first_reads_packets_whose_shape_is_given) {
  for (const PacketStream& stream : packet_streams()) {
    const bool is_of_bytes = stream.name == std::string("a mark and u8");
    std::vector<Frame> frames = test::pressed_frames(kShape, 3000.0);
    Bytes bytes;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      if (is_of_bytes)
        std::transform(frames[k].begin(), frames[k].end(), frames[k].begin(), [](int v) { return std::min(v, 999); });
      const Bytes packet = stream.send(frames[k], k);
      bytes.insert(bytes.end(), packet.begin(), packet.end());
    }
    for (Frame& frame : frames) {
      if (is_of_bytes) std::transform(frame.begin(), frame.end(), frame.begin(), [](int v) { return v / 4; });
    }
    SCOPED_TRACE(stream.name);
    expect_frames(bytes, frames, {.rows = kShape.rows, .cols = kShape.cols});
  }
}

TEST(Proposals, arrays_in_turn_and_side_by_side_are_several) {
  const FrameShape shape{6, 4};
  const std::vector<Frame> left = test::pressed_frames(shape, 800.0, 2);
  const std::vector<Frame> right = test::pressed_frames(shape, 800.0, 5);
  std::string named;
  std::string numbered;
  std::string beside;
  for (std::size_t k = 0; k < left.size(); ++k) {
    named += "L " + joined(left[k], " ") + "\nR " + joined(right[k], " ") + "\n";
    numbered +=
        "{\"id\":1,\"values\":[" + joined(left[k], ",") + "]}\n{\"id\":2,\"values\":[" + joined(right[k], ",") + "]}\n";
    beside += joined(left[k], ",") + "," + joined(right[k], ",") + "\n";
  }
  for (const std::string& text : {named, numbered, beside}) {
    const std::vector<Proposal> proposals = propose(bytes_of(text), {.rows = shape.rows, .cols = shape.cols});
    ASSERT_FALSE(proposals.empty()) << text.substr(0, 200);
    EXPECT_EQ(frames_of(proposals.front().toml, bytes_of(text), 0), left) << proposals.front().toml;
    EXPECT_EQ(frames_of(proposals.front().toml, bytes_of(text), 1), right) << proposals.front().toml;
  }
}

TEST(Proposals, what_is_left_over_is_said) {
  std::string text = "# firmware 1.0\n";
  const std::vector<Frame> frames = test::pressed_frames(kShape);
  for (std::size_t k = 0; k < frames.size(); ++k)
    text += (k % 4 == 3 ? "DEBUG adc ok\n" : "") + joined(frames[k], ",") + "\n";
  const std::vector<Proposal> proposals = propose(bytes_of(text), {});
  ASSERT_FALSE(proposals.empty());
  EXPECT_EQ(proposals.front().left_over,
            (std::vector<std::string>{"the first line is none of readings", "every fifth line begins with 'DEBUG'"}));
  EXPECT_EQ(proposals.front().summary, "30 lines of 48 numbers: rows=8, cols=6?");
  EXPECT_EQ(proposals.front().open, (std::vector<std::string>{"rows", "cols"}));
}

TEST(Proposals, there_is_none_where_most_is_left_over) {
  const std::vector<Frame> frames = test::pressed_frames(kShape);
  std::string text;
  for (const Frame& frame : frames)
    text +=
        "The quick brown fox jumps over the lazy dog and runs away from it, again and again and again, over the hills. "
        "And then it comes back.\n" +
        joined(frame, " ") + "\n";
  EXPECT_TRUE(propose(bytes_of(text), {}).empty());
  Bytes noise;
  std::uint32_t state = 7;
  for (int i = 0; i < 20000; ++i) {
    state = 1664525U * state + 1013904223U;
    noise.push_back(static_cast<std::uint8_t>(state >> 24U));
  }
  EXPECT_TRUE(propose(noise, {}).empty());
  EXPECT_TRUE(propose({}, {}).empty());
}

TEST(Proposals, readings_that_fall_where_pressed_are_turned) {
  std::vector<Frame> frames = test::pressed_frames(kShape, 3000.0);
  std::string text;
  for (Frame frame : frames) {
    for (int& value : frame) value = 4095 - value;
    text += joined(frame, ",") + "\n";
  }
  const std::vector<Proposal> proposals = propose(bytes_of(text), {});
  ASSERT_FALSE(proposals.empty());
  EXPECT_EQ(frames_of(proposals.front().toml, bytes_of(text)), frames) << proposals.front().toml;
}

TEST(Proposals, parts_say_what_each_byte_holds) {
  const std::string line = "T 100 1 2 3 4\n";
  std::string text;
  for (int k = 0; k < 20; ++k) text += "T " + number(100 + 10 * static_cast<std::size_t>(k)) + " 1 2 3 4\n";
  const std::vector<Proposal> proposals = propose(bytes_of(text), {});
  ASSERT_FALSE(proposals.empty());
  ASSERT_GE(proposals.front().parts.size(), 5U);
  EXPECT_EQ(proposals.front().parts[0].role, layouts::Role::time);
  EXPECT_EQ(text.substr(proposals.front().parts[0].begin, 3), "100");
  EXPECT_EQ(proposals.front().parts[1].role, layouts::Role::values);
}

}  // namespace
}  // namespace dermis::bytes::proposals
