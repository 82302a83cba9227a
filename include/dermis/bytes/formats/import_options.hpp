// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::formats {

/// The needed knowledge of a file of another system.
struct ImportOptions {
  std::optional<FrameShape> shape{};  ///< Shape that the frames must have; empty: that of the file. 1x1 ... 1024x1024.
  std::optional<double> rate_hz{};    ///< Frames a second of a file without times. > 0
  std::string array{};                ///< Which of several arrays of a file; empty: the only one.
  std::function<void(const std::string&)> notice{};  ///< Told in one line what a user should know of the frames.
  std::function<void(const std::string&)> loss{};    ///< Told in one line what was left out: a frame that is cut.
};

/// Bad input, with `name` of the file, where its frames have another shape than required, no rows or columns, or more
/// than 1024.
[[nodiscard]] Status check_shape(const std::string& name, FrameShape found, const std::optional<FrameShape>& wanted);

}  // namespace dermis::bytes::formats
