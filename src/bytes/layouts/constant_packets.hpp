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

#include "bytes/layouts/frame_fields.hpp"
#include "bytes/layouts/mark_chain_decoder.hpp"
#include "bytes/layouts/packet_match.hpp"
#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::layouts {

/// The size of a packet that is a whole frame without a checksum, whatever it holds; empty where it is no such one.
[[nodiscard]] std::optional<std::size_t> size_of_frame(const Layout& layout, const PacketLayout::Packet& packet);

/// Each packet of the layout is a whole frame without a checksum. They have the same mark, and sizes that differ.
[[nodiscard]] bool has_constant_sizes(const Layout& layout);

/// Packets that has_constant_sizes(). Those of several layouts have the same mark and differ in size. The distance of
/// the marks shows which one holds.
class ConstantPackets final : public MarkChainDecoder {
 public:
  using MarkChainDecoder::FirstMark;

  ConstantPackets(const std::vector<std::shared_ptr<const Layout>>& layouts, std::size_t array, FirstMark first);

  /// Empty where it depends on the layout.
  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override;
  [[nodiscard]] std::string_view request() const noexcept override;
  [[nodiscard]] std::string advice() const override;

 private:
  /// A packet of a layout, and how it is read.
  struct Form {
    Form(const Layout& of_packets, const PacketLayout::Packet& packet, std::size_t array);

    [[nodiscard]] bool fits(std::span<const std::uint8_t> packet);

    Layout layout;  ///< That packet without the mark, which may be damaged.
    std::size_t size;
    PacketMatch match;
    FrameFields fields;
  };

  [[nodiscard]] Form& form_of(std::size_t size) noexcept;
  [[nodiscard]] bool fits(std::span<const std::uint8_t> packet) override;
  [[nodiscard]] bool read(std::span<const std::uint8_t> packet, RawFrame& frame) override;
  void begin_again() override;

  std::shared_ptr<const Layout> first_;  ///< Owns the mark.
  std::size_t array_;
  std::vector<std::unique_ptr<Form>> forms_;
  bool is_sending_ = false;
};

}  // namespace dermis::bytes::layouts
