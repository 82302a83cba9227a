// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/layouts/packet_match.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "bytes/layouts/has_role.hpp"

namespace dermis::bytes::layouts {
namespace {

constexpr double kMostNanos = 9e18;

std::uint64_t range_of(const PacketField& field) {
  return field.type.bits < 64 && field.type.kind == WireType::Kind::whole ? std::uint64_t{1} << field.type.bits : 0;
}

/// The bits at place `index`, read from the first byte on: of a big-endian type the highest bit comes first.
std::uint64_t bits_at(std::span<const std::uint8_t> bytes, const WireType& type, std::size_t index) noexcept {
  if (type.bits % 8 == 0) {
    const std::size_t size = type.bits / 8;
    const std::uint8_t* const first = bytes.data() + index * size;
    const bool is_big_endian = type.is_big_endian;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8U | first[is_big_endian ? i : size - 1 - i];
    return value;
  }
  std::uint64_t value = 0;
  for (unsigned k = 0; k < type.bits; ++k) {
    const std::size_t bit = index * type.bits + k;
    const unsigned shift = type.is_big_endian ? 7U - bit % 8 : bit % 8;
    const std::uint64_t found = bytes[bit / 8] >> shift & 1U;
    value |= type.is_big_endian ? found << (type.bits - 1 - k) : found << k;
  }
  return value;
}

double number_of(std::uint64_t bits, const WireType& type) noexcept {
  if (type.mask != 0) return static_cast<double>((bits & type.mask) >> std::countr_zero(type.mask));
  if (type.kind == WireType::Kind::real) {
    return type.bits == 64 ? std::bit_cast<double>(bits)
                           : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
  }
  if (type.kind == WireType::Kind::whole) return static_cast<double>(bits);
  const unsigned unused = 64U - type.bits;
  return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
}

template <typename Bits>
Bits swapped(Bits bits) noexcept {
  if constexpr (sizeof(Bits) == 2) {
    return __builtin_bswap16(bits);
  } else {
    return __builtin_bswap32(bits);
  }
}

/// Numbers of 16 or 32 bits, whose bytes may stand the other way round than those of the machine.
template <typename Number>
void read_as(std::span<const std::uint8_t> bytes, bool is_swapped, std::size_t count, float* values) noexcept {
  using Bits = std::conditional_t<sizeof(Number) == 2, std::uint16_t, std::uint32_t>;
  const auto bits_of = [&](std::size_t i) {
    Bits bits = 0;
    std::memcpy(&bits, &bytes[sizeof(Bits) * i], sizeof(bits));
    return bits;
  };
  const auto number = [](Bits bits) { return static_cast<float>(std::bit_cast<Number>(bits)); };
  if (is_swapped) {
    for (std::size_t i = 0; i < count; ++i) values[i] = number(swapped(bits_of(i)));
  } else {
    for (std::size_t i = 0; i < count; ++i) values[i] = number(bits_of(i));
  }
}

void read_numbers(std::span<const std::uint8_t> bytes, const WireType& type, std::size_t count,
                  float* values) noexcept {
  using Kind = WireType::Kind;
  const bool is_swapped = type.is_big_endian == (std::endian::native == std::endian::little);
  const auto is = [&](Kind kind, unsigned bits) { return type.kind == kind && type.bits == bits && type.mask == 0; };
  if (is(Kind::whole, 8)) return void(std::copy_n(bytes.begin(), count, values));
  if (is(Kind::whole, 16)) return read_as<std::uint16_t>(bytes, is_swapped, count, values);
  if (is(Kind::negative, 16)) return read_as<std::int16_t>(bytes, is_swapped, count, values);
  if (is(Kind::real, 32)) return read_as<float>(bytes, is_swapped, count, values);
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<float>(number_of(bits_at(bytes, type, i), type));
}

/// Whatever its number is, it can be what the field holds, and the size of the packet does not depend on it.
bool is_remark(const PacketField& field) {
  if (field.role == Role::temperature || field.role == Role::supply) return true;
  if (field.role != Role::frame && field.role != Role::flags && field.role != Role::time) return false;
  if (field.type.kind != WireType::Kind::whole || field.unit < 0.0 || field.offset < 0.0) return false;
  return 1e9 * (field.unit * std::ldexp(1.0, static_cast<int>(field.type.bits)) + field.offset) < kMostNanos;
}

}  // namespace

std::size_t bytes_of(const WireType& type, std::size_t count) noexcept {
  return (type.bits * count + 7) / 8;
}

Moduli moduli_of(const PacketLayout& layout) {
  Moduli moduli;
  for (const PacketLayout::Packet& packet : layout.packets) {
    for (const PacketField& field : packet) {
      if (field.role == Role::frame) moduli.frame = range_of(field);
      const double nanos = std::round(1e9 * field.unit * static_cast<double>(range_of(field)));
      if (field.role == Role::time && nanos < 9e18) {
        moduli.time_ns = std::max(moduli.time_ns, static_cast<std::uint64_t>(nanos));
      }
    }
  }
  return moduli;
}

PacketMatch::PacketMatch(const Layout& layout, const PacketLayout::Packet& packet, std::size_t array)
    : layout_(layout),
      packet_(packet),
      array_(array),
      names_array_(has_role(packet_, Role::array)),
      has_checksum_(has_role(packet_, Role::checksum)) {
  for (std::size_t k = 0; k < layout.arrays.size(); ++k) shares_.push_back(shares_of(packet_, k));
  // Times depend on those before them.
  const bool are_times_remarks =
      std::ranges::all_of(packet_, [](const auto& field) { return field.role != Role::time || is_remark(field); });
  for (const PacketField& field : packet_) {
    const bool is_checksum = field.role == Role::checksum;
    checksums_.push_back(is_checksum ? StreamChecksum(field.checksum, field.type.bits) : StreamChecksum());
    are_remarks_.push_back(field.role == Role::time ? are_times_remarks : is_remark(field));
  }
}

void PacketMatch::begin(std::uint64_t position) noexcept {
  so_far_ = {.position = position};
  piece_ = {.array = array_};
  numbers_.clear();
  remarks_.clear();
}

PacketMatch::Outcome PacketMatch::read(std::span<const std::uint8_t> bytes) {
  for (; so_far_.place < packet_.size(); ++so_far_.place) {
    const Outcome outcome = read_field(bytes);
    if (outcome != Outcome::whole) return outcome;
  }
  return !so_far_.end || *so_far_.end == so_far_.at ? Outcome::whole : Outcome::foreign;
}

void PacketMatch::read_content(std::span<const std::uint8_t> bytes, Piece& piece, std::vector<float>& numbers) {
  for (const auto& [at, field] : remarks_) {
    static_cast<void>(use(*field, number_of(bits_at(bytes.subspan(at), field->type, 0), field->type)));
  }
  piece = piece_;
  numbers.resize(so_far_.count);
  std::size_t read = 0;
  for (const Numbers& part : numbers_) {
    read_numbers(bytes.subspan(part.at), *part.type, part.count, numbers.data() + read);
    read += part.count;
  }
}

PacketMatch::Outcome PacketMatch::read_field(std::span<const std::uint8_t> bytes) {
  const PacketField& field = packet_[so_far_.place];
  const std::span<const std::uint8_t> rest = bytes.subspan(so_far_.at);
  if (field.role == Role::literal) return read_literal(field, rest);
  if (field.role == Role::values) return read_values(field, rest);
  const std::size_t size = field.role == Role::skip ? field.count : bytes_of(field.type, 1);
  if (rest.size() < size) return unfinished(so_far_.at + size);
  const std::size_t begin = so_far_.at;
  so_far_.at += size;
  if (field.role == Role::skip) return Outcome::whole;
  if (are_remarks_[so_far_.place]) return remarks_.push_back({begin, &field}), Outcome::whole;
  const std::uint64_t bits = bits_at(rest, field.type, 0);
  if (field.role == Role::checksum) {
    return checksums_[so_far_.place](bytes.first(begin), so_far_.position) == bits ? Outcome::whole : Outcome::damaged;
  }
  return use(field, number_of(bits, field.type)) ? Outcome::whole : Outcome::foreign;
}

PacketMatch::Outcome PacketMatch::unfinished(std::size_t needed) noexcept {
  so_far_.needed = needed;
  return Outcome::unfinished;
}

PacketMatch::Outcome PacketMatch::read_literal(const PacketField& field, std::span<const std::uint8_t> bytes) {
  const std::size_t size = std::min(bytes.size(), field.literal.size());
  if (!std::equal(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size), field.literal.begin())) {
    return Outcome::foreign;
  }
  if (size < field.literal.size()) return unfinished(so_far_.at + size + 1);
  so_far_.at += size;
  return Outcome::whole;
}

PacketMatch::Outcome PacketMatch::read_values(const PacketField& field, std::span<const std::uint8_t> bytes) {
  const std::size_t array = names_array_ ? piece_.array : field.array;
  const std::size_t taxels = layout_.arrays[array].shape.taxel_count();
  const std::size_t count = count_of(field, array);
  if (count > taxels || (array == array_ && count > taxels - so_far_.count)) return Outcome::foreign;
  const std::size_t size = bytes_of(field.type, count);
  if (bytes.size() < size) return unfinished(so_far_.at + size);
  if (array == array_) {
    numbers_.push_back({so_far_.at, count, &field.type});
    so_far_.count += count;
  }
  so_far_.at += size;
  return Outcome::whole;
}

/// As many as the packet says, or as its array has left.
std::size_t PacketMatch::count_of(const PacketField& field, std::size_t array) const noexcept {
  const FrameShape& shape = layout_.arrays[array].shape;
  if (so_far_.given_count)
    return static_cast<std::size_t>(std::min<std::uint64_t>(*so_far_.given_count, SIZE_MAX / 128));
  if (field.count > 0) return field.count;
  if (piece_.col) return 1;
  if (piece_.row) return shape.cols / shares_[field.array];
  const std::size_t first = std::min<std::uint64_t>(piece_.first.value_or(0), shape.taxel_count());
  return (shape.taxel_count() - first) / shares_[field.array];
}

/// False where the number cannot be what the field holds.
bool PacketMatch::use(const PacketField& field, double number) {
  const double value = field.unit * number + field.offset;
  if (field.role == Role::temperature) {
    piece_.add_temperature(value);
    return true;
  }
  if (field.role == Role::supply) {
    if (std::isfinite(value) && value > 0.0) piece_.supply_v = value;
    return true;
  }
  if (field.role == Role::time) {
    // In this order, whole units of up to 100 days are exact.
    const double nanos = std::round(1e9 * field.unit * number + 1e9 * field.offset);
    if (!(nanos >= 0.0 && nanos < kMostNanos)) return false;
    piece_.set_time(static_cast<std::uint64_t>(nanos), field.unit);
    return true;
  }
  if (!(value >= 0.0 && value < kMostNanos)) return false;
  const auto whole = static_cast<std::uint64_t>(value);
  switch (field.role) {
    case Role::row: piece_.row = whole; break;
    case Role::col: piece_.col = whole; break;
    case Role::first: piece_.first = whole; break;
    case Role::frame: piece_.frame = whole; break;
    case Role::flags: piece_.flags = whole; break;
    case Role::count: so_far_.given_count = whole; break;
    case Role::length: so_far_.end = so_far_.at + whole; break;
    case Role::array: {
      const auto found = std::find_if(layout_.arrays.begin(), layout_.arrays.end(),
                                      [&](const LayoutArray& array) { return array.id == whole; });
      if (found == layout_.arrays.end()) return false;
      piece_.array = static_cast<std::size_t>(found - layout_.arrays.begin());
      break;
    }
    default: break;
  }
  return true;
}

std::string PacketMatch::misfit() const {
  if (so_far_.place == packet_.size()) return "the length that it says is not its own";
  return "layout.packet[" + std::to_string(so_far_.place) + "] does not fit";
}

}  // namespace dermis::bytes::layouts
