// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dermis/core/array_description.hpp"
#include "dermis/core/result.hpp"
#include "dermis/recordings/frame_files.hpp"

namespace dermis::recordings {

struct ConversionOptions {
  FrameFileInput input{};                            ///< What must be known of the file that is read.
  const ArrayDescription* array = nullptr;           ///< Kept with the frames, where the format has a place for it.
  std::function<void(const std::string&)> notice{};  ///< What a user should know: a recording that is incomplete.
  const std::atomic<bool>* stop = nullptr;           ///< Ends the conversion, without a file.
};

/// Writes the frames of the file `in` to the file `out`, in the formats of their names; `out` appears complete or not
/// at all. Returns what `out` has no place for, in words: "times", "temperature", ...
[[nodiscard]] Result<std::vector<std::string>> convert_frames(const std::string& in, const std::string& out,
                                                              const ConversionOptions& options = {});

}  // namespace dermis::recordings
