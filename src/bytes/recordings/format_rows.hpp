// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/bytes/recordings/frame_files.hpp"

namespace dermis::bytes::recordings {

enum class Times { always, sometimes, never };

/// A file has a place for counts alone, for temperature and supply, too, or for all of a frame and FrameNotes.
enum class Holds { counts, temperatures, all };

/// A format of frames.
struct FormatRow {
  using Open = Result<std::unique_ptr<FrameSource>>(const std::string& path, const FrameFileInput& input);
  using Create = Result<std::unique_ptr<FrameSink>>(const std::string& path, FrameShape shape, const FrameNotes& notes);

  FrameFormat format = FrameFormat::csv;
  const char* name = "";
  std::vector<std::string_view> endings{};      ///< In lower case.
  std::string_view kind{};                      ///< As which a file begins (files/file_kind.hpp); empty: as anything.
  std::vector<std::string_view> first_words{};  ///< Which tell it among texts with the endings of others.
  Times times = Times::always;
  Holds holds = Holds::counts;
  Open* open = nullptr;
  Create* create = nullptr;  ///< Null where it is only read.
};

/// A row for each FrameFormat. Where two endings fit a name, the first row holds.
[[nodiscard]] const std::vector<FormatRow>& format_rows();
[[nodiscard]] const FormatRow& row_of(FrameFormat format);

}  // namespace dermis::bytes::recordings
