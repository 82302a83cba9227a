// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/devices/layout_encoder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "bytes/devices/wire_values.hpp"
#include "dermis/bytes/layouts/checksum_of.hpp"

namespace dermis::bytes::devices {
namespace {

using layouts::PacketField;
using layouts::Role;
using layouts::WireType;

std::int64_t least_of(const WireType& type) {
  return type.kind == WireType::Kind::negative ? -(std::int64_t{1} << (type.bits - 1)) : 0;
}

std::int64_t most_of(const WireType& type) {
  return least_of(type) + ((std::int64_t{1} << type.bits) - 1);
}

bool carries(const WireType& type, float count) {
  if (type.kind == WireType::Kind::real) return true;
  return static_cast<double>(to_wire(count, least_of(type), most_of(type))) == static_cast<double>(count);
}

std::uint64_t bits_of(const WireType& type, float count) {
  if (type.kind == WireType::Kind::real) return std::bit_cast<std::uint32_t>(count);
  return static_cast<std::uint64_t>(to_wire(count, least_of(type), most_of(type)));
}

void append_bits(std::uint64_t bits, const WireType& type, std::vector<std::uint8_t>& bytes) {
  for (unsigned shift = 0; shift < type.bits; shift += 8) {
    bytes.push_back(static_cast<std::uint8_t>(bits >> (type.is_big_endian ? type.bits - 8 - shift : shift)));
  }
}

}  // namespace

void LayoutEncoder::encode(const RawFrame& frame, std::vector<std::uint8_t>& bytes) {
  const std::size_t begin = bytes.size();
  sequence_ = frame.acquisition.sequence.value_or(sequence_ + 1);
  for (const PacketField& field : packet_for(frame)) {
    if (field.role == Role::checksum) {
      const layouts::ChecksumOf checksum(field.checksum, field.type.bits);
      append_bits(checksum(std::span<const std::uint8_t>(bytes).subspan(begin)), field.type, bytes);
    } else {
      append(field, frame, bytes);
    }
  }
  is_sending_ = true;
}

const layouts::PacketLayout::Packet& LayoutEncoder::packet_for(const RawFrame& frame) const {
  const auto carries_all = [&](const layouts::PacketLayout::Packet& packet) {
    const auto values = std::ranges::find(packet, Role::values, &PacketField::role);
    return std::ranges::all_of(frame.counts, [&](float count) { return carries(values->type, count); });
  };
  const auto found = std::ranges::find_if(packets_, carries_all);
  return found == packets_.end() ? packets_.front() : *found;
}

void LayoutEncoder::append(const PacketField& field, const RawFrame& frame, std::vector<std::uint8_t>& bytes) const {
  const Nanos time = frame.acquisition.device_time.value_or(frame.time);
  switch (field.role) {
    case Role::literal: bytes.insert(bytes.end(), field.literal.begin(), field.literal.end()); break;
    case Role::values:
      for (const float count : frame.counts) append_bits(bits_of(field.type, count), field.type, bytes);
      break;
    case Role::frame: append_bits(sequence_, field.type, bytes); break;
    case Role::time:
      append_bits(static_cast<std::uint64_t>(time.count() / std::llround(1e9 * field.unit)), field.type, bytes);
      break;
    default: bytes.insert(bytes.end(), field.count, 0); break;
  }
}

}  // namespace dermis::bytes::devices
