// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <string>

#include "dermis/out/serve/served_suit.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::browser {

/// An array that somebody has opened the file of.
struct OpenedArray {
  std::string path;              ///< Empty: a recording holds it.
  touch::pipeline::Model model;  ///< Uncalibrated where an array.toml was opened.
  ArrayDescription description;

  [[nodiscard]] FrameShape shape() const { return {description.rows, description.cols}; }
};

/// Whether a file is a recording (.mcap, .csv, .npy); others describe an array.
[[nodiscard]] bool is_recording(const std::string& path);

/// Reads a model file or an array.toml. Errors: those of the file.
[[nodiscard]] Result<OpenedArray> open_array(const std::string& path);

/// The suit of a recording, which is played: with `array` where it is as large, else with what the recording holds. A
/// recording is made beside a .csv or .npy. Errors: those of the file; it does not say what array it is of.
[[nodiscard]] Result<out::serve::ServedSuit> open_recording(const std::string& path,
                                                            const std::optional<OpenedArray>& array);

}  // namespace dermis::browser
