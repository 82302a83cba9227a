// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "dermis/bytes/layouts/layout.hpp"
#include "dermis/touch/frames/frame_source.hpp"

namespace dermis::bytes::layouts {

/// The layout of a known device: a file of src/bytes/layouts/shipped.
struct ShippedLayout {
  std::string_view name;
  std::vector<FrameShape> sizes{};  ///< The arrays that are built. Their packets differ in size.
  std::size_t baud = 115'200;
  std::string_view toml{};  ///< Lacks rows and cols.

  /// That of an array of this shape, 1x1 ... 1024x1024.
  [[nodiscard]] std::shared_ptr<const Layout> of(const FrameShape& shape) const;
};

/// From the text of such a file.
[[nodiscard]] ShippedLayout read_shipped(std::string_view name, std::string_view toml);

/// All, by name; its source is made by CMake. Thread-safe.
[[nodiscard]] const std::vector<ShippedLayout>& shipped_layouts();

}  // namespace dermis::bytes::layouts
