// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "bytes/recordings/compression.hpp"
#include "bytes/recordings/mcap_bytes.hpp"
#include "dermis/bytes/recordings/mcap.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::recordings {

inline constexpr std::uint64_t kMaxChunkBytes = std::uint64_t{64} << 20U;       ///< Of a chunk or message.
inline constexpr std::uint64_t kMaxAttachmentBytes = std::uint64_t{16} << 20U;  ///< Of any other record.

struct McapRecord {
  Opcode opcode{};
  std::uint64_t place = 0;  ///< In the file, of the opcode.
  std::uint64_t bytes = 0;  ///< Header included.
  ByteView body;            ///< Empty where the record is larger than what is read.
  bool is_left_out = false;
};

/// Goes from record to record through the bytes of an MCAP file, which may be anything. Not thread-safe.
class McapScanner {
 public:
  /// Fails where the file does not begin as MCAP does.
  [[nodiscard]] static Result<McapScanner> open(std::unique_ptr<std::istream> in, const std::string& name);

  enum class Step {
    record,
    end,   ///< End of the file, after a whole record.
    cut,   ///< The rest of the file is no whole record.
    wrong  ///< The byte here is no opcode.
  };
  /// The record that begins at place(); its body is valid until the next call.
  [[nodiscard]] Result<Step> next(McapRecord& record);

  [[nodiscard]] std::uint64_t place() const noexcept { return place_; }
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  /// Goes elsewhere. `crc` is that of the bytes before, as far as it is wanted; empty: not known.
  void go_to(std::uint64_t place, std::optional<std::uint32_t> crc = {}) noexcept {
    place_ = place;
    crc_ = crc;
  }
  /// CRC of the bytes up to place(), from the beginning of the file or from go_to(); empty where not known.
  [[nodiscard]] const std::optional<std::uint32_t>& crc() const noexcept { return crc_; }

  /// The footer of a file that was written to its end.
  struct Footer {
    std::uint64_t place = 0;
    std::uint64_t summary = 0;  ///< Where it begins; 0: there is none.
    std::uint32_t crc = 0;      ///< CRC of the summary and of the footer up to here; 0: not given.
    Bytes checked_bytes;        ///< Of the footer.
  };
  [[nodiscard]] Result<std::optional<Footer>> footer();

  /// Bytes of the file; fewer at its end.
  [[nodiscard]] Result<ByteView> read(std::uint64_t place, std::size_t count);

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  /// "name: byte N: what".
  [[nodiscard]] Error error(std::uint64_t place, const std::string& what) const;

 private:
  McapScanner(std::unique_ptr<std::istream> in, std::string name, std::uint64_t size);
  [[nodiscard]] Status fetch(std::uint64_t place, std::size_t count);

  std::unique_ptr<std::istream> in_;
  std::string name_;
  std::uint64_t size_;
  std::uint64_t place_ = 0;
  std::uint64_t stream_place_ = 0;  ///< Where the stream stands.
  std::optional<std::uint32_t> crc_;
  Bytes bytes_;
};

/// A chunk, decompressed.
struct McapChunk {
  McapCompression compression{};
  ByteView records;
};
/// Fails with what is wrong, without a place.
[[nodiscard]] Result<McapChunk> parse_chunk(ByteView body, Decompressor& decompressor);

/// Takes the first record of a chunk. Returns false where the bytes are no whole record.
[[nodiscard]] bool split_record(ByteView& records, Opcode& opcode, ByteView& body);

[[nodiscard]] Result<McapMessage> parse_message(ByteView body);
[[nodiscard]] Result<McapAttachment> parse_attachment(ByteView body);
[[nodiscard]] Result<McapMetadata> parse_metadata(ByteView body);

/// The channels of a file, with their schemas.
class ChannelTable {
 public:
  /// Take the records of their names; a number that is known already keeps its meaning.
  [[nodiscard]] Status add_schema(ByteView body);
  [[nodiscard]] Status add_channel(ByteView body);

  [[nodiscard]] const std::map<std::uint16_t, McapChannel>& channels() const noexcept { return channels_; }

 private:
  [[nodiscard]] bool has_room_for(std::size_t bytes);

  std::map<std::uint16_t, McapChannel> schemas_;  ///< Only the fields of the schema.
  std::map<std::uint16_t, McapChannel> channels_;
  std::size_t bytes_ = 0;
};

}  // namespace dermis::bytes::recordings
