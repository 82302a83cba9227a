// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dermis/bytes/layouts/decoder.hpp"

namespace dermis::bytes::layouts {

/// Frames of a decoder, in order by the device's time. A frame with the number, time and readings of the one before is
/// dropped.
class FramesInOrder final : public Decoder {
 public:
  /// Frames that come up to a second late: are put in order, for which each frame waits, or are dropped.
  enum class Late { wait_for, drop };

  FramesInOrder(std::unique_ptr<Decoder> decoder, Late late) : decoder_(std::move(decoder)), late_(late) {}

  void push(std::span<const std::uint8_t> bytes) override { decoder_->push(bytes); }
  [[nodiscard]] bool next(RawFrame& frame) override;
  void idle() override { decoder_->idle(); }
  void finish() override;
  [[nodiscard]] std::uint64_t frame_end() const noexcept override { return frame_end_; }
  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override { return decoder_->shape(); }
  [[nodiscard]] const DecoderCounts& counts() const noexcept override { return counts_; }
  [[nodiscard]] std::string_view request() const noexcept override { return decoder_->request(); }
  [[nodiscard]] std::string advice() const override { return decoder_->advice(); }

 private:
  using Place = std::pair<std::uint64_t, Nanos>;  ///< Run and time.

  struct Waiting {
    RawFrame frame;
    std::uint64_t end = 0;  ///< frame_end() of the decoder.
  };

  [[nodiscard]] bool find_next(RawFrame& frame);
  [[nodiscard]] bool repeats(const RawFrame& frame);
  [[nodiscard]] bool is_late(const RawFrame& frame) const noexcept;
  void insert(const RawFrame& frame);
  [[nodiscard]] bool release(RawFrame& frame, bool is_all_there);
  void deliver(RawFrame& frame, std::uint64_t end);

  std::unique_ptr<Decoder> decoder_;
  Late late_;
  std::multimap<Place, Waiting> waiting_;
  std::uint64_t run_ = 0;  ///< Frames before a restart of the device, or before one without a time, are another run.
  Acquisition last_;       ///< Of the frame that came last,
  std::vector<float> last_counts_;  ///< and its readings.
  std::optional<Nanos> delivered_time_;
  std::optional<std::uint64_t> delivered_number_;
  DecoderCounts counts_;
  std::uint64_t frame_end_ = 0;
  bool has_ended_ = false;
};

}  // namespace dermis::bytes::layouts
