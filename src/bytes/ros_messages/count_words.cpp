// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/ros_messages/count_words.hpp"

#include <cmath>
#include <cstring>
#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bytes/ros_messages/count_words.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first: it includes this file again for every instruction set.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace dermis::bytes::ros_messages::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Converts the counts that fill whole vectors, as long as they are words, and returns how many. A conversion to 16
/// bits and back leaves all bits of a word.
std::size_t vectors_to_uint16([[maybe_unused]] const float* counts, [[maybe_unused]] std::size_t count,
                              [[maybe_unused]] std::uint8_t* out) {
  std::size_t i = 0;
#if HWY_TARGET != HWY_SCALAR
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> integers;
  const hn::Rebind<std::uint16_t, decltype(d)> words;
  const hn::Repartition<std::uint8_t, decltype(words)> bytes;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
    const auto given = hn::LoadU(d, counts + i);
    const auto number = hn::IfThenElseZero(hn::Eq(given, given), given);     // NaN becomes no integer
    const auto word = hn::DemoteTo(words, hn::ConvertTo(integers, number));  // both saturate
    const auto again = hn::ConvertTo(d, hn::PromoteTo(integers, word));
    if (!hn::AllTrue(integers, hn::Eq(hn::BitCast(integers, again), hn::BitCast(integers, given)))) break;
    hn::StoreU(hn::BitCast(bytes, word), bytes, out + 2 * i);
  }
#endif
  return i;
}

/// Converts the words that fill whole vectors; returns how many.
std::size_t vectors_from_uint16([[maybe_unused]] const std::uint8_t* in, [[maybe_unused]] std::size_t count,
                                [[maybe_unused]] float* counts) {
  std::size_t i = 0;
#if HWY_TARGET != HWY_SCALAR
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> integers;
  const hn::Rebind<std::uint16_t, decltype(d)> words;
  const hn::Repartition<std::uint8_t, decltype(words)> bytes;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
    const auto word = hn::BitCast(words, hn::LoadU(bytes, in + 2 * i));
    hn::StoreU(hn::ConvertTo(d, hn::PromoteTo(integers, word)), d, counts + i);
  }
#endif
  return i;
}

}  // namespace dermis::bytes::ros_messages::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dermis::bytes::ros_messages {

HWY_EXPORT(vectors_to_uint16);
HWY_EXPORT(vectors_from_uint16);

namespace {

std::optional<std::uint16_t> to_word(float count) {
  if (!(count >= 0.0F && count <= 65535.0F) || std::signbit(count)) return std::nullopt;
  const auto word = static_cast<std::uint16_t>(count);
  return static_cast<float>(word) == count ? std::optional(word) : std::nullopt;
}

}  // namespace

bool counts_to_uint16(const float* counts, std::size_t count, std::uint8_t* out) noexcept {
  for (std::size_t i = HWY_DYNAMIC_DISPATCH(vectors_to_uint16)(counts, count, out); i < count; ++i) {
    const std::optional<std::uint16_t> word = to_word(counts[i]);
    if (!word) return false;
    std::memcpy(out + 2 * i, &*word, sizeof(*word));
  }
  return true;
}

void uint16_to_counts(const std::uint8_t* bytes, std::size_t count, float* counts) noexcept {
  for (std::size_t i = HWY_DYNAMIC_DISPATCH(vectors_from_uint16)(bytes, count, counts); i < count; ++i) {
    std::uint16_t word = 0;
    std::memcpy(&word, bytes + 2 * i, sizeof(word));
    counts[i] = static_cast<float>(word);
  }
}

}  // namespace dermis::bytes::ros_messages
#endif
