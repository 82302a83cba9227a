// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/layouts/mark_chain_decoder.hpp"

#include <algorithm>
#include <utility>

namespace dermis::bytes::layouts {
namespace {

// A mark of two bytes is found by chance at one in 65536 positions. The two around a frame: once in 10^7 searches of a
// few hundred bytes, each of which follows a damaged frame. More at the beginning, where nothing is known of the
// device.
constexpr std::size_t kMarksWhenResuming = 2;
constexpr std::size_t kMarksForKnownSize = 3;
constexpr std::size_t kMarksForUnknownSize = 4;
constexpr std::size_t kMaxFramesCompared = 8;
constexpr std::size_t kSmallStep = 4;  ///< Most bytes that damage adds or drops, as a rule.

}  // namespace

MarkChainDecoder::MarkChainDecoder(Bytes mark, MarkAt place, std::vector<std::size_t> frame_sizes, FirstMark first)
    : mark_(mark),
      taken_(place == MarkAt::end ? mark.size() : 0),
      first_mark_(first),
      frame_sizes_(std::move(frame_sizes)) {
  const std::size_t longest = *std::max_element(frame_sizes_.begin(), frame_sizes_.end());
  last_payload_.reserve(longest);
  marks_in_phase_.reserve(longest);
  MarkChainDecoder::begin_again();
}

std::optional<std::size_t> MarkChainDecoder::frame_size() const noexcept {
  return frame_sizes_.size() == 1 ? std::optional(frame_sizes_.front()) : std::nullopt;
}

/// With marks at the end, the first bytes are a frame, whole or not.
void MarkChainDecoder::begin_again() {
  in_step_ = taken_ > 0;
  was_in_step_ = false;
  after_mark_ = false;
  is_at_begin_ = first_mark_ == FirstMark::begins_frame;
  frames_compared_ = marks_needed();
}

std::size_t MarkChainDecoder::marks_needed() const noexcept {
  if (!frame_size()) return kMarksForUnknownSize;
  return last_payload_.empty() ? kMarksForKnownSize : kMarksWhenResuming;
}

bool MarkChainDecoder::mark_at(Bytes bytes, std::size_t position) const noexcept {
  if (position < taken_) return position == 0 && after_mark_;
  const std::size_t at = position - taken_;
  return at + mark_.size() <= bytes.size() &&
         std::equal(mark_.begin(), mark_.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
}

Verdict MarkChainDecoder::judge(Bytes bytes, bool ended, RawFrame& frame) {
  return in_step_ ? follow(bytes, ended, frame) : search(bytes, ended);
}

Verdict MarkChainDecoder::follow(Bytes bytes, bool ended, RawFrame& frame) {
  const std::size_t size = frame_sizes_.front();
  const bool has_its_mark = mark_at(bytes, 0);
  const auto reaches = [&](std::size_t position) { return length(bytes) >= position + mark_.size(); };
  if (!reaches(size)) {
    const bool waits = !ended && !is_idle();
    if (waits || taken_ > 0 || !has_its_mark || bytes.size() < size) return {};
    const Bytes rest = bytes.subspan(size);
    return std::equal(rest.begin(), rest.end(), mark_.begin()) ? deliver(bytes, frame) : Verdict{};
  }
  bool has_its_length = mark_at(bytes, size);
  if (!has_its_length) {  // Unless only that one mark is damaged, and those after it are where they must be.
    if (!ended && !reaches(3 * size)) return {};
    has_its_length = mark_at(bytes, 2 * size) && (mark_at(bytes, 3 * size) || !reaches(3 * size));
  }
  if (has_its_length && (has_its_mark || taken_ > 0)) return deliver(bytes, frame);
  if (has_its_length) return pass(bytes, Verdict::Kind::damaged, size);
  in_step_ = false;
  was_in_step_ = true;
  frames_compared_ = marks_needed();
  return {has_its_mark ? Verdict::Kind::damaged : Verdict::Kind::noise, 0};
}

Verdict MarkChainDecoder::deliver(Bytes bytes, RawFrame& frame) {
  const std::size_t size = frame_sizes_.front();
  const Bytes payload = bytes.subspan(mark_.size() - taken_, size - mark_.size());
  if (!read(bytes.first(size), frame)) return pass(bytes, Verdict::Kind::damaged, size);
  last_payload_.assign(payload.begin(), payload.end());
  return pass(bytes, Verdict::Kind::frame, size);
}

Verdict MarkChainDecoder::pass(Bytes bytes, Verdict::Kind kind, std::size_t size) {
  after_mark_ = mark_at(bytes, size);
  is_at_begin_ = is_at_begin_ && size == 0;
  return {kind, size};
}

Verdict MarkChainDecoder::search(Bytes bytes, bool ended) {
  const auto [shortest, longest] = std::minmax_element(frame_sizes_.begin(), frame_sizes_.end());
  const std::size_t needed = frames_compared_ * *longest + mark_.size() - 1 - taken_;
  const bool is_short = bytes.size() < needed && !ended;
  if (is_short && !is_idle()) return {};
  const Bytes compared = bytes.first(std::min(needed, bytes.size()));
  chain_count_ = 0;
  for (const std::size_t size : frame_sizes_) {
    find_chains(compared, size);
    if (chain_count_ > chains_.size()) break;  // of which none can be the true one
  }

  const Chain* chain = true_chain();
  if (is_short && (chain == nullptr || !ends_with_frame(bytes, *chain))) return {};
  if (chain != nullptr) {
    const std::size_t start = chain->start;
    frame_sizes_.assign(1, chain->frame_size);
    in_step_ = true;
    return pass(bytes, Verdict::Kind::noise, start);
  }
  if (!first_mark_at_) look_for_first_mark(compared);
  const bool more_may_tell = std::any_of(chains().begin(), chains().end(),
                                         [&](const Chain& chain) { return chain.is_whole && !is_imitation(chain); });
  if (more_may_tell && frames_compared_ < kMaxFramesCompared) {
    if (bytes.size() < needed) return {};
    ++frames_compared_;
    return {Verdict::Kind::noise, 0};
  }
  if (!more_may_tell) frames_compared_ = marks_needed();
  // No frame begins within the shortest one; but the bytes before the next may belong to the mark before it.
  return pass(bytes, Verdict::Kind::noise, std::min(*shortest - taken_, bytes.size()));
}

void MarkChainDecoder::look_for_first_mark(Bytes bytes) {
  const auto mark = std::search(bytes.begin(), bytes.end(), mark_.begin(), mark_.end());
  if (mark != bytes.end()) first_mark_at_ = position() + static_cast<std::size_t>(mark - bytes.begin());
}

/// A device pauses between frames.
bool MarkChainDecoder::ends_with_frame(Bytes bytes, const Chain& chain) noexcept {
  return (bytes.size() - chain.start) % chain.frame_size == 0;
}

void MarkChainDecoder::find_chains(Bytes bytes, std::size_t frame_size) {
  const std::size_t end = std::min(length(bytes), frames_compared_ * frame_size + mark_.size() - 1);
  const Bytes compared = bytes.first(end - taken_);
  marks_in_phase_.assign(frame_size, 0);
  if (mark_at(compared, 0) && taken_ > 0) ++marks_in_phase_[0];
  auto mark = compared.begin();
  while ((mark = std::search(mark, compared.end(), mark_.begin(), mark_.end())) != compared.end()) {
    ++marks_in_phase_[(taken_ + static_cast<std::size_t>(mark - compared.begin())) % frame_size];
    ++mark;
  }
  // At the end of the stream there may be fewer than needed: two, or the one of a stream that is nothing but a frame.
  const bool is_one_frame = this->frame_size() && bytes.size() == frame_size;
  const std::size_t fewest = is_one_frame ? 1 : this->frame_size() ? 2 : kMarksForUnknownSize;
  for (std::size_t phase = 0; phase < frame_size && phase + mark_.size() <= end; ++phase) {
    const std::size_t possible = 1 + (end - mark_.size() - phase) / frame_size;
    const std::size_t missing = possible - marks_in_phase_[phase];
    const bool may_be_whole = missing == 0 || (missing == 1 && possible >= kMarksForKnownSize);
    if (!may_be_whole) continue;
    const bool has_frame = phase + frame_size <= compared.size();
    if (has_frame && !fits(compared.subspan(phase, frame_size))) continue;
    const bool is_whole = missing == 0 && possible >= fewest && phase + frame_size <= end;
    if (chain_count_ < chains_.size()) chains_[chain_count_] = {phase, frame_size, is_whole};
    ++chain_count_;
  }
}

std::span<const MarkChainDecoder::Chain> MarkChainDecoder::chains() const noexcept {
  return std::span(chains_).first(std::min(chain_count_, chains_.size()));
}

const MarkChainDecoder::Chain* MarkChainDecoder::true_chain() const noexcept {
  if (is_at_begin_ && chain_count_ > 0 && chains_[0].start == 0 && chains_[0].is_whole) return &chains_[0];
  if (chain_count_ > chains_.size()) return nullptr;
  if (last_payload_.empty()) return chain_count_ == 1 && chains_[0].is_whole ? &chains_[0] : nullptr;
  const Chain* original = nullptr;
  const Chain* near = nullptr;
  std::size_t whole = 0;
  std::size_t originals = 0;
  std::size_t nears = 0;
  for (const Chain& chain : chains()) {
    if (!chain.is_whole) continue;
    ++whole;
    if (!is_imitation(chain)) original = &chain, ++originals;
    if (std::min(chain.start, chain.frame_size - chain.start) <= kSmallStep) near = &chain, ++nears;
  }
  if (originals == 1) return original;
  return was_in_step_ && whole > 1 && nears == 1 ? near : nullptr;
}

/// Readings of the last frame looked like a mark, and a mark stands where it must if the chain is made of those
/// readings.
bool MarkChainDecoder::is_imitation(const Chain& chain) const noexcept {
  auto reading = last_payload_.begin();
  while ((reading = std::search(reading, last_payload_.end(), mark_.begin(), mark_.end())) != last_payload_.end()) {
    const std::size_t distance = mark_.size() + static_cast<std::size_t>(reading - last_payload_.begin());
    if (marks_in_phase_[(chain.start + chain.frame_size - distance) % chain.frame_size] > 0) return true;
    ++reading;
  }
  return false;
}

}  // namespace dermis::bytes::layouts
