// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>

#include "dermis/live/sources/open_source.hpp"

namespace dermis::out::serve {

/// The source of frames of that shape, of which nothing else is known.
[[nodiscard]] inline Result<std::unique_ptr<FrameSource>> open_watched(const live::sources::SourceName& name,
                                                                       std::optional<FrameShape> shape,
                                                                       live::sources::SourceOptions options) {
  ArrayDescription array;
  if (shape) array.rows = shape->rows;
  if (shape) array.cols = shape->cols;
  const bool is_asked_for = shape && name.kind != live::sources::SourceKind::simulation;
  options.array = is_asked_for ? &array : nullptr;
  return live::sources::open_source(name, options);
}

}  // namespace dermis::out::serve
