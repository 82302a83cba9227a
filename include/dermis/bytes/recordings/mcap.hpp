// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/touch/frames/result.hpp"

/// MCAP files (https://mcap.dev/spec): messages of several topics with their schemas, in compressed chunks.
namespace dermis::bytes::recordings {

enum class McapCompression : std::uint8_t { none, lz4, zstd };

/// "", "lz4" or "zstd", as in the files.
[[nodiscard]] const char* to_string(McapCompression compression) noexcept;

/// One topic.
struct McapChannel {
  std::string topic;
  std::string encoding;         ///< Of the messages: "cdr".
  std::string schema_name;      ///< "sensor_msgs/msg/Image"; empty if the topic has no schema.
  std::string schema_encoding;  ///< "ros2msg".
  std::string schema;

  bool operator==(const McapChannel&) const = default;
};

/// One message; times in nanoseconds since 1970.
struct McapMessage {
  std::uint16_t channel = 0;  ///< Its number in the file, from McapWriter::add_channel().
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;
  std::uint64_t publish_time = 0;
  std::span<const std::uint8_t> data;
};

struct McapAttachment {
  std::string name;
  std::string media_type;
  std::string data;

  bool operator==(const McapAttachment&) const = default;
};

struct McapMetadata {
  std::string name;
  std::map<std::string, std::string> values;

  bool operator==(const McapMetadata&) const = default;
};

/// Writes an MCAP file of the profile "ros2". The file is beside its final place until appear() or finish(). Data that
/// close_chunk() wrote can be read even if the process dies afterwards. After the first write error the file is cut
/// back to the last whole record, and later data are dropped. finish() then adds the index. Where the disk is full, the
/// last chunks make room for it. Until then the index lies in a file without a name beside the recording. It has about
/// 110 bytes for each chunk (and 10 for each topic in it). Memory: two chunks and those that wait. Not thread-safe.
class McapWriter {
 public:
  [[nodiscard]] static Result<std::unique_ptr<McapWriter>> create(const std::string& path, McapCompression compression);
  /// Without finish(), a file that has appeared stays, without its index; otherwise no file remains.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  [[nodiscard]] std::uint16_t add_channel(const McapChannel& channel);
  void add_attachment(const McapAttachment& attachment);
  void add_metadata(const McapMetadata& metadata);
  /// Appends to the open chunk.
  void add_message(const McapMessage& message);
  /// Size of the open chunk, before it is compressed.
  [[nodiscard]] std::size_t chunk_bytes() const noexcept;

  /// Writes everything added so far to the file.
  [[nodiscard]] Status close_chunk();
  /// Everything added so far becomes a chunk that waits in memory for write_sealed().
  void seal_chunk();
  /// Writes the first waiting chunk. One other thread at a time may call it while this one adds and seals.
  [[nodiscard]] Status write_sealed();
  /// Puts the file in its place, where it continues to grow. Fails where the disk has no room for an index.
  [[nodiscard]] Status appear();
  /// Waits until the data of close_chunk() are on the disk. Another thread may call it while this one writes.
  [[nodiscard]] Status synchronise();
  /// Writes the open chunk and the index, and puts the file in its place. Call it once.
  [[nodiscard]] Status finish();

 private:
  struct State;
  explicit McapWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// The summary of a file.
struct McapStatistics {
  std::uint64_t messages = 0;
  std::uint32_t chunks = 0;
  std::uint64_t first_log_time = 0;
  std::uint64_t last_log_time = 0;
  std::map<std::uint16_t, std::uint64_t> channel_messages;
};

/// Reads the messages of an MCAP file in the order of the file. If its chunks are indexed and not in the order of their
/// times, their times decide. A file that ends too early is read up to its last whole record. All CRCs are verified.
/// Errors name the byte. Memory: one chunk; chunks and messages may have up to 64 MiB. Not thread-safe.
class McapReader {
 public:
  [[nodiscard]] static Result<std::unique_ptr<McapReader>> open(const std::string& path);
  /// The same from a stream that can seek; `name` stands for the path in messages.
  [[nodiscard]] static Result<std::unique_ptr<McapReader>> open(std::unique_ptr<std::istream> in,
                                                                const std::string& name);
  ~McapReader();
  McapReader(const McapReader&) = delete;
  McapReader& operator=(const McapReader&) = delete;

  /// The file was written to its end.
  [[nodiscard]] bool complete() const noexcept;
  /// Empty without summary.
  [[nodiscard]] const std::optional<McapStatistics>& statistics() const noexcept;

  /// Fills `message`, whose data are valid until the next call. Returns false at the end of the file.
  [[nodiscard]] Result<bool> next(McapMessage& message);

  /// Reads chunks in the order of the file, whatever their times. Call it before next().
  void read_as_written();
  /// next() begins again.
  void rewind();
  /// next() continues at a message after which all messages of this log time and later still come, and few earlier
  /// ones. With indexed chunks it is the first of a chunk, otherwise the first of the file.
  void seek(std::uint64_t log_time);

  /// Channels, attachments and metadata read so far; for a file with an index, all of them. Attachments above 16 MiB
  /// are left out.
  [[nodiscard]] const std::map<std::uint16_t, McapChannel>& channels() const noexcept;
  [[nodiscard]] const std::vector<McapAttachment>& attachments() const noexcept;
  [[nodiscard]] const std::vector<McapMetadata>& metadata() const noexcept;

  /// Compressions of the chunks read or indexed so far.
  [[nodiscard]] const std::vector<McapCompression>& compressions() const noexcept;

 private:
  struct State;
  explicit McapReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace dermis::bytes::recordings
