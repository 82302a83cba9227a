// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// protocol=auto: all protocols try to decode the first bytes of a stream; the one that finds frames is chosen.
#include <algorithm>
#include <functional>
#include <utility>

#include "bytes/devices/protocols.hpp"
#include "bytes/devices/wiresens_packets.hpp"
#include "dermis/bytes/proposals/look.hpp"

namespace dermis::bytes::devices {
namespace {

constexpr std::size_t kMostKept = std::size_t{256} * 1024;  // bytes
constexpr std::size_t kStep = 256;                          // bytes between two looks at what the decoders have found
constexpr std::size_t kFirstWiresensTrial = 16 * kStep;  // bytes; the next ones after twice as many, as it is not cheap
constexpr std::uint64_t kFramesWithoutChecksum = 4;

/// Those that are tried, the strictest first.
std::vector<const ProtocolEntry*> by_strictness() {
  std::vector<const ProtocolEntry*> entries;
  for (const ProtocolEntry& entry : protocol_entries()) {
    if (entry.strictness) entries.push_back(&entry);
  }
  std::ranges::stable_sort(entries, std::ranges::greater(), [](const auto* entry) { return *entry->strictness; });
  return entries;
}

struct Candidate {
  std::string_view name;
  std::uint64_t frames_needed;
  ProtocolOptions options;
  std::unique_ptr<Decoder> decoder;

  /// Enough frames, and most bytes up to the last one belong to frames.
  [[nodiscard]] bool convinces() const noexcept {
    return decoder->counts().frames >= frames_needed && decoder->counts().skipped_bytes <= decoder->frame_end() / 2;
  }
};

void drain(Decoder& decoder, RawFrame& frame) {
  while (decoder.next(frame)) {
  }
}

/// Shows the same bytes to all decoders.
class ProtocolDetector {
 public:
  /// Known options are taken as they are. `name_only`: protocols whose frames need further options count, too.
  ProtocolDetector(const ProtocolOptions& known, bool name_only) : known_(known), name_only_(name_only) {
    for (const ProtocolEntry* entry : by_strictness()) add(*entry, known_);
    if (name_only) {
      ProtocolOptions other_shift = known_;
      other_shift.bit_shift = 6;
      add(*find_protocol("stag"), other_shift);
      candidates_.push_back({"csv", kFramesWithoutChecksum, known_, make_csv_decoder(known_, true)});
      candidates_.push_back({"json", kFramesWithoutChecksum, known_, make_json_decoder(known_, true)});
    }
  }

  /// `bytes` are all so far, of which the last `step` are new.
  void look_at(std::span<const std::uint8_t> bytes, std::size_t step) {
    for (Candidate& candidate : candidates_) {
      candidate.decoder->push(bytes.last(step));
      drain(*candidate.decoder, frame_);
    }
    if (bytes.size() >= next_wiresens_trial_) {
      next_wiresens_trial_ = 2 * bytes.size();
      try_wiresens(bytes,
                   bytes.size() > kFirstWiresensTrial ? bytes.size() / 2 : 0);  // damage may be in the first half
    }
  }

  /// The device pauses; `bytes` and `step` as in look_at().
  void pause(std::span<const std::uint8_t> bytes, std::size_t step) {
    look_at(bytes, step);
    for (Candidate& candidate : candidates_) {
      candidate.decoder->idle();
      drain(*candidate.decoder, frame_);
    }
  }

  /// The stream ends.
  void finish(std::span<const std::uint8_t> bytes) {
    if (next_wiresens_trial_ <= kMostKept) try_wiresens(bytes, 0);
    for (Candidate& candidate : candidates_) {
      candidate.decoder->finish();
      drain(*candidate.decoder, frame_);
    }
  }

  /// The one that the bytes come from; null where none convinces, or where they are rather numbers of another layout.
  [[nodiscard]] const Candidate* best(std::span<const std::uint8_t> bytes) {
    const auto found =
        std::find_if(candidates_.begin(), candidates_.end(), [](const Candidate& one) { return one.convinces(); });
    if (found == candidates_.end() || bytes.size() < next_doubt_) return nullptr;
    if (!is_doubted(*found, bytes)) return &*found;
    next_doubt_ = 2 * bytes.size();
    return nullptr;
  }

 private:
  /// The protocols of text take any numbers.
  [[nodiscard]] bool is_doubted(const Candidate& candidate, std::span<const std::uint8_t> bytes) const {
    const std::optional<FrameShape> shape = candidate.decoder->shape();
    if (!shape || known_.shape || (candidate.name != "csv" && candidate.name != "json")) return false;
    return proposals::tell_otherwise(bytes, *shape, {});
  }

  void add(const ProtocolEntry& entry, ProtocolOptions options) {
    options.name = entry.name;
    Result<std::unique_ptr<Decoder>> decoder = make_decoder(options);
    if (!decoder) return;  // it cannot have the shape that is known
    const bool has_checksum = entry.strictness >= kHasChecksum;
    candidates_.push_back(
        {entry.name, has_checksum ? 1 : kFramesWithoutChecksum, std::move(options), std::move(decoder).value()});
  }

  /// Packets of WiReSens contain neither their size nor that of a frame: these are learnt first.
  void try_wiresens(std::span<const std::uint8_t> bytes, std::size_t from) {
    std::optional<ProtocolOptions> learnt = learn_wiresens(bytes.subspan(from), known_, name_only_);
    if (!learnt) return;
    const std::size_t before = candidates_.size();
    add(*find_protocol("wiresens"), *learnt);
    if (candidates_.size() == before) return;
    Decoder& decoder = *candidates_.back().decoder;
    for (std::size_t at = 0; at < bytes.size(); at += Decoder::kMaxPush) {
      decoder.push(bytes.subspan(at, std::min(Decoder::kMaxPush, bytes.size() - at)));
      drain(decoder, frame_);
    }
    next_wiresens_trial_ = kMostKept + 1;
  }

  ProtocolOptions known_;
  bool name_only_;
  std::vector<Candidate> candidates_;
  std::size_t next_wiresens_trial_ = kFirstWiresensTrial;
  std::size_t next_doubt_ = 0;  // bytes, after which a protocol that was doubted is looked at again
  RawFrame frame_;
};

/// Keeps the bytes until their protocol is detected, and decodes them then from the first on.
class AutoDecoder final : public Decoder {
 public:
  explicit AutoDecoder(const ProtocolOptions& options) : options_(options), detector_(start()) {}

  void push(std::span<const std::uint8_t> bytes) override {
    if (chosen_) return chosen_->push(bytes);
    if (ended_) give_up(kept_.size());
    ended_ = false;
    kept_.insert(kept_.end(), bytes.begin(), bytes.end());
  }

  bool next(RawFrame& frame) override {
    if (!chosen_) detect();
    const bool found = chosen_ && next_of_chosen(frame);
    if (chosen_) counts_ = chosen_->counts();
    counts_.skipped_bytes = given_up_ + (chosen_ ? chosen_->counts().skipped_bytes : 0);
    return found;
  }

  void idle() override {
    if (chosen_ && replayed_ == kept_.size()) return chosen_->idle();
    paused_ = true;
  }

  void finish() override {
    if (chosen_ && replayed_ == kept_.size()) return chosen_->finish();
    ended_ = true;
  }

  [[nodiscard]] std::uint64_t frame_end() const noexcept override {
    return chosen_ ? given_up_ + chosen_->frame_end() : 0;
  }
  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override {
    return chosen_ ? chosen_->shape() : options_.shape;
  }
  [[nodiscard]] const DecoderCounts& counts() const noexcept override { return counts_; }

  /// The letters hold the request of a STAG glove and are that of a pressure mat.
  [[nodiscard]] std::string_view request() const noexcept override {
    return chosen_ ? chosen_->request() : "start_reading\n";
  }
  [[nodiscard]] std::string advice() const override { return chosen_ ? chosen_->advice() : std::string(); }
  [[nodiscard]] std::string_view detected_protocol() const noexcept override { return name_; }

 private:
  [[nodiscard]] std::unique_ptr<ProtocolDetector> start() const {
    return std::make_unique<ProtocolDetector>(options_, false);
  }

  /// Looks after each kStep bytes, wherever the pieces end: the choice depends on the bytes alone.
  void detect() {
    while (kept_.size() - examined_ >= kStep || (ended_ && kept_.size() > examined_)) {
      const std::size_t step = std::min(kStep, kept_.size() - examined_);
      examined_ += step;
      detector_->look_at(std::span(kept_).first(examined_), step);
      if (choose()) return;
      if (examined_ >= kMostKept) give_up(examined_);
    }
    if (std::exchange(paused_, false) && !ended_) {
      const std::size_t step = kept_.size() - examined_;
      examined_ = kept_.size();
      detector_->pause(kept_, step);
      paused_ = choose();
      if (paused_) return;
    }
    if (!ended_) return;
    detector_->finish(kept_);
    if (choose()) return;
    give_up(kept_.size());
    ended_ = false;
  }

  bool choose() {
    const Candidate* const best = detector_->best(std::span(kept_).first(examined_));
    if (best == nullptr) return false;
    name_ = best->name;
    ProtocolOptions options = best->options;
    if (!options.shape) options.shape = best->decoder->shape();  // a pause may have shown it
    chosen_ = make_decoder(options).value();
    detector_.reset();
    return true;
  }

  void give_up(std::size_t bytes) {
    given_up_ += bytes;
    kept_.erase(kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(bytes));
    examined_ = 0;
    detector_ = start();
  }

  bool next_of_chosen(RawFrame& frame) {
    while (true) {
      if (chosen_->next(frame)) return true;
      if (replayed_ < kept_.size()) {
        const std::size_t size = std::min(kMaxPush, kept_.size() - replayed_);
        chosen_->push(std::span(kept_).subspan(replayed_, size));
        replayed_ += size;
      } else if (std::exchange(paused_, false)) {
        chosen_->idle();
      } else if (std::exchange(ended_, false)) {
        chosen_->finish();
      } else {
        return false;
      }
    }
  }

  ProtocolOptions options_;
  std::unique_ptr<ProtocolDetector> detector_;
  std::unique_ptr<Decoder> chosen_;
  std::string_view name_;
  std::vector<std::uint8_t> kept_;
  std::size_t examined_ = 0;
  std::size_t replayed_ = 0;
  std::uint64_t given_up_ = 0;
  bool paused_ = false;
  bool ended_ = false;
  DecoderCounts counts_;
};

}  // namespace

Result<std::unique_ptr<Decoder>> make_auto_decoder(const ProtocolOptions& options) {
  return std::unique_ptr<Decoder>(std::make_unique<AutoDecoder>(options));
}

std::string detect_protocol(std::span<const std::uint8_t> bytes) {
  const std::span<const std::uint8_t> first = bytes.first(std::min(bytes.size(), kMostKept));
  ProtocolDetector detector({}, true);
  for (std::size_t at = 0; at < first.size(); at += kStep) {
    const std::size_t step = std::min(kStep, first.size() - at);
    detector.look_at(first.first(at + step), step);
  }
  detector.finish(first);
  const Candidate* const best = detector.best(first);
  return best == nullptr ? std::string() : std::string(best->name);
}

}  // namespace dermis::bytes::devices
