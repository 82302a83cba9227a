// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "shape_options.hpp"

#include <fmt/core.h>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::app {

void ShapeOptions::add(Command& command) {
  const Option rows_option =
      command.option("--rows", rows, "Rows of the frames: checked, and needed if the file does not contain them");
  rows_option.needs(command.option("--cols", cols, "Columns of the frames").needs(rows_option));
}

Result<std::optional<FrameShape>> ShapeOptions::shape() const {
  if (!rows || !cols) return std::optional<FrameShape>();
  if (*rows < 1 || *rows > kMaxLines || *cols < 1 || *cols > kMaxLines) {
    return bad_input(fmt::format("--rows, --cols: must be 1 to {}", kMaxLines));
  }
  return std::optional(FrameShape{*rows, *cols});
}

}  // namespace dermis::app
