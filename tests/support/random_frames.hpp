// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "dermis/touch/frames/frame_sink.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::support {

/// Counts of random frames: what an ADC gives, or any bits of a float, infinities and NaNs among them.
enum class RandomCounts { whole, any_bits };

/// A frame in which each optional member has a value or none.
inline RawFrame random_frame(Random& random, std::size_t taxels, RandomCounts counts) {
  const auto signed_bits = [&] { return Nanos(static_cast<std::int64_t>(random.bits())); };
  const auto any_double = [&] { return std::bit_cast<double>(random.bits()); };
  RawFrame frame;
  frame.time = signed_bits();
  if (random.below(2) == 0) frame.temperature_celsius = random.below(2) == 0 ? random.uniform(-40, 80) : any_double();
  if (random.below(2) == 0) frame.supply_v = random.below(2) == 0 ? random.uniform(1, 5) : any_double();
  if (random.below(2) == 0) frame.acquisition.sequence = random.bits();
  if (random.below(2) == 0) frame.acquisition.device_time = signed_bits();
  frame.acquisition.arrival_steady = signed_bits();
  frame.acquisition.arrival_utc = signed_bits();
  frame.acquisition.lost_before = static_cast<std::uint32_t>(random.bits());
  frame.acquisition.held_taxels = static_cast<std::uint32_t>(random.bits());
  for (std::size_t i = 0; i < taxels; ++i) {
    frame.counts.push_back(counts == RandomCounts::whole
                               ? static_cast<float>(random.below(65536))
                               : std::bit_cast<float>(static_cast<std::uint32_t>(random.bits())));
  }
  return frame;
}

inline std::vector<RawFrame> random_frames(std::uint64_t seed, std::size_t count, std::size_t taxels,
                                           RandomCounts counts = RandomCounts::whole) {
  Random random(seed);
  std::vector<RawFrame> frames;
  for (std::size_t i = 0; i < count; ++i) frames.push_back(random_frame(random, taxels, counts));
  return frames;
}

inline bool have_same_bits(std::optional<double> a, std::optional<double> b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return std::bit_cast<std::uint64_t>(*a) == std::bit_cast<std::uint64_t>(*b);
}

/// Bit for bit, NaN too.
inline void expect_same_frame(const RawFrame& read, const RawFrame& written) {
  EXPECT_EQ(read.time, written.time);
  EXPECT_TRUE(have_same_bits(read.temperature_celsius, written.temperature_celsius));
  EXPECT_TRUE(have_same_bits(read.supply_v, written.supply_v));
  EXPECT_EQ(read.acquisition, written.acquisition);
  ASSERT_EQ(read.counts.size(), written.counts.size());
  for (std::size_t i = 0; i < read.counts.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(read.counts[i]), std::bit_cast<std::uint32_t>(written.counts[i])) << i;
  }
  ASSERT_EQ(read.sensor_celsius.size(), written.sensor_celsius.size());
  for (std::size_t i = 0; i < read.sensor_celsius.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(read.sensor_celsius[i]),
              std::bit_cast<std::uint32_t>(written.sensor_celsius[i]));
  }
}

inline Status write_all(FrameSink& sink, const std::vector<RawFrame>& frames) {
  for (const RawFrame& frame : frames) {
    if (Status written = sink.write(frame); !written) return written;
  }
  return sink.commit();
}

inline Result<std::vector<RawFrame>> read_all(FrameSource& source) {
  std::vector<RawFrame> frames;
  RawFrame frame;
  while (true) {
    const Result<bool> more = source.next(frame);
    if (!more) return more.error();
    if (!*more) return frames;
    frames.push_back(frame);
  }
}

inline void expect_same_frames(FrameSource& source, const std::vector<RawFrame>& written) {
  const Result<std::vector<RawFrame>> read = read_all(source);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    SCOPED_TRACE("frame " + std::to_string(i));
    expect_same_frame((*read)[i], written[i]);
    if (testing::Test::HasFailure()) return;
  }
}

}  // namespace dermis::support
