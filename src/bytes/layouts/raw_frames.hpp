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

#include "bytes/layouts/frame_fields.hpp"
#include "bytes/layouts/packet_match.hpp"
#include "dermis/bytes/layouts/layout.hpp"
#include "dermis/bytes/layouts/window_decoder.hpp"

namespace dermis::bytes::layouts {

/// The layout has one packet, a whole frame of constant size without a mark, an escape or a checksum.
[[nodiscard]] bool is_one_frame(const Layout& layout);

/// Frames of such a layout, one behind the other from the first byte on. Bytes before a pause that are no whole frame
/// belong to none.
class RawFrames final : public WindowDecoder {
 public:
  RawFrames(std::shared_ptr<const Layout> layout, std::size_t array);

  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override { return layout_->arrays[array_].shape; }
  [[nodiscard]] std::string_view request() const noexcept override { return layout_->request_after(is_sending_); }
  [[nodiscard]] std::string advice() const override;

 private:
  [[nodiscard]] Verdict judge(std::span<const std::uint8_t> bytes, bool ended, RawFrame& frame) override;
  void begin_again() override { is_sending_ = false; }

  std::shared_ptr<const Layout> layout_;
  std::size_t array_;
  std::size_t size_;
  PacketMatch match_;
  FrameFields fields_;
  bool is_sending_ = false;
};

}  // namespace dermis::bytes::layouts
