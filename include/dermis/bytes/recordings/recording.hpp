// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/bytes/recordings/frame_notes.hpp"
#include "dermis/bytes/recordings/mcap.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "dermis/touch/frames/frame_sink.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// Recordings of one array as MCAP files (docs/recordings.md).
namespace dermis::bytes::recordings {

/// A recording and one of its arrays.
struct RecordingPlace {
  std::string path;
  std::string array;  ///< Empty: the only one.
};

/// "rec.mcap#chest" is the array 'chest' of rec.mcap, unless a file has the whole name.
[[nodiscard]] RecordingPlace recording_place(const std::string& text);

struct RecordingOptions {
  /// Name of the array; topics are /<name>/raw, ... with '_' for characters that a topic cannot have.
  std::string name = "array";
  std::string array_toml;     ///< Description of the array, as array.toml; empty: none.
  std::string model_hash;     ///< content_hash() of the model that gave the forces; empty: none.
  std::string simulation;     ///< As FrameNotes::simulation.
  std::string model_file;     ///< As FrameNotes::model_file.
  ros_messages::Pitch pitch;  ///< Of the array, for the forces.
  McapCompression compression = McapCompression::lz4;
  /// If true, the file takes its place with its first frames. Frames are then in it 50 ms after write(), even if the
  /// process dies. If false, it appears complete or not at all.
  bool live = true;
};

/// Writes a recording. Frames are in the file 50 ms after write(), and once a second the disk is asked to keep them. An
/// earlier file is replaced when the first frames are written, or at commit() if the recording is not live. If that
/// never happens, it stays as it is. After a write error the file holds the frames that were written before. Not
/// thread-safe: one writer; it has two threads of its own.
class RecordingWriter final : public FrameSink {
 public:
  [[nodiscard]] static Result<std::unique_ptr<RecordingWriter>> create(const std::string& path, const FrameShape& shape,
                                                                       const RecordingOptions& options = {});
  /// Without commit(), the written part of a live recording stays, without index.
  ~RecordingWriter() override;

  [[nodiscard]] Status write(const RawFrame& frame) override;
  /// A frame with its forces.
  [[nodiscard]] Status write(const RawFrame& frame, const ForceFrame& force);
  [[nodiscard]] Status commit() override;

 private:
  explicit RecordingWriter(std::unique_ptr<SuitRecordingWriter> suit);
  std::unique_ptr<SuitRecordingWriter> suit_;
};

/// Reads every RawFrame of a recording with the same bits. From other MCAP files it reads the first topic of
/// sensor_msgs/msg/Image in 16UC1, mono16 or 32FC1; time and arrival_utc are then the log times. A recording that ends
/// too early is read up to there. Not thread-safe.
class RecordingReader final : public FrameSource {
 public:
  /// `array`: the name of one array. If there are several, a missing or wrong name is an error that lists the names.
  [[nodiscard]] static Result<std::unique_ptr<RecordingReader>> open(const std::string& path,
                                                                     const std::string& array = {});
  /// The same from a stream that can seek; `name` stands for the path in messages.
  [[nodiscard]] static Result<std::unique_ptr<RecordingReader>> open(std::unique_ptr<std::istream> in,
                                                                     const std::string& name,
                                                                     const std::string& array = {});
  ~RecordingReader() override;

  [[nodiscard]] Result<bool> next(RawFrame& frame) override;
  /// Empty if the recording has no frame.
  [[nodiscard]] std::optional<FrameShape> shape() const override;
  [[nodiscard]] SourceStatistics statistics() const override;
  /// next() continues with the first frame of this log time or later (SuitRecordingReader::seek()).
  void seek(Nanos time);

  /// The recording was written to its end.
  [[nodiscard]] bool complete() const noexcept;
  /// Of the array; what is not known is empty.
  [[nodiscard]] FrameNotes notes() const;

 private:
  RecordingReader(std::unique_ptr<SuitRecordingReader> suit, std::size_t array);

  std::unique_ptr<SuitRecordingReader> suit_;
  std::size_t array_;
  SourceStatistics statistics_;
};

/// A topic of a recording.
struct RecordingTopic {
  std::string name;
  std::string type;  ///< "sensor_msgs/msg/Image"
  std::uint64_t messages = 0;
};

/// The data on an array in a recording.
struct RecordedArrayInfo {
  std::string name;                 ///< Empty if unknown.
  std::optional<FrameShape> shape;  ///< Empty if the recording has no frame and does not contain it.
  std::uint64_t frames = 0;
  std::uint64_t lost = 0;  ///< Frames known to be missing between them.
  std::string array_toml;  ///< Empty where there is none.
  std::string model_hash;  ///< Empty where there is none.
  std::string simulation;  ///< As FrameNotes::simulation.
  std::string model_file;  ///< As FrameNotes::model_file.
};

/// The content of a recording.
struct RecordingInfo {
  std::uint64_t frames = 0;               ///< Of all arrays.
  std::uint64_t lost = 0;                 ///< Of all arrays.
  double duration_s = 0.0;                ///< From the time of the first to that of the last frame.
  Nanos start_utc{};                      ///< Time of the first, since 1970.
  bool complete = false;                  ///< Written to its end; otherwise `dermis info recover` writes the index.
  std::string compression;                ///< "none", "lz4", "zstd", or several with '+'.
  std::string software_version;           ///< "dermis 0.1.0"; empty if unknown.
  std::vector<RecordedArrayInfo> arrays;  ///< One at least.
  std::vector<RecordingTopic> topics;
  std::string unread;  ///< Why messages that should be frames are none: in JSON, without a schema ... Empty: none are.
};

/// From the summary of a file of dermis, if it has one and its first frame can be read; otherwise by reading
/// everything.
[[nodiscard]] Result<RecordingInfo> recording_info(const std::string& path);

/// The result of a recovery.
struct Recovery {
  bool was_complete = false;         ///< The file had its index already.
  std::uint64_t frames = 0;          ///< Kept.
  std::uint64_t messages = 0;        ///< Kept, those of the frames included.
  std::uint64_t damaged_chunks = 0;  ///< Left out, because their bytes have changed.
  std::uint64_t lost_messages = 0;   ///< Messages known to have been in them.
  std::uint64_t lost_bytes = 0;      ///< Bytes of the file that are in no kept record.
};

/// Reads a whole, cut or damaged MCAP file, and writes everything readable as a complete one. `out` must not be `in`.
/// It fails and writes nothing where all messages are lost.
[[nodiscard]] Result<Recovery> recover_recording(const std::string& in, const std::string& out);
/// The same from a stream that can seek; `name` stands for the path in messages.
[[nodiscard]] Result<Recovery> recover_recording(std::unique_ptr<std::istream> in, const std::string& name,
                                                 const std::string& out);

}  // namespace dermis::bytes::recordings
