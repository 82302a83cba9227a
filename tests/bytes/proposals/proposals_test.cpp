// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/proposals/proposals.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
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
      {"two indices in brackets",
       [](const Frame& f, std::size_t) {
         return in_taxels(f, [](std::size_t r, std::size_t c, int v) {
           return "V[" + number(r) + "][" + number(c) + "]: " + std::to_string(v) + "mV\n";
         });
       }},
      {"a table with lines",
       [](const Frame& f, std::size_t) {
         return "+----+----+\n" +
                in_rows(f, [](std::size_t, const Frame& row) { return "|" + joined(row, "|", "%5d") + "|\n"; });
       }},
      {"a date with a zone",
       [](const Frame& f, std::size_t k) {
         return "2026-11-29T10:15:" + number(10 + k) + ".250+02:00\t" + joined(f, "\t", "%d.0e0") + "\n";
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
      {"a number and the time at the end",
       [](const Frame& f, std::size_t k) {
         return joined(f, ",") + "," + number(17 + k) + "," + number(90500 + 10 * k + k % 3) + "\n";
       }},
      {"a time of two parts",
       [](const Frame& f, std::size_t k) {
         return "{\"stamp\": {\"sec\": " + number(1779865838 + k / 20) +
                ", \"nanosec\": " + number(50000000 * (k % 20)) + "}, \"data\": [" + joined(f, ", ") + "]}\n";
       }},
      {"one number a line behind a mark",
       [](const Frame& f, std::size_t) { return "1028\n" + joined(f, "\n") + "\n"; }},
      {"one number a line behind a word",
       [](const Frame& f, std::size_t) { return "begin\n" + joined(f, "\r\n") + "\r\n"; }},
      {"one number a line", [](const Frame& f, std::size_t) { return joined(f, "\n") + "\n"; }},
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

/// The first proposal of what a frame is printed as, where rows and columns are given.
Proposal first_of(const std::vector<Frame>& frames, const FrameShape& shape,
                  const std::function<Bytes(const Frame&, std::size_t)>& send) {
  Bytes bytes;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Bytes packet = send(frames[k], k);
    bytes.insert(bytes.end(), packet.begin(), packet.end());
  }
  const std::vector<Proposal> proposals = propose(bytes, {.rows = shape.rows, .cols = shape.cols});
  EXPECT_FALSE(proposals.empty());
  if (proposals.empty()) return {};
  EXPECT_EQ(frames_of(proposals.front().toml, bytes), frames) << proposals.front().toml;
  return proposals.front();
}

bool has_doubt(const Proposal& proposal, const std::string& words) {
  return std::ranges::any_of(proposal.doubts,
                             [&](const std::string& doubt) { return doubt.find(words) != std::string::npos; });
}

TEST(Proposals, packets_may_only_end_in_a_mark) {
  std::vector<Frame> frames = test::pressed_frames(kShape, 250.0);
  for (Frame& frame : frames) std::ranges::transform(frame, frame.begin(), [](int v) { return std::min(v, 254); });
  const Proposal proposal = first_of(frames, kShape, [](const Frame& f, std::size_t) {
    Bytes bytes;
    test::add_readings(bytes, f, 1);
    bytes.push_back(0xFF);
    return bytes;
  });
  EXPECT_NE(proposal.toml.find("packet = [\"values u8\", \"FF\"]"), std::string::npos) << proposal.toml;
}

TEST(Proposals, packets_may_come_in_runs_beyond_the_array) {
  const FrameShape shape{5, 5};
  std::vector<Frame> frames = test::pressed_frames(shape, 1500.0);
  for (Frame& frame : frames) std::ranges::transform(frame, frame.begin(), [](int v) { return v + 1300; });
  for (const int factor : {1, 8}) {
    const Proposal proposal = first_of(frames, shape, [&](const Frame& f, std::size_t) {
      Bytes bytes;
      Frame channels = f;
      channels.resize(32);
      for (int first = 0; first < 32; first += 8) {
        bytes.insert(bytes.end(), {0x24, static_cast<std::uint8_t>(first / factor)});
        test::add_readings(bytes, {channels.begin() + first, channels.begin() + first + 8}, 2, true);
        bytes.push_back(0xFF);
      }
      return bytes;
    });
    EXPECT_NE(proposal.toml.find(factor == 1 ? "\"first u8\"" : "\"first u8 *8\""), std::string::npos) << proposal.toml;
  }
}

TEST(Proposals, parts_may_overlap) {
  const FrameShape shape{5, 8};
  const Proposal proposal = first_of(test::pressed_frames(shape), shape, [](const Frame& f, std::size_t) {
    Bytes bytes;
    for (const int first : {0, 12, 24}) {
      bytes.insert(bytes.end(), {0xAB, 0xCD, static_cast<std::uint8_t>(first)});
      test::add_readings(bytes, {f.begin() + first, f.begin() + first + 16});
    }
    return bytes;
  });
  EXPECT_NE(proposal.toml.find("\"first u8\", \"values u16le x16\""), std::string::npos) << proposal.toml;
}

TEST(Proposals, rows_are_found_where_readings_look_like_the_mark) {
  const FrameShape shape{6, 5};
  const std::vector<Frame> frames = test::pressed_frames(shape, 2500.0);
  Bytes bytes;
  for (const Frame& f : frames) {
    for (std::size_t row = 0; row < shape.rows; ++row) {
      Bytes packet = {0xAA, static_cast<std::uint8_t>(row)};
      test::add_readings(packet, row_of(f, row, shape.cols), 2, true);
      packet.push_back(static_cast<std::uint8_t>(std::accumulate(packet.begin(), packet.end(), 0)));
      bytes.insert(bytes.end(), packet.begin(), packet.end());
    }
  }
  for (const Known& known : {Known{}, Known{.rows = 6, .cols = 5}}) {
    const std::vector<Proposal> proposals = propose(bytes, known);
    ASSERT_FALSE(proposals.empty());
    EXPECT_EQ(frames_of(proposals.front().toml, bytes), frames) << proposals.front().toml;
  }
}

TEST(Proposals, readings_beside_a_counter_are_no_part_of_it) {
  std::vector<Frame> frames = test::pressed_frames(kShape, 900.0);
  const Proposal behind = first_of(frames, kShape, [](const Frame& f, std::size_t k) {
    Bytes bytes = {0xFE, 0x43};
    test::add_readings(bytes, f);
    bytes.push_back(static_cast<std::uint8_t>(k));
    return bytes;
  });
  EXPECT_NE(behind.toml.find("\"frame u8\""), std::string::npos) << behind.toml;
  const Proposal before = first_of(frames, kShape, [](const Frame& f, std::size_t k) {
    Bytes bytes = {0xA5, 0x5A};
    test::add_number(bytes, 10 * k, 4, true);
    test::add_packed(bytes, f, 12);
    return bytes;
  });
  EXPECT_NE(before.toml.find("\"time_ms u32be\", \"values u12be\""), std::string::npos) << before.toml;
}

TEST(Proposals, clocks_that_jitter_end_before_the_readings) {
  for (const bool is_big : {false, true}) {
    for (const std::size_t step : {10'000U, 16'777U, 66'000U}) {
      const Proposal proposal = first_of(test::pressed_frames(kShape), kShape, [&](const Frame& f, std::size_t k) {
        Bytes bytes = {0xAA, 0xBB};
        test::add_number(bytes, 123'456 + step * k + 151 * k % 97, 4, is_big);
        test::add_readings(bytes, f, 2, is_big);
        return bytes;
      });
      EXPECT_NE(proposal.toml.find(is_big ? "\"time_us u32be\"" : "\"time_us u32le\""), std::string::npos)
          << proposal.toml;
    }
  }
}

TEST(Proposals, a_counter_before_bytes_that_stay_is_no_clock) {
  const Proposal proposal = first_of(test::pressed_frames(kShape), kShape, [](const Frame& f, std::size_t k) {
    Bytes bytes = {0x01, 0xC3};
    test::add_number(bytes, 20 * k, 4);
    test::add_number(bytes, k, 2);
    test::add_readings(bytes, f);
    return bytes;
  });
  EXPECT_NE(proposal.toml.find("\"time_ms u32le\", \"frame u16le\""), std::string::npos) << proposal.toml;
}

TEST(Proposals, floats_of_64_bits_are_readings_and_clocks) {
  const Proposal proposal = first_of(test::pressed_frames(kShape), kShape, [](const Frame& f, std::size_t k) {
    Bytes bytes = {'T', 'A', 'C', 'T'};
    test::add_number(bytes, std::bit_cast<std::uint64_t>(100.0 + 0.02 * static_cast<double>(k)), 8);
    for (const int value : f) test::add_number(bytes, std::bit_cast<std::uint64_t>(static_cast<double>(value)), 8);
    return bytes;
  });
  EXPECT_NE(proposal.toml.find("\"time_s f64le\", \"values f64le\""), std::string::npos) << proposal.toml;
}

TEST(Proposals, upper_bytes_of_small_numbers_with_a_sign_are_no_readings) {
  std::vector<Frame> frames = test::pressed_frames(kShape, 600.0);
  for (Frame& frame : frames) std::ranges::transform(frame, frame.begin(), [](int v) { return v - 40; });
  const Proposal proposal = first_of(frames, kShape, [](const Frame& f, std::size_t) {
    Bytes bytes = {0x24, 0x25};
    test::add_readings(bytes, f, 2, true);
    return bytes;
  });
  EXPECT_NE(proposal.toml.find("\"values i16be\""), std::string::npos) << proposal.toml;
}

TEST(Proposals, the_number_of_a_reading_may_stand_above_it) {
  const FrameShape shape{4, 4};
  const Proposal proposal = first_of(test::pressed_frames(shape, 3000.0), shape, [](const Frame& f, std::size_t) {
    Bytes bytes = {0xF1, 0xF2};
    for (std::size_t k = 0; k < f.size(); ++k) test::add_number(bytes, k << 12U | static_cast<unsigned>(f[k]), 2, true);
    return bytes;
  });
  EXPECT_NE(proposal.toml.find("mask=0FFF"), std::string::npos) << proposal.toml;
}

TEST(Proposals, readings_of_seven_bits_a_byte_are_doubted) {
  Bytes bytes;
  for (const Frame& frame : test::pressed_frames(kShape, 3000.0)) {
    bytes.push_back(0xFF);
    for (const int value : frame) {
      bytes.insert(bytes.end(), {static_cast<std::uint8_t>(value >> 7), static_cast<std::uint8_t>(value & 0x7F)});
    }
  }
  const std::vector<Proposal> proposals = propose(bytes, {.rows = kShape.rows, .cols = kShape.cols});
  ASSERT_FALSE(proposals.empty());
  EXPECT_TRUE(has_doubt(proposals.front(), "7 bits each")) << proposals.front().toml;
}

TEST(Proposals, bytes_that_nothing_explains_are_doubted) {
  Bytes bytes;
  std::size_t k = 0;
  for (const Frame& frame : test::pressed_frames(kShape, 900.0)) {
    bytes.insert(bytes.end(), {0xFA, 0xF5});
    test::add_readings(bytes, frame);
    for (const std::size_t factor : {37U, 53U}) test::add_number(bytes, factor * k * k % 400, 2);
    bytes.push_back(0x0A);
    ++k;
  }
  const std::vector<Proposal> proposals = propose(bytes, {.rows = kShape.rows, .cols = kShape.cols});
  ASSERT_FALSE(proposals.empty());
  EXPECT_TRUE(has_doubt(proposals.front(), "nothing explains them")) << proposals.front().toml;
}

TEST(Proposals, volts_may_stand_in_brackets_behind_each_reading) {
  const Proposal proposal = first_of(test::pressed_frames(kShape), kShape, [](const Frame& f, std::size_t k) {
    std::string line = number(k) + ".5s";
    for (const int value : f) {
      line += " | ";
      line += std::to_string(value) + " (" + std::to_string(value / 200) + ".25 V)";
    }
    return bytes_of(line + "\n");
  });
  EXPECT_TRUE(has_doubt(proposal, "the readings may also be")) << proposal.toml;
}

TEST(Proposals, a_mark_behind_the_readings_is_none_of_them) {
  const FrameShape shape{8, 8};
  const auto between_marks = [](const Frame& f, std::size_t) {
    Bytes bytes = {0xAA, 0x55, 0x03, 0x99};
    test::add_readings(bytes, f);
    bytes.insert(bytes.end(), {0x55, 0xAA});
    return bytes;
  };
  const Proposal proposal = first_of(test::pressed_frames(shape), shape, between_marks);
  EXPECT_NE(proposal.toml.find("\"values u16le\", \"55 AA\""), std::string::npos) << proposal.toml;
}

TEST(Proposals, a_clock_may_be_cut_by_what_seems_a_mark) {
  const FrameShape shape{6, 6};
  Bytes bytes;
  const std::vector<Frame> frames = test::pressed_frames(shape);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    test::add_number(bytes, 1764512345000000U + 20000 * k, 8);
    test::add_readings(bytes, frames[k]);
  }
  const std::vector<Proposal> proposals = propose(bytes, {.rows = 6, .cols = 6});
  ASSERT_FALSE(proposals.empty());
  std::vector<Frame> found = frames_of(proposals.front().toml, bytes);
  EXPECT_EQ(found.size() + 1, frames.size()) << proposals.front().toml;
  EXPECT_TRUE(std::ranges::equal(found, std::span(frames).first(found.size()))) << proposals.front().toml;
}

TEST(Proposals, decimal_readings_before_a_checksum_of_hexadecimal_digits_stay_decimal) {
  for (const std::string mark : {"0x", ""}) {
    const Proposal proposal = first_of(test::pressed_frames(kShape), kShape, [&](const Frame& f, std::size_t k) {
      char checksum[8];
      std::snprintf(checksum, sizeof checksum, "%02X", static_cast<unsigned>(97 * k % 256));
      return bytes_of(number(50 * k) + "\t" + joined(f, "\t") + (mark.empty() ? "*" : "\t") + mark + checksum + "\n");
    });
    EXPECT_NE(proposal.toml.find("{time_ms}"), std::string::npos) << proposal.toml;
  }
}

TEST(Proposals, zeros_may_stand_before_a_frame_that_nothing_marks) {
  std::vector<Frame> frames = test::pressed_frames(kShape, 250.0);
  for (Frame& frame : frames) std::ranges::transform(frame, frame.begin(), [](int v) { return std::clamp(v, 1, 255); });
  first_of(frames, kShape, [](const Frame& f, std::size_t) {
    Bytes bytes = {0, 0};
    test::add_readings(bytes, f, 1);
    return bytes;
  });
}

TEST(Proposals, a_line_before_rows_tells_their_time) {
  const Proposal proposal = first_of(test::pressed_frames(kShape), kShape, [](const Frame& f, std::size_t k) {
    return bytes_of(
        "--- frame " + number(k) + " (" + number(33 * k) + " ms) ---\n" +
        in_rows(f, [](std::size_t r, const Frame& row) { return "R" + number(r) + ": " + joined(row, " ") + "\n"; }) +
        "\n");
  });
  EXPECT_NE(proposal.toml.find(R"("--- frame {frame} ({time_ms} ms) ---", "R{row}: {values}")"), std::string::npos)
      << proposal.toml;
}

TEST(Proposals, halves_of_readings_in_digits_are_doubted) {
  std::string spaced;
  std::string packed;
  for (const Frame& frame : test::pressed_frames(kShape, 3000.0)) {
    for (const int value : frame) {
      char text[16];
      std::snprintf(text, sizeof text, "%02X %02X ", value & 255, value >> 8);
      spaced += text;
      std::snprintf(text, sizeof text, "%03X", value);
      packed += text;
    }
    spaced += "\n";
    packed += "A5\n";
  }
  EXPECT_TRUE(has_doubt(propose(bytes_of(spaced), {}).at(0), "every second byte is small"));
  EXPECT_TRUE(has_doubt(propose(bytes_of(packed), {}).at(0), "nothing stands between the numbers"));
}

TEST(Proposals, a_frame_without_a_mark_is_proposed_with_its_doubt) {
  const std::vector<Frame> frames = test::pressed_frames(kShape, 3000.0);
  for (const bool is_big : {false, true}) {
    const Proposal proposal = first_of(frames, kShape, [&](const Frame& f, std::size_t) {
      Bytes bytes;
      test::add_readings(bytes, f, 2, is_big);
      return bytes;
    });
    EXPECT_TRUE(has_doubt(proposal, "nothing marks where a frame begins")) << proposal.toml;
  }
  const Proposal numbers =
      first_of(frames, kShape, [](const Frame& f, std::size_t) { return bytes_of(joined(f, "\n") + "\n"); });
  EXPECT_TRUE(has_doubt(numbers, "nothing marks where a frame begins")) << numbers.toml;
  const Proposal rows = first_of(frames, kShape, [](const Frame& f, std::size_t) {
    return bytes_of(in_rows(f, [](std::size_t, const Frame& row) { return joined(row, " ") + "\n"; }));
  });
  EXPECT_TRUE(has_doubt(rows, "nothing marks where a frame begins")) << rows.toml;
}

TEST(Proposals, readings_may_stand_behind_labels) {
  const FrameShape shape{1, 6};
  const std::vector<Frame> frames = test::pressed_frames(shape);
  const std::vector<std::string> places = {"heel", "toe", "ball", "arch", "outer", "inner"};
  const auto print = [&](const Frame& frame, const std::function<std::string(std::size_t, int)>& one) {
    std::string text;
    for (std::size_t i = 0; i < frame.size(); ++i) text += (i > 0 ? ", " : "") + one(i, frame[i]);
    return text;
  };
  const Proposal objects = first_of(frames, shape, [&](const Frame& f, std::size_t k) {
    return bytes_of("{\"t\": " + number(20 * k) + ", \"sensors\": [" +
                    print(f,
                          [&](std::size_t i, int v) {
                            return "{\"label\": \"" + places[i] + "\", \"volt\": " + std::to_string(v * 0.0032) +
                                   ", \"adc\": " + std::to_string(v) + "}";
                          }) +
                    "]}\n");
  });
  EXPECT_TRUE(has_doubt(objects, "'volt'")) << objects.toml;
  (void)first_of(frames, shape, [&](const Frame& f, std::size_t) {
    return bytes_of(print(f, [&](std::size_t i, int v) { return places[i] + ":" + std::to_string(v); }) + "\n");
  });
  (void)first_of(frames, shape, [&](const Frame& f, std::size_t) {
    return bytes_of(print(f, [&](std::size_t i, int v) { return "A" + number(i) + ": " + std::to_string(v); }) + "\n");
  });
}

TEST(Proposals, labels_that_count_leave_the_shape_open) {
  std::string text;
  for (const Frame& frame : test::pressed_frames(kShape)) {
    for (std::size_t k = 0; k < frame.size(); ++k) text += " S" + number(k) + "=" + std::to_string(frame[k]);
    text += "\n";
  }
  const std::vector<Proposal> proposals = propose(bytes_of(text), {});
  ASSERT_FALSE(proposals.empty());
  EXPECT_EQ(proposals.front().shape, kShape) << proposals.front().toml;
  EXPECT_EQ(proposals.front().open, (std::vector<std::string>{"rows", "cols"}));
}

TEST(Proposals, two_readings_a_line_are_an_array) {
  std::string text;
  for (const Frame& frame : test::pressed_frames({1, 2})) text += joined(frame, ",") + "\n";
  const std::vector<Proposal> proposals = propose(bytes_of(text), {});
  ASSERT_FALSE(proposals.empty());
  EXPECT_EQ(proposals.front().shape, (FrameShape{1, 2}));
}

TEST(Proposals, a_document_of_json_is_no_lines) {
  const std::vector<Frame> frames = test::pressed_frames(kShape);
  for (const bool is_broken : {false, true}) {
    const std::string end = is_broken ? "\n    " : " ";
    std::string objects = "{\"rate\": 50," + end + "\"frames\": [";
    std::string lists = "[";
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const char* const separator = k > 0 ? "," : "";
      const std::string list = fmt::format("[{0}{1}{0}]", end, joined(frames[k], "," + end));
      objects += fmt::format("{0}{1}{{{1}\"t\": {2},{1}\"data\": {3}{1}}}", separator, end, 20 * k, list);
      lists += fmt::format("{}{}{}", separator, end, list);
    }
    for (const std::string& text : {objects + end + "]}\n", lists + end + "]\n"}) {
      const std::vector<Proposal> proposals = propose(bytes_of(text), {.rows = kShape.rows, .cols = kShape.cols});
      ASSERT_FALSE(proposals.empty()) << text.substr(0, 200);
      EXPECT_EQ(frames_of(proposals.front().toml, bytes_of(text)), frames) << proposals.front().toml;
    }
  }
}

TEST(Proposals, sensors_of_motion_are_no_taxels) {
  const FrameShape shape{4, 4};
  const std::vector<Frame> frames = test::pressed_frames(shape);
  for (const bool has_head : {true, false}) {
    std::string text = has_head ? "time_ms" : "";
    for (std::size_t i = 0; has_head && i < 12; ++i)
      text += std::string(",imu") + number(i / 6 + 1) + "_" + (i % 6 < 3 ? "acc" : "gyro") + "_" + "xyz"[i % 3];
    for (std::size_t i = 0; has_head && i < 16; ++i) text += ",s" + number(i);
    text += has_head ? "\n" : "";
    for (std::size_t k = 0; k < frames.size(); ++k) {
      text += number(1000 + 10 * k);
      for (std::size_t i = 0; i < 12; ++i)
        text += "," + std::to_string(std::sin(static_cast<double>(k * (i + 1)) / 5.0) - 0.1);
      text += "," + joined(frames[k], ",") + "\n";
    }
    const std::vector<Proposal> proposals = propose(bytes_of(text), {});
    ASSERT_FALSE(proposals.empty());
    EXPECT_EQ(frames_of(proposals.front().toml, bytes_of(text)), frames) << proposals.front().toml;
  }
}

TEST(Proposals, layouts_that_fit_alike_are_told_apart) {
  std::string text;
  for (const Frame& frame : test::pressed_frames({3, 4}, 0.0)) text += joined(frame, ",") + "\n";
  const std::vector<Proposal> proposals = propose(bytes_of(text), {});
  ASSERT_GE(proposals.size(), 2U);
  EXPECT_TRUE(has_doubt(proposals.front(), "layout 2 fits as well: press a corner"));
}

TEST(Proposals, what_the_device_was_sent_goes_into_the_layout) {
  std::string text;
  for (const Frame& frame : test::pressed_frames(kShape)) text += joined(frame, ",") + "\n";
  const std::vector<Proposal> proposals = propose(bytes_of(text), {.request = "[0xAA, 0x01]"});
  ASSERT_FALSE(proposals.empty());
  EXPECT_NE(proposals.front().toml.find("\nrequest = [0xAA, 0x01]\n"), std::string::npos);
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

TEST(Proposals, fractions_that_never_change_are_no_readings) {
  std::string place;
  std::string volts;
  for (int line = 0; line < 40; ++line) {
    place += "$GPGGA,123519,4807.038,N,01131.000,E,1,08\r\n";
    volts += line == 30 ? "0.12,0.00,0.00,0.00\r\n" : "0.00,0.00,0.00,0.00\r\n";
  }
  EXPECT_TRUE(propose(bytes_of(place), {}).empty());
  EXPECT_FALSE(propose(bytes_of(volts), {}).empty());
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
