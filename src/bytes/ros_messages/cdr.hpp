// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Common Data Representation as ROS 2 has it in recordings, streams and DDS. It is XCDR version 1, little-endian (OMG
/// DDSI-RTPS 2.3, section 10; OMG CORBA 3.3, section 9.3). Four bytes 00 01 00 00 come first, then the fields in their
/// order. Each number is at a multiple of its size, counted from behind those four bytes.
namespace dermis::bytes::ros_messages {

static_assert(std::endian::native == std::endian::little, "numbers are copied as the machine holds them");

template <typename T>
concept CdrNumber = std::integral<T> || std::floating_point<T>;

inline constexpr std::size_t kCdrHeaderBytes = 4;

/// Writes one message into a buffer that is reused. Not thread-safe.
class CdrWriter {
 public:
  /// Replaces the content of the buffer.
  explicit CdrWriter(std::vector<std::uint8_t>& bytes) : bytes_(bytes) { bytes_.assign({0, 1, 0, 0}); }

  template <CdrNumber T>
  void write(T value) {
    const std::size_t excess = (bytes_.size() - kCdrHeaderBytes) % sizeof(T);
    if (excess != 0) append(sizeof(T) - excess);
    std::memcpy(append(sizeof(T)), &value, sizeof(T));
  }

  /// The text must not hold a NUL.
  void write_text(std::string_view text) { std::copy(text.begin(), text.end(), write_bytes(text.size() + 1).begin()); }

  /// Writes the length of a sequence<uint8> and zeros. The result is the place of these bytes, valid until the next
  /// call.
  [[nodiscard]] std::span<std::uint8_t> write_bytes(std::size_t count) {
    write(static_cast<std::uint32_t>(count));
    return {append(count), count};
  }

  /// A sequence<float32>.
  void write_floats(std::span<const float> values) {
    write(static_cast<std::uint32_t>(values.size()));
    const std::span<const std::byte> bytes = std::as_bytes(values);
    std::copy_n(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), append(bytes.size()));
  }

 private:
  /// Appends zeros and returns their place.
  std::uint8_t* append(std::size_t count);

  std::vector<std::uint8_t>& bytes_;
};

/// Reads one message. The bytes may be anything and must outlive the reader. A field that does not fit reads as 0 or
/// empty, and so do all that follow. Not thread-safe.
class CdrReader {
 public:
  explicit CdrReader(std::span<const std::uint8_t> message)
      : rest_(message), good_(message.size() >= kCdrHeaderBytes && message[0] == 0 && message[1] == 1) {
    if (good_) rest_ = message.subspan(kCdrHeaderBytes);
    fields_ = rest_.size();
  }

  /// Every field read so far was present.
  [[nodiscard]] bool good() const noexcept { return good_; }

  template <CdrNumber T>
  [[nodiscard]] T read() {
    const std::size_t excess = (fields_ - rest_.size()) % sizeof(T);
    if (excess != 0) static_cast<void>(consume(sizeof(T) - excess));
    const std::span<const std::uint8_t> bytes = consume(sizeof(T));
    T value{};
    if (good_) std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }

  [[nodiscard]] std::string_view read_text() {
    const std::span<const std::uint8_t> bytes = read_bytes();
    if (bytes.empty()) return {};  // a text of length 0 has no NUL with some writers
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size() - 1};
  }

  /// A sequence<uint8>.
  [[nodiscard]] std::span<const std::uint8_t> read_bytes() { return consume(read<std::uint32_t>()); }

  /// A sequence<float32>.
  void read_floats(std::vector<float>& values) {
    const std::size_t count = read<std::uint32_t>();
    const std::span<const std::uint8_t> bytes = consume(count * sizeof(float));
    values.resize(bytes.size() / sizeof(float));
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<std::uint8_t*>(values.data()));
  }

 private:
  std::span<const std::uint8_t> consume(std::size_t count) {
    good_ = good_ && count <= rest_.size();
    if (!good_) return {};
    const std::span<const std::uint8_t> taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }

  std::span<const std::uint8_t> rest_;
  std::size_t fields_ = 0;  ///< Number of bytes behind the header.
  bool good_;
};

}  // namespace dermis::bytes::ros_messages
