// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/packet_fields.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "bytes/proposals/series.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kFewest = 5;  // packets, to tell a clock from chance
constexpr double kEarliest = 1e-3;  // of a clock, in any unit: smaller floats are other bytes
constexpr double kLatest = 1e19;

Series series_at(const Packets& packets, std::size_t at, std::size_t size, bool is_big_endian) {
  Series series;
  for (const Bytes& packet : packets.packets) {
    double value = 0.0;
    for (std::size_t k = 0; k < size; ++k) value = 256.0 * value + packet[at + (is_big_endian ? k : size - 1 - k)];
    series.push_back(value);
  }
  return series;
}

bool varies(const Packets& packets, std::size_t at) {
  return !is_constant(packets, at);
}

std::size_t changing_bytes(const Packets& packets, std::size_t at, std::size_t size) {
  std::size_t changing = 0;
  for (std::size_t k = at; k < at + size; ++k) changing += varies(packets, k) ? 1 : 0;
  return changing;
}

std::size_t zeros_before(const Packets& packets, std::size_t at) {
  std::size_t zeros = 0;
  while (zeros < at && packets.packets.front()[at - zeros - 1] == 0 && !varies(packets, at - zeros - 1)) ++zeros;
  return zeros;
}

/// The number at this place that has the most of the bytes that change, and no more, and goes on as `is_it` says.
template <typename Test>
std::optional<PacketField> growing_at(const Packets& packets, std::size_t at, std::size_t end, Test is_it) {
  std::optional<PacketField> best;
  std::size_t most = 0;
  const std::size_t left = 4 - zeros_before(packets, at) % 4;  // of a number whose high bytes have not changed yet
  for (const std::size_t size : {1U, 2U, 3U, 4U}) {
    const bool is_cut = at + 4 > end;  // by a mark in the middle of a clock
    if (at + size > end) break;
    const std::size_t changing = changing_bytes(packets, at, size);
    for (const char* order : {"le", "be"}) {
      const bool is_big_endian = order[0] == 'b';
      const bool has_odd_size = size == 3 && !is_cut && !(is_big_endian && left == 3);
      if (has_odd_size || (is_big_endian && size > left)) continue;
      const Series series = series_at(packets, at, size, is_big_endian);
      if (changing <= most || !is_it(series, std::pow(256.0, static_cast<double>(size)))) continue;
      best = PacketField{at, size, "frame", size == 1 ? "" : order};
      most = changing;
    }
  }
  return best;
}

/// Seconds or the like in a float of 64 bits.
std::optional<PacketField> float_clock_at(const Packets& packets, std::size_t at, std::size_t end) {
  constexpr std::size_t kSize = sizeof(double);
  if (at + kSize > end || packets.packets.size() < kFewest) return std::nullopt;
  for (const bool is_big_endian : {false, true}) {
    Series series;
    for (const Bytes& packet : packets.packets) {
      std::uint64_t bits = 0;
      for (std::size_t k = 0; k < kSize; ++k) bits = bits << 8U | packet[at + (is_big_endian ? k : kSize - 1 - k)];
      series.push_back(std::bit_cast<double>(bits));
    }
    const bool is_possible = std::ranges::all_of(series, [](double one) { return one >= 0.0 && one < kLatest; });
    if (!is_possible || series.back() < kEarliest || !is_time(series, 0.0)) continue;
    return PacketField{.at = at,
                       .size = kSize,
                       .field = time_field_of(series, 0.0),
                       .order = is_big_endian ? "be" : "le",
                       .kind = 'f'};
  }
  return std::nullopt;
}

/// A byte that counts through the same numbers, or is one of a few in turn.
std::optional<PacketField> in_turn_at(const Packets& packets, std::size_t at, bool may_have_gaps) {
  const Series series = series_at(packets, at, 1, false);
  PacketField field{at, 1, "array"};
  if (const std::optional<Cycle> cycle = cycle_of(series)) {
    if (cycle->count > 3) field.field = "row";
    for (std::size_t k = 0; k < cycle->count; ++k) field.numbers.push_back(cycle->first + k);
  } else if (may_have_gaps) {
    field.numbers = numbers_in_turn(series);
  }
  return field.numbers.empty() ? std::nullopt : std::optional(field);
}

std::optional<PacketField> field_at(const Packets& packets, std::size_t at, std::size_t end) {
  if (auto counter = growing_at(packets, at, end, is_frame_number)) {
    const auto clock = growing_at(packets, at, end, is_even_clock);
    const auto changing = [&](const PacketField& field) { return changing_bytes(packets, field.at, field.size); };
    if (!clock || changing(*clock) <= changing(*counter)) return counter;
  }
  if (auto turn = in_turn_at(packets, at, false)) return turn;
  if (auto clock = packets.packets.size() >= kFewest ? growing_at(packets, at, end, is_time) : std::nullopt) {
    const double modulus = std::pow(256.0, static_cast<double>(clock->size));
    clock->field = time_field_of(series_at(packets, at, clock->size, clock->order == "be"), modulus);
    if (clock->size > 1) return clock;
  }
  return in_turn_at(packets, at, true);
}

}  // namespace

std::vector<PacketField> fields_in(const Packets& packets, std::size_t begin, std::size_t end) {
  std::vector<PacketField> fields;
  for (std::size_t at = begin; at < end;) {
    std::optional<PacketField> field = float_clock_at(packets, at, end);
    if (!field && varies(packets, at)) field = field_at(packets, at, end);
    at += field ? field->size : 1;
    if (!field) continue;
    const auto is_same = [&](const PacketField& one) {
      return one.field == field->field || (one.field.starts_with("time") && field->field.starts_with("time"));
    };
    if (std::none_of(fields.begin(), fields.end(), is_same)) fields.push_back(*std::move(field));
  }
  return fields;
}

void widen(PacketField& field, const Packets& packets, std::size_t begin, std::size_t end) {
  if (field.field != "frame" && !field.field.starts_with("time")) return;
  const auto constant_zeros = [&](std::size_t from, std::size_t to) {
    for (std::size_t at = from; at < to; ++at) {
      if (!is_constant(packets, at) || packets.packets.front()[at] != 0) return false;
    }
    return true;
  };
  for (const std::size_t size : {4U, 2U}) {
    const std::size_t more = size > field.size ? size - field.size : 0;
    if (more == 0) continue;
    if (field.order != "be" && field.at + size <= end && constant_zeros(field.at + field.size, field.at + size)) {
      field.size = size;
      field.order = "le";
      return;
    }
    if (field.order != "le" && field.at >= begin + more && constant_zeros(field.at - more, field.at)) {
      field.at -= more;
      field.size = size;
      field.order = "be";
      return;
    }
  }
}

}  // namespace dermis::bytes::proposals
