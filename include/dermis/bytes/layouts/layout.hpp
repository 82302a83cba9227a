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
#include <variant>
#include <vector>

#include "dermis/bytes/layouts/decoder.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

/// How bytes make frames, described (docs/layouts.md): lines of text, or packets.
namespace dermis::bytes::layouts {

/// An array whose readings are in the bytes.
struct LayoutArray {
  std::string name;  ///< Empty where there is but one.
  FrameShape shape;  ///< 1x1 ... 1024x1024
  /// What a field `array` holds before its readings; empty: its name.
  std::optional<std::uint64_t> id{};
};

/// The content of a field of a line or packet.
enum class Role {
  literal,      ///< These very bytes.
  skip,         ///< Anything.
  values,       ///< Readings of one array.
  row,          ///< The row of the readings, from 0 on.
  col,          ///< The column of the reading, from 0 on.
  first,        ///< The taxel of the first of the readings, row-major, from 0 on.
  count,        ///< How many readings follow.
  array,        ///< The id or name of the array whose readings follow.
  frame,        ///< The number of the frame.
  time,         ///< In `unit` seconds, since any moment.
  clock,        ///< Time of day, "18:45:00.125"; text only.
  datetime,     ///< "2026-11-27 18:45:00.125", or with a T; text only.
  temperature,  ///< [C] after `unit` and `offset`. Several are those of the sensors of the array, in their order.
  supply,       ///< [V] after `unit`.
  flags,        ///< Remarks of the device on the frame.
  length,       ///< Bytes of the packet from behind this field on, less `offset`.
  checksum,     ///< Of the packet up to here.
};

/// A field of a line.
struct TextField {
  Role role = Role::literal;
  std::string literal{};   ///< Where it is one. Blanks in it stand for any blanks.
  std::size_t array = 0;   ///< values: place in Layout::arrays.
  double unit = 1.0;       ///< Factor on its number.
  std::uint64_t from = 0;  ///< row, col, first: the number of the first one.
  std::size_t count = 0;   ///< values: how many; 0: all of a taxel, a row or the frame, as the line says.
  bool is_hexadecimal = false;
  std::size_t width = 0;  ///< Digits of its number, behind which another field may follow at once; 0: any.
};

/// Lines of text. A line that fits none of the patterns holds no readings.
struct TextLayout {
  using Pattern = std::vector<TextField>;
  /// The first that a line fits holds. One without readings is the head of the frame, or of its part, that follows.
  std::vector<Pattern> lines;
  std::string line_end{};     ///< Empty: LF, or CR LF.
  std::string separator{};    ///< Between readings; empty: blanks, and one comma or semicolon.
  std::string comment{};      ///< Lines that begin with it are skipped; empty: none are.
  std::string frame_begin{};  ///< A line that begins with it begins a frame, and may go on as a row; empty: none.
  /// Ends a frame where rows carry no number: a line that begins with it, or for "" an empty one.
  std::optional<std::string> frame_end{};
  std::size_t width = 0;  ///< Characters of a reading, which then need no separator; 0: any.
  char decimal_point = '.';
  bool is_hexadecimal = false;
};

/// How a number stands in a packet.
struct WireType {
  enum class Kind { whole, negative, real };  ///< Without a sign, with one, or IEEE 754.
  Kind kind = Kind::whole;
  unsigned bits = 8;  ///< 8 ... 32, 64; 10 and 12 are packed without gaps.
  bool is_big_endian = false;
  std::uint64_t mask = 0;  ///< Bits of the number that count, of a number without a sign; 0: all.
};

/// A checksum over the bytes of a packet from `from` on to where it stands.
struct Checksum {
  enum class Kind { sum, exclusive_or, crc };
  Kind kind = Kind::sum;
  std::size_t from = 0;
  std::uint32_t polynomial = 0;  ///< crc: without its highest bit.
  std::uint32_t initial = 0;     ///< crc
  std::uint32_t final_xor = 0;   ///< Of the result.
  bool is_reflected = false;     ///< crc: of bytes and remainder.
  bool is_negated = false;       ///< Sums: all bytes and the checksum add up to 0.
};

/// CRC-32 as in zlib, of 32 bits.
inline constexpr Checksum kCrc32{.kind = Checksum::Kind::crc,
                                 .polynomial = 0x04C11DB7U,
                                 .initial = 0xFFFFFFFFU,
                                 .final_xor = 0xFFFFFFFFU,
                                 .is_reflected = true};

/// A field of a packet.
struct PacketField {
  Role role = Role::literal;
  std::vector<std::uint8_t> literal{};  ///< Where it is one.
  WireType type{};
  std::size_t array = 0;  ///< values: place in Layout::arrays.
  /// values: how many; 0: its share of what the array has, or as a field `count` says. skip: bytes.
  std::size_t count = 0;
  double unit = 1.0;    ///< Factor on its number.
  double offset = 0.0;  ///< Added then.
  Checksum checksum{};
};

/// A byte that is sent as the escape and a code.
struct Substitute {
  std::uint8_t code = 0;
  std::uint8_t byte = 0;
};

/// Packets of bytes. They begin or end with a literal, are escaped, or are frames of one size without a mark.
struct PacketLayout {
  using Packet = std::vector<PacketField>;
  enum class Escape { none, cobs, slip, stuffed, substituted };
  std::vector<Packet> packets;  ///< The first that the bytes fit holds.
  Escape escape = Escape::none;
  std::uint8_t delimiter = 0;    ///< stuffed, substituted: between two packets,
  std::uint8_t escape_byte = 0;  ///< stuffed, substituted: before a byte that is changed,
  std::uint8_t escape_xor = 0;   ///< stuffed: by this.
  std::vector<Substitute> substitutes{};
};

/// Values of the field `flags` with a meaning.
struct LayoutFlags {
  std::vector<std::uint64_t> absent{};   ///< The readings of the frame are none.
  std::vector<std::uint64_t> late{};     ///< The frame is late; frames are put in order by their times anyway.
  std::vector<std::uint64_t> corrupt{};  ///< The frame is dropped as damaged.
};

/// Numbers from one to another, both included.
struct NumberRange {
  double least = 0.0;
  double most = 0.0;
};

/// A description of bytes.
struct Layout {
  std::vector<LayoutArray> arrays;  ///< At least one, with different names.
  std::variant<TextLayout, PacketLayout> form;
  double scale = 1.0;  ///< A reading is scale * number + offset.
  double offset = 0.0;
  std::vector<NumberRange> absent{};  ///< Numbers that mean no reading.
  LayoutFlags flags{};
  std::string unit = "counts";      ///< Of a reading: counts, volts, ohms, kPa or newtons.
  std::optional<double> rate_hz{};  ///< Frames a second: times of a file without times, and how often one asks.

  std::string start{};    ///< Bytes sent to the device until its first frame comes; empty: it starts on its own.
  std::string request{};  ///< Bytes sent to the device before each frame; empty: frames come on their own.

  [[nodiscard]] bool has_times() const;
  [[nodiscard]] bool has_numbers() const;
  /// Bytes that the device needs next. `is_sending`: a frame has come since it was connected.
  [[nodiscard]] std::string_view request_after(bool is_sending) const noexcept;
  /// Place of the array of that name; an empty name is that of the only one. Fails with the names.
  [[nodiscard]] Result<std::size_t> find_array(const std::string& name) const;
};

/// "AA 55", as bytes stand in a packet.
[[nodiscard]] std::string hexadecimal(std::span<const std::uint8_t> bytes);

/// Reads a TOML file with a table [layout]. Errors name the file, the line and the key.
[[nodiscard]] Result<Layout> read_layout(const std::string& path);
/// The same from memory; `name` stands for the path in messages.
[[nodiscard]] Result<Layout> layout_from_toml(std::string_view text, const std::string& name);

/// Decodes the packets of a device that has one of these layouts. Where there are several, their packets have a
/// constant size and no checksum; they differ in size and have the same mark.
[[nodiscard]] std::unique_ptr<Decoder> make_decoder(const std::vector<std::shared_ptr<const Layout>>& layouts);

/// Decodes the frames of one array of the layout. Those of a whole file wait for others that come up to a second
/// late, and are put in order. The last line of a file needs no end. Late frames of a device are dropped.
/// Thread-compatible.
[[nodiscard]] std::unique_ptr<Decoder> make_decoder(std::shared_ptr<const Layout> layout, std::size_t array,
                                                    bool is_whole_file);

}  // namespace dermis::bytes::layouts
