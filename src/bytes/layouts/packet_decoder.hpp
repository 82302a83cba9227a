// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bytes/layouts/frame_assembly.hpp"
#include "bytes/layouts/packet_match.hpp"
#include "dermis/bytes/layouts/byte_window.hpp"
#include "dermis/bytes/layouts/decoder.hpp"
#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::layouts {

/// Frames of a PacketLayout.
class PacketDecoder final : public Decoder {
 public:
  PacketDecoder(std::shared_ptr<const Layout> layout, std::size_t array);

  void push(std::span<const std::uint8_t> bytes) override;
  [[nodiscard]] bool next(RawFrame& frame) override;
  void idle() override { input_.is_idle = true; }
  void finish() override { input_.has_ended = true; }
  [[nodiscard]] std::uint64_t frame_end() const noexcept override { return frame_end_; }
  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override { return layout_->arrays[array_].shape; }
  [[nodiscard]] const DecoderCounts& counts() const noexcept override { return assembly_.counts(); }
  [[nodiscard]] std::string_view request() const noexcept override { return layout_->request_after(is_sending_); }
  [[nodiscard]] std::string advice() const override;

 private:
  /// The result of next_packet().
  enum class Found { nothing, packet, frame };

  /// The outcome of the bytes, and the match of their packet where it is whole.
  struct Reading {
    PacketMatch::Outcome outcome = PacketMatch::Outcome::foreign;
    PacketMatch* match = nullptr;
  };

  [[nodiscard]] Found next_packet(RawFrame& frame);
  [[nodiscard]] Reading read(std::span<const std::uint8_t> bytes);
  [[nodiscard]] PacketMatch* match_of(std::span<const std::uint8_t> plain);
  [[nodiscard]] Found next_escaped(RawFrame& frame);
  [[nodiscard]] bool is_followed_by_packet(std::span<const std::uint8_t> rest) const noexcept;
  [[nodiscard]] bool is_further(std::size_t fields) const noexcept;
  void keep_misfit(std::size_t fields, const std::string& text);
  [[nodiscard]] std::string without_packet() const;
  void drop(std::size_t bytes);
  Found skip(std::size_t bytes);
  Found take(PacketMatch& match, std::span<const std::uint8_t> packet, std::size_t bytes, RawFrame& frame);

  std::shared_ptr<const Layout> layout_;
  const PacketLayout& form_;
  std::size_t array_;
  std::array<bool, 256> begins_mark_{};  ///< [byte]
  ByteWindow window_;
  std::vector<PacketMatch> matches_;  ///< [packets of the layout]
  struct {
    std::size_t needed = 0;  ///< Bytes, before more can be said.
    std::size_t match = 0;   ///< Those before do not fit.
    bool is_begun = false;   ///< That match has read some of it.
    PacketMatch::Outcome outcome = PacketMatch::Outcome::foreign;
  } front_;  ///< What the window begins with.
  FrameAssembly assembly_;
  Piece piece_;
  std::vector<float> numbers_;  ///< Of the last packet.
  struct {
    std::size_t longest = 0;            ///< Bytes of a packet.
    std::size_t searched = 0;           ///< Bytes of the window that are known to hold no delimiter.
    std::vector<std::uint8_t> plain{};  ///< A packet whose escapes are undone.
  } escaped_;
  std::uint64_t frame_end_ = 0;
  struct {
    std::string text{};
    std::size_t fields = 0;  ///< That did fit.
  } misfit_;                 ///< By a packet before the first frame.
  bool is_sending_ = false;
  struct {
    bool has_ended = false;
    bool is_idle = false;
  } input_;
};

}  // namespace dermis::bytes::layouts
