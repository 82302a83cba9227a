// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::app {

/// A file of bytes, and what is known of them.
struct DescribedFile {
  std::string name;    ///< "feet.bin", "feet.bin#left" for one of its arrays, or "file:feet.bin?layout=feet.toml".
  std::string layout;  ///< Path; empty: the name says it.
  std::optional<double> rate_hz{};
  std::optional<FrameShape> shape{};

  /// Whether a layout says how its bytes are read.
  [[nodiscard]] bool is_described() const;
  [[nodiscard]] Result<std::unique_ptr<FrameSource>> open() const;
};

}  // namespace dermis::app
