// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/learn/recognition/examples.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"
#include "out/serve/teaching/touch_collector.hpp"

namespace dermis::out::serve {

/// Writes examples of one array, in newtons, as `dermis recognise learn` reads them: PATH.frames.csv, PATH.array.toml
/// for its
/// --model, and PATH.labels.csv.
[[nodiscard]] Status write_taught(const std::string& path, const ArrayDescription& array,
                                  const learn::recognition::LabelledFrames& data);

/// Reads the file of write_taught() for an array of that layout, with labels in order of time. It has at most the
/// frames of 1000 touches, and 256 MiB of them. Errors name the file.
[[nodiscard]] Result<learn::recognition::LabelledFrames> read_taught(const std::string& path,
                                                                     const learn::recognition::Layout& layout);

/// Each label, which are in order of time, with at most half a second of what was before and after it.
[[nodiscard]] std::vector<CollectedTouch> touches_of(const learn::recognition::LabelledFrames& data);

/// Names, without a suffix, of the files in a folder that hold touches of the array: the newest first, at most 100.
[[nodiscard]] std::vector<std::string> saved_touches(const std::string& folder, const std::string& array);

}  // namespace dermis::out::serve
