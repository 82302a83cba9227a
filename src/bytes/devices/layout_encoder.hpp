// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "dermis/bytes/devices/encoder.hpp"
#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::devices {

/// Sends the packets of a layout: the first that carries the readings as they are, or else the first of all. Zeros
/// stand for skipped bytes.
class LayoutEncoder final : public Encoder {
 public:
  /// Packets of whole frames, without escapes, of literals, readings, numbers, times and checksums.
  explicit LayoutEncoder(std::shared_ptr<const layouts::Layout> layout)
      : layout_(std::move(layout)), packets_(std::get<layouts::PacketLayout>(layout_->form).packets) {}

  void encode(const RawFrame& frame, std::vector<std::uint8_t>& bytes) override;
  [[nodiscard]] std::string_view request() const noexcept override { return layout_->request_after(is_sending_); }

 private:
  [[nodiscard]] const layouts::PacketLayout::Packet& packet_for(const RawFrame& frame) const;
  void append(const layouts::PacketField& field, const RawFrame& frame, std::vector<std::uint8_t>& bytes) const;

  std::shared_ptr<const layouts::Layout> layout_;
  const std::vector<layouts::PacketLayout::Packet>& packets_;
  bool is_sending_ = false;
  std::uint64_t sequence_ = UINT64_MAX;
};

}  // namespace dermis::bytes::devices
