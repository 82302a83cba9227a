// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/packet_writer.hpp"

#include <algorithm>
#include <span>

#include "bytes/proposals/byte_text.hpp"
#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kMostBytesOfParts = 4096;

layouts::Role role_of(const std::string& field) {
  using layouts::Role;
  return field == "frame"   ? Role::frame
         : field == "row"   ? Role::row
         : field == "first" ? Role::first
         : field == "array" ? Role::array
                            : Role::time;
}

}  // namespace

void PacketWriter::write(const std::vector<PacketField>& fields, const PacketField* turn, const std::string& meaning) {
  const std::size_t end = checksum_ != nullptr ? checksum_->at : packets_.size;
  const bool are_named = draft_.arrays.size() > 1 && turn == nullptr;
  if (packets_.mark_size > 0) {
    add(layouts::hexadecimal(std::span(packets_.packets.front()).first(packets_.mark_size)), packets_.mark_size,
        layouts::Role::literal);
  }
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const bool is_turn = turn != nullptr && fields[k].at == turn->at;
    PacketField field = is_turn ? *turn : fields[k];
    if (at_ < span_.end && field.at >= span_.end) add_values(are_named);
    const std::size_t next = k + 1 < fields.size() ? fields[k + 1].at : end;
    widen(field, packets_, at_, field.at < span_.begin ? std::min(next, span_.begin) : next);
    if (field.numbers.empty() || is_turn) add_field(field, is_turn ? meaning : field.field);
  }
  if (at_ < span_.end) add_values(are_named);
  if (checksum_ == nullptr) return add_trailer();
  add_constant(end);
  add(checksum_->entry, checksum_->size, layouts::Role::checksum);
  add_trailer();
}

void PacketWriter::add(const std::string& entry, std::size_t size, layouts::Role role) {
  draft_.packet.push_back(entry);
  for (const std::size_t place : packets_.places) {
    if (place < kMostBytesOfParts) draft_.parts.push_back({place + at_, place + at_ + size, role});
  }
  at_ += size;
}

void PacketWriter::add_constant(std::size_t end) {
  if (end > at_) add("skip " + std::to_string(end - at_), end - at_, layouts::Role::skip);
}

void PacketWriter::add_values(bool are_named) {
  add_constant(span_.begin);
  if (!are_named) return add("values " + span_.type, span_.end - span_.begin, layouts::Role::values);
  const std::size_t size = (span_.end - span_.begin) / draft_.arrays.size();
  for (const DraftArray& array : draft_.arrays) add(array.name + " " + span_.type, size, layouts::Role::values);
}

void PacketWriter::add_field(const PacketField& field, const std::string& name) {
  add_constant(field.at);
  const bool is_from_1 = name == "row" && field.numbers.front() == 1;
  add(name + " " + field.kind + std::to_string(8 * field.size) + (field.size > 1 ? field.order : "") +
          (is_from_1 ? " -1" : "") + field.options,
      field.size, role_of(name));
  draft_.merit += 0.05;
  if (!field.numbers.empty()) return;
  draft_.reasons.push_back("byte " + std::to_string(field.at + 1) +
                           (name == "frame" ? " counts packets" : " begins a clock"));
}

void PacketWriter::add_trailer() {
  bool is_same = true;
  for (std::size_t k = at_; k < packets_.size; ++k) is_same = is_same && is_constant(packets_, k);
  if (!is_same) return add_constant(packets_.size);
  const std::size_t size = packets_.size - at_;
  if (size > 0)
    add(layouts::hexadecimal(std::span(packets_.packets.front()).subspan(at_)), size, layouts::Role::literal);
}

}  // namespace dermis::bytes::proposals
