// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dermis/live/sources/array_folder.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::serve {

/// An array that was described or calibrated before.
struct KnownArray {
  std::string file;  ///< Its newest model, or without one its newest array.toml.
  ArrayDescription array;
  bool is_calibrated = false;
  std::optional<live::sources::ArrayFolder> folder{};  ///< The one of its own; empty: its files are in the current one.
};

/// The arrays of the folders in the current one, then of the newest 100 models and descriptions in it. The newest come
/// first, one of each name.
[[nodiscard]] std::vector<KnownArray> known_arrays();

/// The same for clients: {"arrays": [{"file", "name", "rows", "cols", "calibrated", "from"}]}.
[[nodiscard]] std::string known_arrays_json();

/// One of known_arrays(). Fails on all other files.
[[nodiscard]] Result<KnownArray> known_array(const std::string& file);

/// The path of a file in the folder of an array, which is made by make_array_folder(). Fails where it is there already.
[[nodiscard]] Result<std::string> new_array_file(const std::string& array, const char* name);
[[nodiscard]] Status make_array_folder(const std::string& array);

}  // namespace dermis::out::serve
