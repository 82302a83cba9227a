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

/// Reads one of the packets of a layout. Keeps the readings of one array of those that a packet has. read() is asked at
/// every byte of a stream. So it looks at a field once, and only at a field that can refuse the packet.
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

  /// Other bytes are read next. `position` is theirs in the stream; it never falls.
  void begin(std::uint64_t position) noexcept;

  /// Whether the bytes begin with a packet. One that was unfinished goes on with the same bytes and more behind them. A
  /// packet costs as much as it has fields, however large it is.
  [[nodiscard]] Outcome read(std::span<const std::uint8_t> bytes);

  /// The content of the packet that was whole; `numbers` become the readings of the array that is wanted.
  void read_content(std::span<const std::uint8_t> bytes, Piece& piece, std::vector<float>& numbers);

  [[nodiscard]] const PacketLayout::Packet& packet() const noexcept { return packet_; }
  [[nodiscard]] bool has_checksum() const noexcept { return has_checksum_; }
  [[nodiscard]] std::size_t size() const noexcept { return so_far_.at; }
  /// Fewer bytes than so many leave the last one unfinished.
  [[nodiscard]] std::size_t needed() const noexcept { return so_far_.needed; }
  /// How many fields of the last one did fit.
  [[nodiscard]] std::size_t fitted() const noexcept { return so_far_.place; }
  /// "packet[3], a checksum, is 5F where 33 is expected", of the last one that did not fit.
  [[nodiscard]] std::string misfit() const;

 private:
  /// Numbers of the array that is wanted.
  struct Numbers {
    std::size_t at;
    std::size_t count;
    const WireType* type;
  };

  /// A number that no packet is refused for.
  struct Remark {
    std::size_t at;
    const PacketField* field;
  };

  [[nodiscard]] Outcome read_field(std::span<const std::uint8_t> bytes);
  [[nodiscard]] Outcome unfinished(std::size_t needed) noexcept;
  [[nodiscard]] Outcome read_literal(const PacketField& field, std::span<const std::uint8_t> bytes);
  [[nodiscard]] Outcome read_values(const PacketField& field, std::span<const std::uint8_t> bytes);
  [[nodiscard]] bool use(const PacketField& field, double number);
  [[nodiscard]] std::size_t count_of(const PacketField& field, std::size_t array) const noexcept;

  const Layout& layout_;
  const PacketLayout::Packet& packet_;
  std::size_t array_;
  bool names_array_;  ///< A field says whose readings a packet has.
  bool has_checksum_;
  std::vector<std::size_t> shares_;        ///< Fields of each array, which share its readings.
  std::vector<StreamChecksum> checksums_;  ///< [fields]
  std::vector<bool> are_remarks_;          ///< [fields]
  Piece piece_;                            ///< So far, without remarks.
  std::vector<Numbers> numbers_;
  std::vector<Remark> remarks_;
  struct {
    std::uint64_t position = 0;
    std::size_t place = 0;  ///< The field that comes next, or did not fit.
    std::size_t at = 0;
    std::size_t count = 0;   ///< Readings.
    std::size_t needed = 0;  ///< Bytes.
    std::optional<std::uint64_t> given_count{};
    std::optional<std::uint64_t> end{};  ///< As a field `length` says.
  } so_far_;
};

}  // namespace dermis::bytes::layouts
