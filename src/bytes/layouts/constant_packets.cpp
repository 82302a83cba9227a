// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/layouts/constant_packets.hpp"

#include <algorithm>

#include "bytes/layouts/has_role.hpp"

namespace dermis::bytes::layouts {
namespace {

const PacketField& mark_of(const Layout& layout) {
  const std::vector<PacketField>& fields = std::get<PacketLayout>(layout.form).packet;
  return fields.front().role == Role::literal ? fields.front() : fields.back();
}

bool is_at_begin(const Layout& layout) {
  return &mark_of(layout) == &std::get<PacketLayout>(layout.form).packet.front();
}

Layout without_mark(const Layout& layout) {
  Layout other = layout;
  std::vector<PacketField>& fields = std::get<PacketLayout>(other.form).packet;
  PacketField& mark = is_at_begin(layout) ? fields.front() : fields.back();
  mark = {.role = Role::skip, .count = mark.literal.size()};
  return other;
}

std::vector<std::size_t> sizes_of(const std::vector<std::shared_ptr<const Layout>>& layouts) {
  std::vector<std::size_t> sizes;
  for (const auto& layout : layouts) sizes.push_back(*constant_size(*layout));
  return sizes;
}

}  // namespace

std::optional<std::size_t> constant_size(const Layout& layout) {
  const auto* const packet = std::get_if<PacketLayout>(&layout.form);
  if (packet == nullptr || packet->escape != PacketLayout::Escape::none) return std::nullopt;
  std::size_t size = 0;
  for (const PacketField& field : packet->packet) {
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
        const std::size_t shares = shares_of(packet->packet, field.array);
        if (field.count != 0 && field.count * shares != taxels) return std::nullopt;
        size += bytes_of(field.type, taxels / shares);
        break;
      }
      case Role::literal: size += field.literal.size(); break;
      case Role::skip: size += field.count; break;
      default: size += bytes_of(field.type, 1);
    }
  }
  const bool has_mark = mark_of(layout).role == Role::literal;
  return has_mark ? std::optional(size) : std::nullopt;
}

ConstantPackets::Form::Form(const Layout& with_mark, std::size_t array)
    : layout(without_mark(with_mark)),
      size(*constant_size(with_mark)),
      match(layout, array),
      fields(layout, moduli_of(std::get<PacketLayout>(layout.form))) {}

ConstantPackets::ConstantPackets(const std::vector<std::shared_ptr<const Layout>>& layouts, std::size_t array,
                                 FirstMark first)
    : MarkChainDecoder(mark_of(*layouts.front()).literal, is_at_begin(*layouts.front()) ? MarkAt::begin : MarkAt::end,
                       sizes_of(layouts), first),
      first_(layouts.front()),
      array_(array) {
  for (const auto& layout : layouts) forms_.push_back(std::make_unique<Form>(*layout, array));
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
  Piece piece;
  return form_of(packet.size()).match.read(packet, piece, numbers_) == PacketMatch::Outcome::whole;
}

bool ConstantPackets::read(std::span<const std::uint8_t> packet, RawFrame& frame) {
  Form& form = form_of(packet.size());
  Piece piece;
  if (form.match.read(packet, piece, frame.counts) != PacketMatch::Outcome::whole) return false;
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
  return "the mark " + hexadecimal(mark_of(*first_).literal) + " does not come again after " + sizes + " bytes";
}

}  // namespace dermis::bytes::layouts
