// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

/// The bytes of MCAP (https://mcap.dev/spec). A record is its opcode, the length of its body as u64, and its body.
/// Numbers are little-endian; texts, maps and arrays begin with their length in bytes as u32.
namespace dermis::bytes::recordings {

static_assert(std::endian::native == std::endian::little, "numbers are copied as the machine holds them");

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
inline constexpr std::size_t kRecordHeaderBytes = 9;
inline constexpr std::size_t kFooterBytes = 20;

enum class Opcode : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0A,
  statistics = 0x0B,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

template <std::unsigned_integral T>
void append_number(Bytes& bytes, T value) {
  const std::size_t place = bytes.size();
  bytes.resize(place + sizeof(T));
  std::memcpy(bytes.data() + place, &value, sizeof(T));
}

inline void append_bytes(Bytes& bytes, ByteView more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

inline void append_characters(Bytes& bytes, std::string_view text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
}

inline void append_text(Bytes& bytes, std::string_view text) {
  append_number(bytes, static_cast<std::uint32_t>(text.size()));
  append_characters(bytes, text);
}

/// Writes the length in front of what is appended while it lives: of a record (u64) or of an array (u32).
template <std::unsigned_integral Length>
class LengthBefore {
 public:
  explicit LengthBefore(Bytes& bytes) : bytes_(bytes) {
    append_number(bytes_, Length{0});
    begin_ = bytes_.size();
  }
  LengthBefore(const LengthBefore&) = delete;
  LengthBefore& operator=(const LengthBefore&) = delete;
  ~LengthBefore() {
    const auto length = static_cast<Length>(bytes_.size() - begin_);
    std::memcpy(bytes_.data() + begin_ - sizeof(Length), &length, sizeof(Length));
  }

 private:
  Bytes& bytes_;
  std::size_t begin_;
};

/// A record is what is appended while it lives.
class Record {
 public:
  Record(Bytes& bytes, Opcode opcode) : length_((bytes.push_back(static_cast<std::uint8_t>(opcode)), bytes)) {}

 private:
  LengthBefore<std::uint64_t> length_;
};

/// Reads what may be anything: what does not fit reads as 0 or empty, and so does all that follows.
class ByteReader {
 public:
  explicit ByteReader(ByteView bytes) : rest_(bytes) {}

  [[nodiscard]] bool good() const noexcept { return good_; }
  [[nodiscard]] ByteView rest() const noexcept { return rest_; }

  template <std::unsigned_integral T>
  [[nodiscard]] T number() {
    const ByteView bytes = consume(sizeof(T));
    T value{};
    if (good_) std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }

  [[nodiscard]] std::string_view text() {
    const ByteView bytes = consume(number<std::uint32_t>());
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  [[nodiscard]] ByteView consume(std::uint64_t count) {
    good_ = good_ && count <= rest_.size();
    if (!good_) return {};
    const ByteView taken = rest_.first(static_cast<std::size_t>(count));
    rest_ = rest_.subspan(static_cast<std::size_t>(count));
    return taken;
  }

 private:
  ByteView rest_;
  bool good_ = true;
};

}  // namespace dermis::bytes::recordings
