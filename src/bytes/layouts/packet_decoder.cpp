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

std::size_t longest_mark(const PacketLayout& layout) noexcept {
  std::size_t longest = 0;
  for (const PacketLayout::Packet& packet : layout.packets) {
    longest = std::max(longest, packet.front().literal.size());
  }
  return longest;
}

}  // namespace

PacketDecoder::PacketDecoder(std::shared_ptr<const Layout> layout, std::size_t array)
    : layout_(std::move(layout)),
      form_(std::get<PacketLayout>(layout_->form)),
      array_(array),
      assembly_(*layout_, array, moduli_of(form_)) {
  escaped_.longest = longest_packet(*layout_);
  for (const PacketLayout::Packet& packet : form_.packets) {
    matches_.emplace_back(*layout_, packet, array);
    if (packet.front().role == Role::literal) begins_mark_[packet.front().literal.front()] = true;
  }
}

void PacketDecoder::push(std::span<const std::uint8_t> bytes) {
  input_.is_idle = false;
  window_.push(bytes);
}

bool PacketDecoder::next(RawFrame& frame) {
  const bool is_escaped = form_.escape != PacketLayout::Escape::none;
  for (;;) {
    const Found found = is_escaped ? next_escaped(frame) : next_packet(frame);
    if (found == Found::frame) return true;
    if (found == Found::nothing) break;
  }
  if (std::exchange(input_.has_ended, false)) {
    skip(window_.bytes().size());
    assembly_.end_frame();
    is_sending_ = false;
  }
  return false;
}

PacketDecoder::Found PacketDecoder::next_packet(RawFrame& frame) {
  const std::span<const std::uint8_t> bytes = window_.bytes();
  if (bytes.empty() || (bytes.size() < front_.needed && !input_.has_ended)) return Found::nothing;
  const auto mark = std::ranges::find_if(bytes, [&](std::uint8_t byte) { return begins_mark_[byte]; });
  if (mark != bytes.begin()) return skip(static_cast<std::size_t>(mark - bytes.begin()));
  const auto [outcome, match] = read(bytes);
  if (outcome == PacketMatch::Outcome::unfinished) return Found::nothing;
  if (outcome == PacketMatch::Outcome::damaged) assembly_.damage(0);
  if (outcome != PacketMatch::Outcome::whole) return skip(1);
  if (match->has_checksum()) return take(*match, bytes, match->size(), frame);
  const std::span<const std::uint8_t> rest = bytes.subspan(match->size());
  const bool is_decided = rest.size() >= longest_mark(form_) || input_.is_idle || input_.has_ended;
  if (!is_decided) return Found::nothing;
  if (is_followed_by_packet(rest)) return take(*match, bytes, match->size(), frame);
  if (is_further(match->packet().size()))
    keep_misfit(match->packet().size(), "no packet stands behind these " + std::to_string(match->size()) + " bytes");
  return skip(1);
}

/// Tries the packets of the layout. One that may be more than the bytes so far keeps those behind it waiting, but not
/// at the end.
PacketDecoder::Reading PacketDecoder::read(std::span<const std::uint8_t> bytes) {
  for (; front_.match < matches_.size(); ++front_.match, front_.is_begun = false) {
    PacketMatch& match = matches_[front_.match];
    if (!std::exchange(front_.is_begun, true)) match.begin(window_.position());
    const PacketMatch::Outcome outcome = match.read(bytes);
    if (outcome == PacketMatch::Outcome::whole) return {outcome, &match};
    if (outcome == PacketMatch::Outcome::unfinished && input_.has_ended) continue;
    if (outcome == PacketMatch::Outcome::unfinished) {
      front_.needed = match.needed();
      return {outcome, &match};
    }
    if (is_further(match.fitted())) keep_misfit(match.fitted(), match.misfit());
    if (outcome == PacketMatch::Outcome::damaged) front_.outcome = outcome;
  }
  return {front_.outcome, nullptr};
}

/// Packets without a checksum are believed where the next one begins behind them.
bool PacketDecoder::is_followed_by_packet(std::span<const std::uint8_t> rest) const noexcept {
  return std::ranges::any_of(form_.packets, [&](const PacketLayout::Packet& packet) {
    const std::vector<std::uint8_t>& mark = packet.front().literal;
    const std::size_t size = std::min(rest.size(), mark.size());
    return std::equal(mark.begin(), mark.begin() + static_cast<std::ptrdiff_t>(size), rest.begin());
  });
}

void PacketDecoder::drop(std::size_t bytes) {
  window_.drop(bytes);
  front_ = {};
  escaped_.searched = 0;
}

PacketDecoder::Found PacketDecoder::skip(std::size_t bytes) {
  assembly_.skip(bytes);
  drop(bytes);
  return Found::packet;
}

PacketDecoder::Found PacketDecoder::take(PacketMatch& match, std::span<const std::uint8_t> packet, std::size_t bytes,
                                         RawFrame& frame) {
  match.read_content(packet, piece_, numbers_);
  drop(bytes);
  const bool is_frame = assembly_.add(piece_, numbers_, bytes, frame);
  if (is_frame) frame_end_ = window_.position();
  is_sending_ = is_sending_ || is_frame;
  return is_frame ? Found::frame : Found::packet;
}

PacketDecoder::Found PacketDecoder::next_escaped(RawFrame& frame) {
  const std::span<const std::uint8_t> bytes = window_.bytes();
  if (bytes.empty()) return Found::nothing;
  const std::size_t reach = std::min(bytes.size(), escaped_.longest);
  const void* const end = std::memchr(bytes.data() + escaped_.searched, delimiter_of(form_), reach - escaped_.searched);
  if (end == nullptr) escaped_.searched = reach;
  if (end == nullptr) return reach == escaped_.longest ? skip(reach) : Found::nothing;
  const auto size = static_cast<std::size_t>(static_cast<const std::uint8_t*>(end) - bytes.data());
  if (size == 0) return skip(1);
  PacketMatch* const match =
      undo_escapes(form_, bytes.first(size), escaped_.plain) ? match_of(escaped_.plain) : nullptr;
  if (match != nullptr) return take(*match, escaped_.plain, size + 1, frame);
  if (counts().frames > 0) assembly_.damage(0);
  return skip(size + 1);
}

PacketMatch* PacketDecoder::match_of(std::span<const std::uint8_t> plain) {
  for (PacketMatch& match : matches_) {
    match.begin(window_.position());
    const bool is_whole = match.read(plain) == PacketMatch::Outcome::whole;
    if (is_whole && match.size() == plain.size()) return &match;
    if (is_further(match.fitted())) keep_misfit(match.fitted(), match.misfit());
  }
  return nullptr;
}

/// The furthest that a packet fitted before the first frame, and of those that came as far the first.
bool PacketDecoder::is_further(std::size_t fields) const noexcept {
  return counts().frames == 0 && (misfit_.text.empty() || fields > misfit_.fields);
}

void PacketDecoder::keep_misfit(std::size_t fields, const std::string& text) {
  misfit_.fields = fields;
  misfit_.text = "byte " + std::to_string(window_.position()) + ": " + text;
}

std::string PacketDecoder::without_packet() const {
  const std::size_t waiting = window_.bytes().size();
  if (waiting == 0) return "no packet is in them";
  return "the packet at byte " + std::to_string(window_.position()) + " does not end within " +
         std::to_string(waiting) + " bytes";
}

std::string PacketDecoder::advice() const {
  if (counts().frames > 0) return {};
  const std::string incomplete = assembly_.advice();
  if (misfit_.text.empty() && incomplete.empty()) return without_packet();
  return misfit_.text + (misfit_.text.empty() || incomplete.empty() ? "" : "; ") + incomplete;
}

}  // namespace dermis::bytes::layouts
