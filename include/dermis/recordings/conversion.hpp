// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "dermis/core/array_description.hpp"
#include "dermis/core/result.hpp"
#include "dermis/recordings/frame_files.hpp"

namespace dermis::recordings {

struct ConversionOptions {
  FrameFileInput input{};                   ///< Of the file that is read; no rate where neither file has times.
  const ArrayDescription* array = nullptr;  ///< Kept with the frames, where the format has a place for it.
  const std::atomic<bool>* stop = nullptr;  ///< Ends the conversion, without a file.
};

/// Writes the frames of the file `in` to the file `out`, in the formats of their names; `out` appears complete or not
/// at all. Returns what `out` has no place for, in words: "times", "temperature", ...
[[nodiscard]] Result<std::vector<std::string>> convert_frames(const std::string& in, const std::string& out,
                                                              const ConversionOptions& options = {});

}  // namespace dermis::recordings
