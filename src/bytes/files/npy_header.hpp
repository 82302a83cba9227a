// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// The header of a .npy file for its array (numpy.lib.format).
struct NpyHeader {
  char kind = 'u';             ///< 'u', 'i' or 'f'.
  std::size_t item_bytes = 2;  ///< 1, 2, 4, 8; of floats 4, 8.
  bool is_big_endian = false;
  bool is_fortran_order = false;
  std::vector<std::uint64_t> shape;
};

/// Reads up to the first byte of the data. Messages do not name the file.
[[nodiscard]] Result<NpyHeader> read_npy_header(std::istream& in);

/// The dictionary of a header, a literal of Python.
[[nodiscard]] Result<NpyHeader> parse_npy_dictionary(std::string_view text);

inline constexpr std::size_t kNpyHeaderBytes = 128;

/// A header of version 1.0 of kNpyHeaderBytes for an array of three dimensions.
[[nodiscard]] std::string npy_header(std::string_view type, std::uint64_t frames, std::size_t rows, std::size_t cols);

}  // namespace dermis::bytes::files
