// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// A file of frames is no source of a page: what is opened is played (opened_files.cpp).
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/bytes/recordings/recording.hpp"

namespace dermis {
namespace {

Error not_in_a_page() {
  return bad_input("a page does not read this as a device; open the file");
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
