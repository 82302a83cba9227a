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

/// The size of the packets of a layout, where all have the same, a whole frame, a mark, and no checksum; else empty.
[[nodiscard]] std::optional<std::size_t> constant_size(const Layout& layout);

/// Packets of constant_size(). Where there are several layouts, they have the same mark and differ in size. The
/// distance of the marks shows which one holds.
class ConstantPackets final : public MarkChainDecoder {
 public:
  using MarkChainDecoder::FirstMark;

  ConstantPackets(const std::vector<std::shared_ptr<const Layout>>& layouts, std::size_t array, FirstMark first);

  /// Empty where it depends on the layout.
  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override;
  [[nodiscard]] std::string_view request() const noexcept override;
  [[nodiscard]] std::string advice() const override;

 private:
  /// A layout, and how its packets are read.
  struct Form {
    Form(const Layout& with_mark, std::size_t array);

    Layout layout;  ///< Without the mark, which may be damaged.
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
  std::vector<float> numbers_;  ///< Of packets that are only tried.
  bool is_sending_ = false;
};

}  // namespace dermis::bytes::layouts
