// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/bytes/bodies/suit.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// Reads suit.toml (docs/suit.md). Paths are relative to the folder of the file, except inside a URI. Unknown keys are
/// errors with the nearest known name. Every error names the file, and the line if there is one. The result has passed
/// SuitDescription::validate().
[[nodiscard]] Result<SuitDescription> read_suit(const std::string& path);

/// Reads the file of the places of taxels that suit.toml names.
using ReadPositions = std::function<Result<std::vector<Vector3>>(const std::string& path)>;

/// The same from memory; `name` stands for the path.
[[nodiscard]] Result<SuitDescription> suit_from_toml(std::string_view text, const std::string& name,
                                                     const ReadPositions& read_positions);

/// A place on an array, as people name it.
struct NamedPlace {
  Vector3 position{};  ///< In the frame of the array [m].
  std::string name{};  ///< "index tip"; empty: it has none.
};

/// Reads places.csv: `x_mm,y_mm`, then `z_mm`, `name` or both where they are known, and a line for each place.
[[nodiscard]] Result<std::vector<NamedPlace>> read_places(const std::string& path);
/// The same from a stream; `name` stands for the path in messages.
[[nodiscard]] Result<std::vector<NamedPlace>> read_places(std::istream& in, const std::string& name);

/// Reads positions.csv: `x_mm,y_mm,z_mm`, then the place of each taxel, row-major, 1024 x 1024 at most.
[[nodiscard]] Result<std::vector<Vector3>> read_positions(const std::string& path);
/// The same from a stream; `name` stands for the path in messages.
[[nodiscard]] Result<std::vector<Vector3>> read_positions(std::istream& in, const std::string& name);
/// The text of such a file.
[[nodiscard]] std::string positions_csv(const std::vector<Vector3>& positions);

}  // namespace dermis::bytes::files
