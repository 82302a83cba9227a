// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bytes/layouts/frame_fields.hpp"
#include "bytes/layouts/stream_checksum.hpp"
#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::layouts {

/// Bytes of so many numbers.
[[nodiscard]] std::size_t bytes_of(const WireType& type, std::size_t count) noexcept;

/// Where the fields of packets wrap.
[[nodiscard]] Moduli moduli_of(const PacketLayout& layout);

/// Reads one of the packets of a layout. Keeps the readings of one array of those that a packet has.
class PacketMatch {
 public:
  enum class Outcome {
    whole,       ///< A packet of size() bytes.
    unfinished,  ///< More bytes may make it one.
    foreign,     ///< No packet.
    damaged,     ///< A packet whose checksum is wrong.
  };

  /// `packet` is one of the layout.
  PacketMatch(const Layout& layout, const PacketLayout::Packet& packet, std::size_t array);

  /// Reads the packet that the bytes begin with, but for its readings. `position` is that of the bytes in the stream;
  /// it never falls. A packet costs as much as it has fields, however large it is.
  [[nodiscard]] Outcome read(std::span<const std::uint8_t> bytes, std::uint64_t position, Piece& piece);

  /// `numbers` become the readings of the array that is wanted, of the packet that was whole.
  void read_numbers(std::span<const std::uint8_t> bytes, std::vector<float>& numbers) const;

  [[nodiscard]] const PacketLayout::Packet& packet() const noexcept { return packet_; }
  [[nodiscard]] bool has_checksum() const noexcept { return has_checksum_; }
  [[nodiscard]] std::size_t size() const noexcept { return at_; }
  /// Fewer bytes than so many leave the last one unfinished.
  [[nodiscard]] std::size_t needed() const noexcept { return needed_; }
  /// How many fields of the last one did fit.
  [[nodiscard]] std::size_t fitted() const noexcept { return misfit_; }
  /// "packet[3], a checksum, is 5F where 33 is expected", of the last one that did not fit.
  [[nodiscard]] std::string misfit() const;

 private:
  /// Numbers of the array that is wanted.
  struct Numbers {
    std::size_t at;
    std::size_t count;
    const WireType* type;
  };

  [[nodiscard]] Outcome read_field(std::size_t place, std::span<const std::uint8_t> bytes, std::uint64_t position,
                                   Piece& piece);
  [[nodiscard]] Outcome unfinished(std::size_t needed) noexcept;
  [[nodiscard]] Outcome read_literal(const PacketField& field, std::span<const std::uint8_t> bytes);
  [[nodiscard]] Outcome read_values(const PacketField& field, std::span<const std::uint8_t> bytes, const Piece& piece);
  [[nodiscard]] bool use(const PacketField& field, double number, Piece& piece);
  [[nodiscard]] std::size_t count_of(const PacketField& field, std::size_t array, const Piece& piece) const noexcept;

  const Layout& layout_;
  const PacketLayout::Packet& packet_;
  std::size_t array_;
  bool names_array_;  ///< A field says whose readings a packet has.
  bool has_checksum_;
  std::vector<std::size_t> shares_;        ///< Fields of each array, which share its readings.
  std::vector<StreamChecksum> checksums_;  ///< [fields]
  std::vector<Numbers> numbers_;
  std::size_t count_ = 0;  ///< Readings so far.
  std::size_t at_ = 0;
  std::size_t needed_ = 0;
  std::optional<std::uint64_t> given_count_;
  std::optional<std::uint64_t> end_;  ///< As a field `length` says.
  std::size_t misfit_ = 0;            ///< The field that did not fit.
};

}  // namespace dermis::bytes::layouts
