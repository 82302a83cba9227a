// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/core/result.hpp"
#include "dermis/recognition/examples.hpp"

namespace dermis::serve {

/// Writes examples as `dermis learn` reads them: PATH.frames.npy, PATH.arrays.csv and PATH.labels.csv.
[[nodiscard]] Status write_taught(const std::string& path, const recognition::LabelledFrames& data);

}  // namespace dermis::serve
