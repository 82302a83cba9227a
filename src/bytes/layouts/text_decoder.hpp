// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bytes/layouts/frame_assembly.hpp"
#include "bytes/layouts/line_match.hpp"
#include "dermis/bytes/layouts/decoder.hpp"
#include "dermis/bytes/layouts/layout.hpp"
#include "dermis/bytes/layouts/line_reader.hpp"

namespace dermis::bytes::layouts {

/// Frames of a TextLayout.
class TextDecoder final : public Decoder {
 public:
  TextDecoder(std::shared_ptr<const Layout> layout, std::size_t array, bool ends_last_line);

  void push(std::span<const std::uint8_t> bytes) override;
  [[nodiscard]] bool next(RawFrame& frame) override;
  void finish() override { has_ended_ = true; }
  [[nodiscard]] std::uint64_t frame_end() const noexcept override { return frame_end_; }
  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override { return layout_->arrays[array_].shape; }
  [[nodiscard]] const DecoderCounts& counts() const noexcept override { return assembly_.counts(); }
  [[nodiscard]] std::string_view request() const noexcept override { return layout_->request_after(is_sending_); }
  [[nodiscard]] std::string advice() const override;

 private:
  [[nodiscard]] bool read_lines(RawFrame& frame, std::size_t added);
  [[nodiscard]] std::span<const std::uint8_t> without_end(std::span<const std::uint8_t> line) const noexcept;
  [[nodiscard]] bool is_comment(std::span<const std::uint8_t> line) const noexcept;
  [[nodiscard]] bool ends_frame(std::span<const std::uint8_t> line) const noexcept;
  [[nodiscard]] bool read(std::span<const std::uint8_t> line, std::size_t bytes, RawFrame& frame);
  [[nodiscard]] bool add(std::size_t bytes, RawFrame& frame);
  void keep_misfit();
  /// Lines end with a sign.
  [[nodiscard]] bool breaks_are_blanks() const noexcept { return end_byte_ > ' '; }

  struct Misfit {
    std::string_view why;
    std::string text;
  };

  std::shared_ptr<const Layout> layout_;
  const TextLayout& text_;
  std::size_t array_;
  std::uint8_t end_byte_;
  bool ends_last_line_;  ///< The last line of a file needs no end.
  std::vector<std::uint8_t> unbroken_;
  LineReader lines_;
  LineMatch match_;
  FrameAssembly assembly_;
  Piece piece_;
  std::uint64_t line_number_ = 0;  ///< Of lines that end.
  std::uint64_t frame_end_ = 0;
  std::vector<Misfit> misfits_;  ///< Of lines before the first frame.
  bool has_ended_ = false;
  bool is_sending_ = false;
};

}  // namespace dermis::bytes::layouts
