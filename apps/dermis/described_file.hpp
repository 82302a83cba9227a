// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/bytes/devices/device_source.hpp"
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
  /// The arrays that its layout has, by their names; one without a name if it has one, or `name` says which.
  [[nodiscard]] Result<std::vector<std::string>> arrays() const;
  /// `array`: one of arrays().
  [[nodiscard]] Result<std::unique_ptr<FrameSource>> open(const std::string& array = {}) const;

 private:
  [[nodiscard]] Result<bytes::devices::SourceUri> uri() const;
};

}  // namespace dermis::app
