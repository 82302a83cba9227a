// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/layouts/raw_frames.hpp"

#include <utility>

#include "bytes/layouts/constant_packets.hpp"

namespace dermis::bytes::layouts {
namespace {

const PacketLayout& form_of(const Layout& layout) {
  return std::get<PacketLayout>(layout.form);
}

}  // namespace

bool is_one_frame(const Layout& layout) {
  const auto* const form = std::get_if<PacketLayout>(&layout.form);
  if (form == nullptr || form->escape != PacketLayout::Escape::none || form->packets.size() != 1) return false;
  const PacketLayout::Packet& packet = form->packets.front();
  const auto is_mark = [](const PacketField& field) { return field.role == Role::literal; };
  if (packet.empty() || is_mark(packet.front()) || is_mark(packet.back())) return false;
  return size_of_frame(layout, packet).has_value();
}

RawFrames::RawFrames(std::shared_ptr<const Layout> layout, std::size_t array)
    : layout_(std::move(layout)),
      array_(array),
      size_(*size_of_frame(*layout_, form_of(*layout_).packets.front())),
      match_(*layout_, form_of(*layout_).packets.front(), array),
      fields_(*layout_, moduli_of(form_of(*layout_))) {}

Verdict RawFrames::judge(std::span<const std::uint8_t> bytes, bool /*ended*/, RawFrame& frame) {
  if (bytes.size() < size_) return is_idle() ? Verdict{Verdict::Kind::noise, bytes.size()} : Verdict{};
  match_.begin(position());
  if (match_.read(bytes) != PacketMatch::Outcome::whole) return {Verdict::Kind::damaged, size_};
  Piece piece;
  match_.read_content(bytes, piece, frame.counts);
  fields_.scale(frame.counts);
  is_sending_ = true;
  return {fields_.write(piece, frame) ? Verdict::Kind::frame : Verdict::Kind::damaged, size_};
}

std::string RawFrames::advice() const {
  if (counts().frames > 0) return {};
  return "they are less than the " + std::to_string(size_) + " bytes of a frame";
}

}  // namespace dermis::bytes::layouts
