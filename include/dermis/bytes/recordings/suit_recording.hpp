// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <istream>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/bytes/recordings/mcap.hpp"
#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// Recordings of several arrays in one MCAP file (docs/recordings.md).
namespace dermis::bytes::recordings {

/// An array of a recording.
struct RecordedArray {
  std::string name = "array";  ///< Topics are /<name>/raw, ... with '_' for what a topic cannot have.
  FrameShape shape{};
  std::string array_toml{};     ///< Description of the array, as array.toml; empty: none.
  std::string model_hash{};     ///< content_hash() of the model that gave the forces; empty: none.
  ros_messages::Pitch pitch{};  ///< For the forces.
  std::string simulation{};     ///< As FrameNotes::simulation.
  std::string model_file{};     ///< As FrameNotes::model_file.
  std::string topic{};          ///< "/touch" or "/touch.thumb_matrix" of a file of others; empty: dermis wrote it.
};

/// A message that belongs to no frame: a recognition or a threat.
struct RecordedEvent {
  std::string_view topic;  ///< "/chest/recognition"; of one type in a recording.
  const ros_messages::MessageType& type;
  Nanos time{};
  std::span<const std::uint8_t> message;
  bool is_of_frame = false;  ///< The readings give it again: it gives way to them where a disk stalls.
};

/// A result of a frame that a recording holds besides the readings.
struct RecordedResult {
  enum class Kind : std::uint8_t { force, contacts };  ///< foxglove_msgs/msg/Grid, dermis_msgs/msg/Contacts.
  Kind kind = Kind::force;
  std::size_t array = 0;
  Nanos time{};                           ///< Log time, which is that of the frame.
  std::span<const std::uint8_t> message;  ///< In CDR.
};

struct SuitRecordingOptions {
  McapCompression compression = McapCompression::lz4;
  bool live = true;  ///< As RecordingOptions::live.
};

/// Writes a recording of one or more arrays, as RecordingWriter does for one. Frames stand in the file in the order of
/// write(); the log times of each array rise. Thread-safe: each array may have a thread of its own that writes.
class SuitRecordingWriter {
 public:
  /// Fails if the topics of two arrays would have the same names.
  [[nodiscard]] static Result<std::unique_ptr<SuitRecordingWriter>> create(const std::string& path,
                                                                           std::vector<RecordedArray> arrays,
                                                                           const SuitRecordingOptions& options = {});
  SuitRecordingWriter(const SuitRecordingWriter&) = delete;
  SuitRecordingWriter& operator=(const SuitRecordingWriter&) = delete;
  /// Without commit(), the written part of a live recording stays, without index.
  ~SuitRecordingWriter();

  /// `array` is its index in the list of create(). Waits where 64 MB wait for a disk that stalls.
  [[nodiscard]] Status write(std::size_t array, const RawFrame& frame);
  /// A frame with its forces.
  [[nodiscard]] Status write(std::size_t array, const RawFrame& frame, const ForceFrame& force);
  [[nodiscard]] Status write(const RecordedEvent& event);
  /// As write(), but never waits: false where it would. Then the frame is not in the recording, and the next one of its
  /// array says how many before it are lost. Events have as much room again, so that frames do not take it, and
  /// those of frames an eighth of it.
  [[nodiscard]] Result<bool> try_write(std::size_t array, const RawFrame& frame);
  [[nodiscard]] Result<bool> try_write(const RecordedEvent& event);
  /// Call it once, when no write() is under way or follows.
  [[nodiscard]] Status commit();

 private:
  class Implementation;
  explicit SuitRecordingWriter(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

/// The array of a name, or the only one if the name is empty; otherwise an error that lists the names. `path` stands
/// for the recording in messages.
[[nodiscard]] Result<std::size_t> find_array(const std::vector<RecordedArray>& arrays, const std::string& path,
                                             const std::string& name);

/// Reads every RawFrame of all arrays of a recording, in the order of the file. In other MCAP files each topic of
/// readings is an array, or several (docs/recordings.md). Where there is more than one, its topic is its name. Not
/// thread-safe.
class SuitRecordingReader {
 public:
  [[nodiscard]] static Result<std::unique_ptr<SuitRecordingReader>> open(const std::string& path);
  /// The same from a stream that can seek; `name` stands for the path in messages.
  [[nodiscard]] static Result<std::unique_ptr<SuitRecordingReader>> open(std::unique_ptr<std::istream> in,
                                                                         const std::string& name);
  SuitRecordingReader(const SuitRecordingReader&) = delete;
  SuitRecordingReader& operator=(const SuitRecordingReader&) = delete;
  ~SuitRecordingReader();

  /// As far as the file contains them; names may be empty, and so may the shape of an array without frames.
  [[nodiscard]] const std::vector<RecordedArray>& arrays() const noexcept;

  /// From now on, next() skips the frames of the other arrays.
  void read_only(std::size_t array);
  /// Fills `frame` with the next frame, reusing its buffers, and `array` with the index of its array in arrays().
  /// Returns false at the end.
  [[nodiscard]] Result<bool> next(std::size_t& array, RawFrame& frame);
  /// next() passes on the results between the frames, before or after theirs; they are valid during the call.
  void hear_results(std::function<void(const RecordedResult&)> hear);
  /// next() continues with the first frames of this log time or later. The log time is the time of the frame
  /// (docs/recordings.md). A recording without index is read from its beginning.
  void seek(Nanos time);

  /// The recording was written to its end.
  [[nodiscard]] bool complete() const noexcept;

 private:
  class Implementation;
  explicit SuitRecordingReader(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::bytes::recordings
