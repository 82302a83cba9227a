// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/protocol.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"

namespace dermis::bytes::devices {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Facts of a protocol for the tests; one that is not in the table has the defaults, and the shape of its
/// devices.
struct Traits {
  FrameShape shape = {16, 32};
  std::uint64_t max_count = 200;  ///< Whole counts up to this are carried.
  bool has_checksum = false;
  std::size_t trailer = 0;  ///< Bytes of the separator that follows a frame.
  bool one_size = true;     ///< Frames have as many bytes each, whatever their readings.
};

Traits traits_of(const std::string& protocol) {
  static const std::map<std::string, Traits> kTraits = {
      {"3dvitac", {.shape = {16, 32}, .max_count = 65535, .trailer = 2, .one_size = false}},
      {"csv", {.shape = {16, 32}, .max_count = 65535, .trailer = 7, .one_size = false}},
      {"dermis", {.shape = {10, 7}, .max_count = 65535, .has_checksum = true}},
      {"flexitac", {.shape = {16, 32}, .max_count = 255}},
      {"json", {.shape = {10, 12}, .max_count = 65535, .one_size = false}},
      {"m1616", {.shape = {16, 16}, .max_count = 65535}},
      {"pressure-mat", {.shape = {56, 28}, .max_count = 255}},
      {"stag", {.shape = {32, 32}, .max_count = 4095}},
      {"tactileglove", {.shape = {1, 54}, .max_count = 4095}},
      {"wiresens", {.shape = {10, 12}, .max_count = 65535}},
      {"wuji", {.shape = {24, 32}, .max_count = 32767, .has_checksum = true}},
  };
  const auto found = kTraits.find(protocol);
  if (found != kTraits.end()) return found->second;
  return {.shape = make_decoder({.name = protocol}).value()->shape().value_or(FrameShape{16, 32})};
}

std::unique_ptr<Decoder> decoder_of(const std::string& protocol) {
  auto decoder = make_decoder({.name = protocol, .shape = traits_of(protocol).shape});
  if (!decoder) ADD_FAILURE() << decoder.error().message;
  return std::move(decoder).value();
}

std::unique_ptr<Encoder> encoder_of(const std::string& protocol) {
  auto encoder = make_encoder({.name = protocol, .shape = traits_of(protocol).shape});
  if (!encoder) ADD_FAILURE() << encoder.error().message;
  return std::move(encoder).value();
}

std::vector<RawFrame> random_frames(const std::string& protocol, std::size_t frame_count, Random& random) {
  const Traits traits = traits_of(protocol);
  std::vector<RawFrame> frames(frame_count);
  for (RawFrame& frame : frames) {
    frame.counts.resize(traits.shape.taxel_count());
    for (float& count : frame.counts) count = static_cast<float>(random.below(traits.max_count + 1));
  }
  return frames;
}

struct Encoded {
  Bytes bytes;
  std::vector<std::size_t> begins;  ///< Where each frame begins, and the end of the last one.
};

Encoded encode(const std::string& protocol, const std::vector<RawFrame>& frames) {
  Encoded encoded;
  const std::unique_ptr<Encoder> encoder = encoder_of(protocol);
  for (const RawFrame& frame : frames) {
    encoded.begins.push_back(encoded.bytes.size());
    encoder->encode(frame, encoded.bytes);
  }
  encoder->finish(encoded.bytes);
  encoded.begins.push_back(encoded.bytes.size());
  return encoded;
}

struct Decoded {
  std::vector<RawFrame> frames;
  std::vector<std::uint64_t> ends;
  DecoderCounts counts;
};

void take_frames(Decoder& decoder, Decoded& decoded) {
  RawFrame frame;
  while (decoder.next(frame)) {
    EXPECT_EQ(decoder.shape()->taxel_count(), frame.counts.size());
    decoded.frames.push_back(frame);
    decoded.ends.push_back(decoder.frame_end());
  }
  decoded.counts = decoder.counts();
}

/// `piece` is asked for the size of each piece.
template <typename Piece>
Decoded decode(Decoder& decoder, std::span<const std::uint8_t> bytes, Piece piece) {
  Decoded decoded;
  while (!bytes.empty()) {
    const std::size_t size = std::min<std::size_t>(bytes.size(), piece());
    decoder.push(bytes.first(size));
    bytes = bytes.subspan(size);
    take_frames(decoder, decoded);
  }
  decoder.finish();
  take_frames(decoder, decoded);
  return decoded;
}

Decoded decode(const std::string& protocol, std::span<const std::uint8_t> bytes) {
  return decode(*decoder_of(protocol), bytes, [] { return Decoder::kMaxPush; });
}

void expect_same_counts(const std::vector<RawFrame>& frames, const std::vector<RawFrame>& expected) {
  ASSERT_EQ(frames.size(), expected.size());
  for (std::size_t k = 0; k < frames.size(); ++k) ASSERT_EQ(frames[k].counts, expected[k].counts) << "frame " << k;
}

/// Which of `frames` has these counts; random ones are all different.
std::optional<std::size_t> number_of(const RawFrame& frame, const std::vector<RawFrame>& frames) {
  const auto found =
      std::find_if(frames.begin(), frames.end(), [&](const auto& f) { return f.counts == frame.counts; });
  return found == frames.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - frames.begin()));
}

struct Damaged {
  Bytes bytes;
  std::size_t damages = 0;
  std::vector<bool> is_whole;  ///< Per frame: its bytes are all there, unchanged and together.
};

/// Drops, inserts or flips one byte in `mean_distance`.
Damaged damage(const Encoded& encoded, std::uint64_t mean_distance, Random& random) {
  Damaged damaged;
  damaged.is_whole.assign(encoded.begins.size() - 1, true);
  std::size_t frame = 0;
  for (std::size_t at = 0; at < encoded.bytes.size(); ++at) {
    while (at >= encoded.begins[frame + 1]) ++frame;
    const std::uint8_t byte = encoded.bytes[at];
    if (random.below(mean_distance) != 0) {
      damaged.bytes.push_back(byte);
      continue;
    }
    ++damaged.damages;
    damaged.is_whole[frame] = false;
    const std::uint64_t kind = random.below(3);
    if (kind == 0) continue;
    if (kind == 1) {
      damaged.bytes.push_back(byte ^ static_cast<std::uint8_t>(1U << random.below(8)));
    } else {  // between two frames it is in neither, but a stream without marks between them cannot tell
      if (at == encoded.begins[frame] && frame > 0) damaged.is_whole[frame - 1] = false;
      damaged.bytes.push_back(static_cast<std::uint8_t>(random.below(256)));
      damaged.bytes.push_back(byte);
    }
  }
  return damaged;
}

class EveryProtocol : public testing::TestWithParam<std::string> {};

std::vector<std::string> all_but_auto() {
  std::vector<std::string> names = protocol_names();
  std::erase(names, "auto");
  return names;
}

INSTANTIATE_TEST_SUITE_P(Protocol, EveryProtocol, testing::ValuesIn(all_but_auto()), [](const auto& name) {
  std::string identifier = name.param;
  std::replace(identifier.begin(), identifier.end(), '-', '_');
  return "protocol_" + identifier;
});

TEST_P(EveryProtocol, delivers_the_frames_that_were_encoded) {
  Random random(1);
  const std::vector<RawFrame> frames = random_frames(GetParam(), 40, random);
  const Encoded encoded = encode(GetParam(), frames);
  const Decoded decoded = decode(GetParam(), encoded.bytes);
  expect_same_counts(decoded.frames, frames);
  EXPECT_EQ(decoded.counts, (DecoderCounts{.frames = 40}));
  for (std::size_t k = 0; k < decoded.ends.size(); ++k) {
    EXPECT_EQ(decoded.ends[k] + traits_of(GetParam()).trailer, encoded.begins[k + 1]);
  }
}

TEST_P(EveryProtocol, delivers_the_same_however_the_bytes_are_cut) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Encoded encoded = encode(GetParam(), random_frames(GetParam(), 30, random));
    const Bytes bytes = damage(encoded, 3000, random).bytes;
    const Decoded whole = decode(GetParam(), bytes);
    const Decoded single = decode(*decoder_of(GetParam()), bytes, [] { return 1U; });
    const Decoded pieces = decode(*decoder_of(GetParam()), bytes, [&] { return 1 + random.below(2000); });
    for (const Decoded& other : {single, pieces}) {
      expect_same_counts(other.frames, whole.frames);
      EXPECT_EQ(other.ends, whole.ends);
      EXPECT_EQ(other.counts, whole.counts);
      for (std::size_t k = 0; k < std::min(other.frames.size(), whole.frames.size()); ++k) {
        EXPECT_EQ(other.frames[k].acquisition, whole.frames[k].acquisition);
      }
    }
  }
}

TEST_P(EveryProtocol, counts_every_byte_once) {
  if (!traits_of(GetParam()).one_size) GTEST_SKIP() << "the size of a changed frame is not known";
  Random random(4);
  const std::vector<RawFrame> frames = random_frames(GetParam(), 30, random);
  const Encoded encoded = encode(GetParam(), frames);
  const Bytes bytes = damage(encoded, 3000, random).bytes;
  const Decoded decoded = decode(GetParam(), bytes);
  std::uint64_t of_frames = 0;
  for (const RawFrame& frame : decoded.frames) {
    // One that was changed has the size of all frames: protocols without a checksum have but one.
    const std::size_t k = number_of(frame, frames).value_or(0);
    of_frames += encoded.begins[k + 1] - encoded.begins[k];
  }
  EXPECT_EQ(of_frames + decoded.counts.skipped_bytes, bytes.size());
}

TEST_P(EveryProtocol, finds_the_frames_behind_other_bytes) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const std::vector<RawFrame> frames = random_frames(GetParam(), 20, random);
    const Encoded encoded = encode(GetParam(), frames);
    Bytes bytes(random.below(3000));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.below(256));
    bytes.insert(bytes.end(), encoded.bytes.begin(), encoded.bytes.end());
    const Decoded decoded = decode(GetParam(), bytes);
    ASSERT_GE(decoded.frames.size(), 18U);
    expect_same_counts({decoded.frames.end() - 18, decoded.frames.end()}, {frames.end() - 18, frames.end()});
    EXPECT_LE(decoded.frames.size(), traits_of(GetParam()).has_checksum ? 20U : 21U);
  }
}

TEST_P(EveryProtocol, delivers_undamaged_frames_but_for_two_a_damage) {
  const Traits traits = traits_of(GetParam());
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const std::vector<RawFrame> frames = random_frames(GetParam(), 200, random);
    const Damaged damaged = damage(encode(GetParam(), frames), 10000, random);
    const Decoded decoded = decode(GetParam(), damaged.bytes);
    std::vector<bool> is_delivered(frames.size());
    std::size_t changed = 0;
    for (const RawFrame& frame : decoded.frames) {
      const std::optional<std::size_t> k = number_of(frame, frames);
      changed += k ? 0 : 1;
      if (k) is_delivered[*k] = true;
    }
    std::size_t missing = 0;
    std::size_t in_a_row = 0;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const bool is_missing = damaged.is_whole[k] && !is_delivered[k];
      missing += is_missing ? 1 : 0;
      in_a_row = is_delivered[k] ? 0 : in_a_row + (is_missing ? 1 : 0);
      EXPECT_LE(in_a_row, 2U) << "frame " << k;
    }
    EXPECT_LE(missing, 2 * damaged.damages);
    EXPECT_LE(changed, traits.has_checksum ? 0 : damaged.damages);
    EXPECT_EQ(decoded.counts.frames, decoded.frames.size());
  }
}

TEST_P(EveryProtocol, allocates_nothing_after_the_first_frame) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
  Random random(6);
  const Encoded encoded = encode(GetParam(), random_frames(GetParam(), 60, random));
  const Bytes bytes = damage(encoded, 20000, random).bytes;
  const std::unique_ptr<Decoder> decoder = decoder_of(GetParam());
  RawFrame frame;
  std::size_t allocations = 0;
  bool has_begun = false;
  for (std::size_t at = 0; at < bytes.size(); at += 512) {
    const support::AllocationGuard guard;
    decoder->push(std::span(bytes).subspan(at, std::min<std::size_t>(512, bytes.size() - at)));
    bool got_frame = false;
    while (decoder->next(frame)) got_frame = true;
    if (has_begun) allocations += guard.count();
    has_begun = has_begun || got_frame;
  }
  EXPECT_GT(decoder->counts().frames, 30U);
  EXPECT_EQ(allocations, 0U);
}

TEST_P(EveryProtocol, drops_a_frame_that_is_cut_and_goes_on) {
  Random random(7);
  const std::vector<RawFrame> frames = random_frames(GetParam(), 30, random);
  const Encoded encoded = encode(GetParam(), frames);
  const std::size_t half = (encoded.begins[10] + encoded.begins[11]) / 2;
  const std::unique_ptr<Decoder> decoder = decoder_of(GetParam());
  const auto piece = [] { return Decoder::kMaxPush; };
  const Decoded before = decode(*decoder, std::span(encoded.bytes).first(half), piece);
  expect_same_counts(before.frames, {frames.begin(), frames.begin() + 10});
  EXPECT_EQ(before.counts.skipped_bytes, half - encoded.begins[10]);
  const auto small_piece = [&random] { return 1 + random.below(8); };  // shorter than what was cut
  const Decoded after = decode(*decoder, std::span(encoded.bytes).subspan(encoded.begins[15]), small_piece);
  expect_same_counts(after.frames, {frames.begin() + 15, frames.end()});
}

TEST(Protocol, names_what_may_have_been_meant) {
  const auto decoder = make_decoder({.name = "flexitack"});
  ASSERT_FALSE(decoder);
  EXPECT_EQ(decoder.error().message, "protocol=flexitack: is not known; did you mean 'flexitac'?");
  const auto other = make_decoder({.name = "morse"});
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("known are "), std::string::npos);
}

TEST(Protocol, refuses_shapes_that_cannot_be) {
  EXPECT_FALSE(make_decoder({.name = "dermis", .shape = FrameShape{0, 4}}));
  EXPECT_FALSE(make_decoder({.name = "flexitac", .shape = FrameShape{4, 1025}}));
  const auto decoder = make_decoder({.name = "m1616", .shape = FrameShape{8, 16}});
  ASSERT_FALSE(decoder);
  EXPECT_EQ(decoder.error().message, "rows=8&cols=16: protocol=m1616 has rows=16&cols=16");
}

TEST(Protocol, sends_only_what_is_named_and_shaped) {
  EXPECT_FALSE(make_encoder({.name = "auto", .shape = FrameShape{4, 4}}));
  EXPECT_FALSE(make_encoder({.name = "dermis"}));
}

TEST(Protocol, ends_its_names_with_auto) {
  EXPECT_EQ(protocol_names().back(), "auto");
}

}  // namespace
}  // namespace dermis::bytes::devices
