// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::recordings {

struct ConversionOptions {
  FrameFileInput input{};                   ///< Shape of the input, and its rate where only its own file lacks times.
  const ArrayDescription* array = nullptr;  ///< Stored with the frames, if the format has a place for it.
  const std::atomic<bool>* stop = nullptr;  ///< Ends the conversion, without a file.
};

/// Writes the frames of the file `in` to the file `out`, in the formats of their names; `out` appears complete or not
/// at all. Returns the names of what `out` cannot hold: "times", "temperature", ...
[[nodiscard]] Result<std::vector<std::string>> convert_frames(const std::string& in, const std::string& out,
                                                              const ConversionOptions& options = {});

/// The same of frames that are read elsewhere. `is_timed`: their times are those of the measurement.
[[nodiscard]] Result<std::vector<std::string>> convert_frames(FrameSource& source, bool is_timed,
                                                              const std::string& out,
                                                              const ConversionOptions& options = {});

}  // namespace dermis::bytes::recordings
