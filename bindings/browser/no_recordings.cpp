// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Recordings and files of frames, which a page does not read yet.
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/bytes/recordings/recording.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"
#include "out/serve/recording/recordings_folder.hpp"

namespace dermis {
namespace {

Error not_in_a_page() {
  return bad_input("a page does not read recordings yet; the command dermis does");
}

}  // namespace

namespace bytes::recordings {

bool has_times(FrameFormat /*format*/) {
  return false;
}

bool may_have_times(FrameFormat /*format*/) {
  return false;
}

Result<FrameFormat> frame_format(const std::string& /*path*/) {
  return not_in_a_page();
}

Result<FrameFormat> recognise_frames(const std::string& /*path*/) {
  return not_in_a_page();
}

Result<std::unique_ptr<FrameSource>> open_frames(const std::string& /*path*/, const FrameFileInput& /*input*/) {
  return not_in_a_page();
}

Result<FrameNotes> read_frame_notes(const std::string& /*path*/) {
  return not_in_a_page();
}

Result<std::vector<RawFrame>> read_frames(FrameSource& /*source*/) {
  return not_in_a_page();
}

RecordingPlace recording_place(const std::string& text) {
  return {.path = text};
}

class SuitRecordingReader::Implementation {};
SuitRecordingReader::~SuitRecordingReader() = default;

Result<std::unique_ptr<SuitRecordingReader>> SuitRecordingReader::open(const std::string& /*path*/) {
  return not_in_a_page();
}

const std::vector<RecordedArray>& SuitRecordingReader::arrays() const noexcept {
  static const std::vector<RecordedArray> none;
  return none;
}

}  // namespace bytes::recordings

namespace out::serve {

RecordingsFolder::RecordingsFolder(const std::string& /*recording*/) {}

std::vector<SavedFile> RecordingsFolder::recordings() const {
  return {};
}

Result<std::string> RecordingsFolder::recording(const std::string& /*name*/) const {
  return not_in_a_page();
}

}  // namespace out::serve
}  // namespace dermis
