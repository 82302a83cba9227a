// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/core/array_description.hpp"
#include "dermis/core/result.hpp"
#include "dermis/recognition/examples.hpp"

namespace dermis::serve {

/// Writes examples of one array, in newtons, as `dermis learn` reads them: PATH.frames.csv, PATH.array.toml for its
/// --model, and PATH.labels.csv.
[[nodiscard]] Status write_taught(const std::string& path, const ArrayDescription& array,
                                  const recognition::LabelledFrames& data);

}  // namespace dermis::serve
