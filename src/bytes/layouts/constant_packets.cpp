// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/layouts/constant_packets.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "bytes/layouts/has_role.hpp"

namespace dermis::bytes::layouts {
namespace {

using Packet = PacketLayout::Packet;

const PacketField& mark_of(const Packet& packet) {
  return packet.front().role == Role::literal ? packet.front() : packet.back();
}

const Packet& first_packet(const Layout& layout) {
  return std::get<PacketLayout>(layout.form).packets.front();
}

bool is_at_begin(const Packet& packet) {
  return &mark_of(packet) == &packet.front();
}

Layout of_one_packet_without_mark(const Layout& layout, Packet packet) {
  PacketField& mark = is_at_begin(packet) ? packet.front() : packet.back();
  mark = {.role = Role::skip, .count = mark.literal.size()};
  Layout other = layout;
  std::get<PacketLayout>(other.form).packets = {std::move(packet)};
  return other;
}

std::vector<std::size_t> sizes_of(const std::vector<std::shared_ptr<const Layout>>& layouts) {
  std::vector<std::size_t> sizes;
  for (const auto& layout : layouts) {
    for (const Packet& packet : std::get<PacketLayout>(layout->form).packets) {
      sizes.push_back(*size_of_frame(*layout, packet));
    }
  }
  return sizes;
}

}  // namespace

std::optional<std::size_t> size_of_frame(const Layout& layout, const Packet& packet) {
  std::size_t size = 0;
  for (const PacketField& field : packet) {
    switch (field.role) {
      case Role::row:
      case Role::col:
      case Role::first:
      case Role::count:
      case Role::array:
      case Role::length:
      case Role::checksum: return std::nullopt;
      case Role::values: {
        const std::size_t taxels = layout.arrays[field.array].shape.taxel_count();
        const std::size_t shares = shares_of(packet, field.array);
        if (field.count != 0 && field.count * shares != taxels) return std::nullopt;
        size += bytes_of(field.type, taxels / shares);
        break;
      }
      case Role::literal: size += field.literal.size(); break;
      case Role::skip: size += field.count; break;
      default: size += bytes_of(field.type, 1);
    }
  }
  return size;
}

bool has_constant_sizes(const Layout& layout) {
  const auto* const form = std::get_if<PacketLayout>(&layout.form);
  if (form == nullptr || form->escape != PacketLayout::Escape::none) return false;
  const Packet& first = form->packets.front();
  std::set<std::size_t> sizes;
  for (const Packet& packet : form->packets) {
    const bool has_mark = !packet.empty() && mark_of(packet).role == Role::literal;
    const std::optional<std::size_t> size = has_mark ? size_of_frame(layout, packet) : std::nullopt;
    const bool is_another = size && sizes.insert(*size).second;
    if (!is_another || is_at_begin(packet) != is_at_begin(first) || mark_of(packet).literal != mark_of(first).literal) {
      return false;
    }
  }
  return true;
}

ConstantPackets::Form::Form(const Layout& of_packets, const Packet& packet, std::size_t array)
    : layout(of_one_packet_without_mark(of_packets, packet)),
      size(*size_of_frame(of_packets, packet)),
      match(layout, first_packet(layout), array),
      fields(layout, moduli_of(std::get<PacketLayout>(layout.form))) {}

bool ConstantPackets::Form::fits(std::span<const std::uint8_t> packet) {
  match.begin(0);  // which only checksums ask for
  return match.read(packet) == PacketMatch::Outcome::whole;
}

ConstantPackets::ConstantPackets(const std::vector<std::shared_ptr<const Layout>>& layouts, std::size_t array,
                                 FirstMark first)
    : MarkChainDecoder(mark_of(first_packet(*layouts.front())).literal,
                       is_at_begin(first_packet(*layouts.front())) ? MarkAt::begin : MarkAt::end, sizes_of(layouts),
                       first),
      first_(layouts.front()),
      array_(array) {
  for (const auto& layout : layouts) {
    for (const Packet& packet : std::get<PacketLayout>(layout->form).packets) {
      forms_.push_back(std::make_unique<Form>(*layout, packet, array));
    }
  }
}

std::optional<FrameShape> ConstantPackets::shape() const noexcept {
  const auto shape_of = [&](const std::unique_ptr<Form>& form) { return form->layout.arrays[array_].shape; };
  for (const auto& form : forms_) {
    if (frame_size() == form->size) return shape_of(form);
  }
  const bool are_alike = std::all_of(forms_.begin(), forms_.end(),
                                     [&](const auto& form) { return shape_of(form) == shape_of(forms_.front()); });
  return are_alike ? std::optional(shape_of(forms_.front())) : std::nullopt;
}

ConstantPackets::Form& ConstantPackets::form_of(std::size_t size) noexcept {
  return **std::find_if(forms_.begin(), forms_.end(), [&](const auto& form) { return form->size == size; });
}

bool ConstantPackets::fits(std::span<const std::uint8_t> packet) {
  return form_of(packet.size()).fits(packet);
}

bool ConstantPackets::read(std::span<const std::uint8_t> packet, RawFrame& frame) {
  Form& form = form_of(packet.size());
  if (!form.fits(packet)) return false;
  Piece piece;
  form.match.read_content(packet, piece, frame.counts);
  form.fields.scale(frame.counts);
  is_sending_ = true;
  return form.fields.write(piece, frame);
}

void ConstantPackets::begin_again() {
  MarkChainDecoder::begin_again();
  is_sending_ = false;
}

std::string_view ConstantPackets::request() const noexcept {
  return first_->request_after(is_sending_);
}

std::string ConstantPackets::advice() const {
  if (counts().frames > 0) return {};
  std::string sizes;
  for (const auto& form : forms_) sizes += (sizes.empty() ? "" : " or ") + std::to_string(form->size);
  const std::string mark = "the mark " + hexadecimal(mark_of(first_packet(*first_)).literal);
  if (!first_mark_at()) return mark + " does not come";
  return mark + " of byte " + std::to_string(*first_mark_at()) + " does not come again after " + sizes + " bytes";
}

}  // namespace dermis::bytes::layouts
