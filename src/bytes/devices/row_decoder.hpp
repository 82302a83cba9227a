// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bytes/devices/row_layout.hpp"
#include "bytes/devices/row_syntax.hpp"
#include "dermis/bytes/devices/protocol.hpp"
#include "dermis/bytes/layouts/line_reader.hpp"
#include "dermis/touch/frames/frame_source.hpp"

namespace dermis::bytes::devices {

/// Frames as text: a line per row and a separator between frames, or a line per frame. Unknown sizes are learnt from
/// frames that repeat. The bytes are kept meanwhile, so that these frames are delivered too. A frame is delivered with
/// its last row, and the line after it has to be a separator.
class RowDecoder : public Decoder {
 public:
  RowDecoder(const RowSyntax& syntax, const std::optional<FrameShape>& shape);

  void push(std::span<const std::uint8_t> bytes) override;
  [[nodiscard]] bool next(RawFrame& frame) override;
  void idle() override;
  void finish() override { ended_ = true; }
  [[nodiscard]] std::uint64_t frame_end() const noexcept override { return frame_end_; }
  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override {
    return layout_ ? layout_->shape : learner_.shape();
  }
  [[nodiscard]] std::string advice() const override;
  [[nodiscard]] std::optional<FrameShape> likely_shape() const override { return learner_.likely_shape(); }
  [[nodiscard]] const DecoderCounts& counts() const noexcept override { return counts_; }

 private:
  void learn(std::span<const std::uint8_t> line);
  void begin_if_learnt();

  [[nodiscard]] bool decode_line(std::span<const std::uint8_t> line);
  [[nodiscard]] bool add_row(std::size_t bytes);
  [[nodiscard]] bool fits(const ParsedLine& line) const noexcept;
  void add_separator();
  void damage(std::size_t bytes);
  void end_stream();

  RowSyntax syntax_;
  layouts::LineReader lines_;
  RowLayoutLearner learner_;
  std::optional<RowLayout> layout_;

  std::vector<float> line_;    // its values: of a clock, too
  std::vector<float> values_;  // of the frame that is being read
  std::size_t row_ = 0;        // its rows so far
  std::size_t row_bytes_ = 0;  // and their bytes
  std::size_t rows_since_separator_ = 0;
  bool complete_ = false;  // the frame is delivered, its separator has not come
  bool damaged_ = false;   // all up to the next separator is skipped
  bool ended_ = false;
  std::uint64_t frame_end_ = 0;
  DecoderCounts counts_;
};

}  // namespace dermis::bytes::devices
