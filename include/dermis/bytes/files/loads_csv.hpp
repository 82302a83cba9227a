// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <istream>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// Reads the forces and pressures of loads.csv (docs/file-formats.md) in the order of its lines. Errors name the line.
/// A taxel or a frame that does not exist is an error (frames are 0 ... frame_count - 1). So are a negative value, a
/// pressure without taxel_area_m2, and two loads of one frame that share a taxel. A position is an error on an array
/// that is no strip. `taken` gets "0.5 kg, taken for 4.903 N" of the first value that is not in newtons or kPa.
[[nodiscard]] Result<std::vector<Load>> read_loads(const std::string& path, const ArrayDescription& array,
                                                   std::size_t frame_count, std::string* taken = nullptr);
/// The same from a stream; `name` stands for the path in messages.
[[nodiscard]] Result<std::vector<Load>> read_loads(std::istream& in, const std::string& name,
                                                   const ArrayDescription& array, std::size_t frame_count,
                                                   std::string* taken = nullptr);

/// Reads the positions of loads.csv, by their frames. Errors name the line: as above, and two positions of one frame.
[[nodiscard]] Result<std::vector<TouchPosition>> read_touch_positions(const std::string& path,
                                                                      const ArrayDescription& array,
                                                                      std::size_t frame_count);
/// The same from a stream.
[[nodiscard]] Result<std::vector<TouchPosition>> read_touch_positions(std::istream& in, const std::string& name,
                                                                      const ArrayDescription& array,
                                                                      std::size_t frame_count);

/// Writes loads.csv.
[[nodiscard]] Status write_loads(const std::string& path, const ArrayDescription& array,
                                 const std::vector<Load>& loads);

}  // namespace dermis::bytes::files
