// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dermis/bytes/recordings/frame_notes.hpp"
#include "dermis/live/sources/guide_voice.hpp"
#include "dermis/live/sources/source_name.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::sources {

struct SourceOptions {
  /// The frames must have its shape, and it is what is simulated where the URI names no other array. Null: any. Used
  /// while the source is opened.
  const ArrayDescription* array = nullptr;
  /// Set: a live source gives what was received, then next() returns false within 100 ms. A file is read on.
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const std::string&)> notice{};  ///< Told what a user should know while it goes on; one line.
  std::function<void(const std::string&)> loss{};    ///< Told in one line, at its end, that a file is cut off there.
  /// Given all bytes of a device as they come, before they are decoded.
  std::function<void(std::span<const std::uint8_t>)> received{};
  std::function<void(double share)> simulated{};  ///< Told how much of a scene is simulated before its first frame.
  std::shared_ptr<GuideVoice> guide{};  ///< Whom the hand of sim:rehearsal obeys. Null: nobody, it presses nothing.
};

/// Opens the source that `from` names. This is a device or the simulator by its URI (docs/devices.md), or a file of
/// frames by its path (recordings/frame_files.hpp). "rec.mcap#chest" is one array of a recording. Fails if nothing has
/// that name, and if the frames do not have the shape of the array. The error says in one line what to do.
///
/// sim:SCENE with a rate is a device that repeats the frames of the scene at that rate, with sequence and device time.
/// Frames that are not fetched within 500 ms are lost, as they would be in the buffers of a TCP connection. The scene
/// "contacts" runs at its own speed whatever the rate. Without a rate, it is the scene once, as fast as it is read. The
/// array is that of the URI, or else that of the options. Without either it is the reference array of examples/chest,
/// with the rows and cols of the URI.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_source(const SourceName& from,
                                                               const SourceOptions& options = {});

/// The same of a name that is not parsed yet. Also fails where SourceName::parse() does.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_source(const std::string& from,
                                                               const SourceOptions& options = {});

/// What is known of the frames of `source`, which was opened as `from`: the notes in its file, or its simulation.
/// Nothing is known of a device.
[[nodiscard]] bytes::recordings::FrameNotes notes_of_source(const FrameSource& source, const std::string& from);

/// All frames of the file that `from` names. Fails where open_source() does, and on a device, which has no end.
[[nodiscard]] Result<std::vector<RawFrame>> read_frames(const std::string& from, const SourceOptions& options = {});

/// The error for a source without an end where one is needed; it names the mend.
[[nodiscard]] Error has_no_end(const std::string& from);

/// Names of the arrays of a recording that holds several where `from` names none of them; empty of every other source.
/// Fails where the recording cannot be read.
[[nodiscard]] Result<std::vector<std::string>> several_arrays(const SourceName& from);

}  // namespace dermis::live::sources
