// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/core/array_description.hpp"
#include "dermis/core/result.hpp"
#include "dermis/recognition/examples.hpp"
#include "serve/teaching/touch_collector.hpp"

namespace dermis::serve {

/// Writes examples of one array, in newtons, as `dermis learn` reads them: PATH.frames.csv, PATH.array.toml for its
/// --model, and PATH.labels.csv.
[[nodiscard]] Status write_taught(const std::string& path, const ArrayDescription& array,
                                  const recognition::LabelledFrames& data);

/// Reads the file of write_taught() for an array of that layout, with labels in order of time. It has at most the
/// frames of 1000 touches, and 256 MiB of them. Errors name the file.
[[nodiscard]] Result<recognition::LabelledFrames> read_taught(const std::string& path,
                                                              const recognition::Layout& layout);

/// Each label, which are in order of time, with at most half a second of what was before and after it.
[[nodiscard]] std::vector<CollectedTouch> touches_of(const recognition::LabelledFrames& data);

/// Names, without a suffix, of the files in a folder that hold touches of the array: the newest first, at most 100.
[[nodiscard]] std::vector<std::string> saved_touches(const std::string& folder, const std::string& array);

}  // namespace dermis::serve
