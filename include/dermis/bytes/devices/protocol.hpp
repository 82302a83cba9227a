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

#include "dermis/bytes/devices/encoder.hpp"
#include "dermis/bytes/layouts/decoder.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::layouts {
struct Layout;
}  // namespace dermis::bytes::layouts

namespace dermis::bytes::devices {

using layouts::Decoder;
using layouts::DecoderCounts;

/// A device protocol and its options; docs/protocols.md describes each.
struct ProtocolOptions {
  std::string name = "auto";           ///< One of protocol_names(): flexitac, 3dvitac, wiresens, ... or auto.
  std::optional<FrameShape> shape{};   ///< Empty: the protocol's own or learned from the bytes. 1x1 ... 1024x1024.
  std::size_t nodes_per_packet = 120;  ///< wiresens: readings in a packet, 1 ... 32767.
  bool delimited = true;               ///< wiresens: "wr" ends a packet (serial); false: bare packets (TCP, UDP).
  int bit_shift = 5;                   ///< stag: bits of the low byte of a reading, 5 or 6.
  std::string layout{};        ///< Path of a description of the bytes (layouts/layout.hpp), which replaces `name`.
  std::string layout_keys{};   ///< Text of such a description, in place of its path.
  std::string array{};         ///< layout: the array whose frames are wanted; empty: the only one.
  bool is_whole_file = false;  ///< layout: the bytes are a file (layouts/layout.hpp).
  bool datagrams = false;      ///< Frames may come late or twice (UDP); those with a number are then dropped.

  [[nodiscard]] bool has_layout() const noexcept { return !layout.empty() || !layout_keys.empty(); }
};

/// "flexitac", "3dvitac", ..., and "auto" at the end.
[[nodiscard]] const std::vector<std::string>& protocol_names();

/// Fails on an unknown name, with the nearest known one. Fails on shapes and options that the protocol cannot have, and
/// on a layout that cannot be read.
[[nodiscard]] Result<std::unique_ptr<Decoder>> make_decoder(const ProtocolOptions& options);

/// The same; `shape` is required, and "auto" cannot be encoded.
[[nodiscard]] Result<std::unique_ptr<Encoder>> make_encoder(const ProtocolOptions& options);

/// The layout of options that have one.
[[nodiscard]] Result<layouts::Layout> read_layout(const ProtocolOptions& options);

/// The unit of a reading by that layout: counts, volts, ohms, kPa or newtons.
[[nodiscard]] Result<std::string> unit_of(const ProtocolOptions& options);

/// Name of the protocol whose decoder finds the most frames in the bytes; empty if none finds any.
[[nodiscard]] std::string detect_protocol(std::span<const std::uint8_t> bytes);

}  // namespace dermis::bytes::devices
