// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>

#include "command_line.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::app {

/// --rows and --cols of the frames of a file, which some formats do not contain.
struct ShapeOptions {
  std::optional<std::size_t> rows;
  std::optional<std::size_t> cols;

  /// Declares them; `this` must live as long as the action.
  void add(Command& command);

  /// Empty where they are not given.
  [[nodiscard]] Result<std::optional<FrameShape>> shape() const;
};

}  // namespace dermis::app
