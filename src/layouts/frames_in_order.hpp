// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "dermis/layouts/decoder.hpp"

namespace dermis::layouts {

/// Puts the frames of a decoder in order by the device's time, where they come up to a second late. All of them have
/// one.
class FramesInOrder final : public Decoder {
 public:
  explicit FramesInOrder(std::unique_ptr<Decoder> decoder) : decoder_(std::move(decoder)) {}

  void push(std::span<const std::uint8_t> bytes) override { decoder_->push(bytes); }
  [[nodiscard]] bool next(RawFrame& frame) override;
  void idle() override { decoder_->idle(); }
  void finish() override;
  [[nodiscard]] std::uint64_t frame_end() const noexcept override { return decoder_->frame_end(); }
  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override { return decoder_->shape(); }
  [[nodiscard]] const DecoderCounts& counts() const noexcept override { return counts_; }
  [[nodiscard]] std::string_view request() const noexcept override { return decoder_->request(); }
  [[nodiscard]] std::string advice() const override { return decoder_->advice(); }

 private:
  void insert(const RawFrame& frame);
  [[nodiscard]] bool release(RawFrame& frame);

  std::unique_ptr<Decoder> decoder_;
  std::deque<RawFrame> waiting_;  ///< By time.
  std::optional<std::uint64_t> last_number_;
  DecoderCounts counts_;
  bool has_ended_ = false;
};

}  // namespace dermis::layouts
