// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/layouts/packet_decoder.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "bytes/layouts/has_role.hpp"
#include "dermis/bytes/layouts/escapes.hpp"

namespace dermis::bytes::layouts {
namespace {

constexpr std::size_t kBytesOfReading = 8;
constexpr std::size_t kOtherBytes = 4096;

std::size_t longest_packet(const Layout& layout) {
  std::size_t taxels = 0;
  for (const LayoutArray& array : layout.arrays) taxels += array.shape.taxel_count();
  return 2 * kBytesOfReading * taxels + kOtherBytes;
}

}  // namespace

PacketDecoder::PacketDecoder(std::shared_ptr<const Layout> layout, std::size_t array)
    : layout_(std::move(layout)),
      form_(std::get<PacketLayout>(layout_->form)),
      array_(array),
      longest_packet_(longest_packet(*layout_)),
      match_(*layout_, array),
      assembly_(*layout_, array, moduli_of(form_)) {}

void PacketDecoder::push(std::span<const std::uint8_t> bytes) {
  is_idle_ = false;
  window_.push(bytes);
}

bool PacketDecoder::next(RawFrame& frame) {
  const bool is_escaped = form_.escape != PacketLayout::Escape::none;
  for (;;) {
    const Found found = is_escaped ? next_escaped(frame) : next_packet(frame);
    if (found == Found::frame) return true;
    if (found == Found::nothing) break;
  }
  if (std::exchange(has_ended_, false)) {
    skip(window_.bytes().size());
    assembly_.end_frame();
    is_sending_ = false;
  }
  return false;
}

PacketDecoder::Found PacketDecoder::next_packet(RawFrame& frame) {
  const std::span<const std::uint8_t> bytes = window_.bytes();
  if (bytes.empty()) return Found::nothing;
  if (const std::size_t distance = distance_to_mark(bytes); distance > 0) return skip(distance);
  switch (match_.read(bytes, piece_, numbers_)) {
    case PacketMatch::Outcome::unfinished: return has_ended_ ? skip(1) : Found::nothing;
    case PacketMatch::Outcome::damaged:
      misfit_ = match_.misfit();
      assembly_.damage(0);
      return skip(1);
    case PacketMatch::Outcome::foreign: misfit_ = match_.misfit(); return skip(1);
    case PacketMatch::Outcome::whole: break;
  }
  if (match_.has_checksum()) return take(match_.size(), frame);
  const std::span<const std::uint8_t> rest = bytes.subspan(match_.size());
  const bool is_decided = rest.size() >= form_.packet.front().literal.size() || is_idle_ || has_ended_;
  if (!is_decided) return Found::nothing;
  return is_followed_by_packet(rest) ? take(match_.size(), frame) : skip(1);
}

/// Packets without a checksum are believed where the next one begins behind them.
bool PacketDecoder::is_followed_by_packet(std::span<const std::uint8_t> rest) const noexcept {
  const std::vector<std::uint8_t>& mark = form_.packet.front().literal;
  const std::size_t size = std::min(rest.size(), mark.size());
  return std::equal(mark.begin(), mark.begin() + static_cast<std::ptrdiff_t>(size), rest.begin());
}

std::size_t PacketDecoder::distance_to_mark(std::span<const std::uint8_t> bytes) const noexcept {
  const void* const found = std::memchr(bytes.data(), form_.packet.front().literal.front(), bytes.size());
  return found == nullptr ? bytes.size()
                          : static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - bytes.data());
}

PacketDecoder::Found PacketDecoder::skip(std::size_t bytes) {
  assembly_.skip(bytes);
  window_.drop(bytes);
  return Found::packet;
}

PacketDecoder::Found PacketDecoder::take(std::size_t bytes, RawFrame& frame) {
  window_.drop(bytes);
  const bool is_frame = assembly_.add(piece_, numbers_, bytes, frame);
  if (is_frame) frame_end_ = window_.position();
  is_sending_ = is_sending_ || is_frame;
  return is_frame ? Found::frame : Found::packet;
}

PacketDecoder::Found PacketDecoder::next_escaped(RawFrame& frame) {
  const std::span<const std::uint8_t> bytes = window_.bytes();
  if (bytes.empty()) return Found::nothing;
  const std::size_t reach = std::min(bytes.size(), longest_packet_);
  const void* const end = std::memchr(bytes.data(), delimiter_of(form_), reach);
  if (end == nullptr) return reach == longest_packet_ ? skip(reach) : Found::nothing;
  const auto size = static_cast<std::size_t>(static_cast<const std::uint8_t*>(end) - bytes.data());
  if (size == 0) return skip(1);
  const bool is_packet = undo_escapes(form_, bytes.first(size), plain_) &&
                         match_.read(plain_, piece_, numbers_) == PacketMatch::Outcome::whole &&
                         match_.size() == plain_.size();
  if (is_packet) return take(size + 1, frame);
  misfit_ = match_.misfit();
  if (counts().frames > 0) assembly_.damage(0);
  return skip(size + 1);
}

std::string PacketDecoder::advice() const {
  if (counts().frames > 0) return {};
  const std::string incomplete = assembly_.advice();
  return misfit_ + (misfit_.empty() || incomplete.empty() ? "" : "; ") + incomplete;
}

}  // namespace dermis::bytes::layouts
