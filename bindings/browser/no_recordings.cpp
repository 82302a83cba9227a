// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Files of frames, which a page does not read yet.
#include "dermis/bytes/recordings/frame_files.hpp"

namespace dermis {
namespace {

Error not_in_a_page() {
  return bad_input("a page does not read files of frames yet; the command dermis does");
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

}  // namespace bytes::recordings
}  // namespace dermis
