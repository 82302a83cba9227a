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

MarkChainDecoder::MarkChainDecoder(Bytes mark, MarkAt place, const std::vector<std::size_t>& frame_sizes,
                                   FirstMark first)
    : mark_(mark), taken_(place == MarkAt::end ? mark.size() : 0), first_mark_(first) {
  for (const std::size_t size : frame_sizes) sizes_.push_back({size});
  const std::size_t longest = std::ranges::max(frame_sizes);
  last_payload_.reserve(longest);
  marks_in_phase_.reserve(longest);
  MarkChainDecoder::begin_again();
}

std::optional<std::size_t> MarkChainDecoder::frame_size() const noexcept {
  return sizes_.size() == 1 ? std::optional(sizes_.front().bytes) : std::nullopt;
}

/// With marks at the end, the first bytes are a frame, whole or not.
void MarkChainDecoder::begin_again() {
  in_step_ = taken_ > 0;
  was_in_step_ = false;
  after_mark_ = false;
  is_at_begin_ = first_mark_ == FirstMark::begins_frame;
  frames_compared_ = marks_needed();
  forget_chains();
}

std::size_t MarkChainDecoder::marks_needed() const noexcept {
  if (!frame_size()) return kMarksForUnknownSize;
  return last_payload_.empty() ? kMarksForKnownSize : kMarksWhenResuming;
}

/// Chains of other lengths are other chains.
void MarkChainDecoder::compare(std::size_t frames) noexcept {
  if (frames != frames_compared_) forget_chains();
  frames_compared_ = frames;
}

void MarkChainDecoder::forget_chains() noexcept {
  for (Size& size : sizes_) {
    size.known_until = 0;
    size.chains.clear();
  }
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
  const std::size_t size = sizes_.front().bytes;
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
  const std::size_t size = sizes_.front().bytes;
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
  const std::size_t shortest = std::ranges::min(sizes_, {}, &Size::bytes).bytes;
  const std::size_t longest = std::ranges::max(sizes_, {}, &Size::bytes).bytes;
  const std::size_t needed = frames_compared_ * longest + mark_.size() - 1 - taken_;
  const bool is_short = bytes.size() < needed && !ended;
  if (is_short && !is_idle()) return {};
  const Bytes compared = bytes.first(std::min(needed, bytes.size()));
  find_chains(compared, bytes.size() >= needed);

  const Chain* chain = true_chain();
  if (is_short && (chain == nullptr || !ends_with_frame(bytes, *chain))) return {};
  if (chain != nullptr) {
    const std::size_t start = chain->start;
    sizes_.assign(1, {chain->frame_size});
    in_step_ = true;
    return pass(bytes, Verdict::Kind::noise, start);
  }
  if (!first_mark_at_) look_for_first_mark(compared);
  const bool more_may_tell = std::any_of(chains().begin(), chains().end(),
                                         [&](const Chain& chain) { return chain.is_whole && !is_imitation(chain); });
  if (more_may_tell && frames_compared_ < kMaxFramesCompared) {
    if (bytes.size() < needed) return {};
    compare(frames_compared_ + 1);
    return {Verdict::Kind::noise, 0};
  }
  if (!more_may_tell) compare(marks_needed());
  // No frame begins within the shortest one; but the bytes before the next may belong to the mark before it.
  return pass(bytes, Verdict::Kind::noise, std::min(shortest - taken_, bytes.size()));
}

void MarkChainDecoder::look_for_first_mark(Bytes bytes) {
  const auto mark = std::search(bytes.begin(), bytes.end(), mark_.begin(), mark_.end());
  if (mark != bytes.end()) first_mark_at_ = position() + static_cast<std::size_t>(mark - bytes.begin());
}

/// A device pauses between frames.
bool MarkChainDecoder::ends_with_frame(Bytes bytes, const Chain& chain) noexcept {
  return (bytes.size() - chain.start) % chain.frame_size == 0;
}

/// Where the size is not known, a chain is sought once at each place, however often the window moves on.
void MarkChainDecoder::find_chains(Bytes bytes, bool are_kept) {
  if (frame_size() || !are_kept) forget_chains();
  chain_count_ = 0;
  for (Size& size : sizes_) {
    find_chains(bytes, size);
    for (const Chain& chain : size.chains) {
      const std::size_t start = chain.start - position();
      if (chain_count_ < chains_.size()) chains_[chain_count_] = {start, chain.frame_size, chain.is_whole};
      ++chain_count_;
    }
    if (chain_count_ > chains_.size()) break;  // of which none can be the true one
  }
  if (!are_kept) forget_chains();
}

void MarkChainDecoder::find_chains(Bytes bytes, Size& size) {
  const std::size_t end = std::min(length(bytes), frames_compared_ * size.bytes + mark_.size() - 1);
  const Bytes compared = bytes.first(end - taken_);
  if (frame_size()) count_marks(compared, size.bytes);
  // At the end of the stream there may be fewer than needed: two, or the one of a stream that is nothing but a frame.
  const bool is_one_frame = frame_size() && bytes.size() == size.bytes;
  const std::size_t fewest = is_one_frame ? 1 : frame_size() ? 2 : kMarksForUnknownSize;
  forget_taken_marks(size);
  std::size_t phase = std::max(size.known_until, position()) - position();
  for (; phase < size.bytes && phase + mark_.size() <= end && size.chains.size() <= chains_.size(); ++phase) {
    const std::size_t possible = 1 + (end - mark_.size() - phase) / size.bytes;
    const std::size_t missing = missing_marks(compared, {phase, size.bytes, false}, possible);
    const bool may_be_whole = missing == 0 || (missing == 1 && possible >= kMarksForKnownSize);
    if (!may_be_whole) continue;
    const bool has_frame = phase + size.bytes <= compared.size();
    if (has_frame && !fits(compared.subspan(phase, size.bytes))) continue;
    const bool is_whole = missing == 0 && possible >= fewest && phase + size.bytes <= end;
    size.chains.push_back({position() + phase, size.bytes, is_whole});
  }
  size.known_until = position() + phase;
  if (!frame_size() && !size.chains.empty() && is_size_of_last_frame(size.bytes)) count_marks(compared, size.bytes);
}

/// A first mark that is no longer in the window, or only in part, is missing.
void MarkChainDecoder::forget_taken_marks(Size& size) const noexcept {
  const auto is_cut = [&](const Chain& chain) { return chain.start > position() && chain.start < position() + taken_; };
  std::erase_if(size.chains,
                [&](const Chain& chain) { return chain.start < position() || (is_cut(chain) && !chain.is_whole); });
  for (Chain& chain : size.chains) chain.is_whole = chain.is_whole && !is_cut(chain);
}

void MarkChainDecoder::count_marks(Bytes bytes, std::size_t frame_size) {
  marks_in_phase_.assign(frame_size, 0);
  if (mark_at(bytes, 0) && taken_ > 0) ++marks_in_phase_[0];
  auto mark = bytes.begin();
  while ((mark = std::search(mark, bytes.end(), mark_.begin(), mark_.end())) != bytes.end()) {
    ++marks_in_phase_[(taken_ + static_cast<std::size_t>(mark - bytes.begin())) % frame_size];
    ++mark;
  }
}

/// No more than two are counted where the size is not known.
std::size_t MarkChainDecoder::missing_marks(Bytes bytes, const Chain& chain, std::size_t possible) const noexcept {
  if (frame_size()) return possible - marks_in_phase_[chain.start];
  std::size_t missing = 0;
  for (std::size_t k = 0; k < possible && missing < 2; ++k) {
    if (!mark_at(bytes, chain.start + k * chain.frame_size)) ++missing;
  }
  return missing;
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
  if (!is_size_of_last_frame(chain.frame_size)) return false;
  auto reading = last_payload_.begin();
  while ((reading = std::search(reading, last_payload_.end(), mark_.begin(), mark_.end())) != last_payload_.end()) {
    const std::size_t distance = mark_.size() + static_cast<std::size_t>(reading - last_payload_.begin());
    if (marks_in_phase_[(chain.start + chain.frame_size - distance) % chain.frame_size] > 0) return true;
    ++reading;
  }
  return false;
}

}  // namespace dermis::bytes::layouts
