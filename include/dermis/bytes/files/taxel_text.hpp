// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

struct TaxelPlace {
  std::size_t row = 0;
  std::size_t col = 0;
};

/// Reads "r3c5".
[[nodiscard]] std::optional<TaxelPlace> parse_taxel(std::string_view text);

/// Reads "r3c5", "r0c0:r3c3" or "all"; the error names the problem of the text.
[[nodiscard]] Result<TaxelRegion> parse_region(std::string_view text, FrameShape shape);

/// "12x32"
[[nodiscard]] std::string size_text(FrameShape shape);

/// Appends ",r0c0,r0c1,..." row by row.
void append_taxel_names(std::string& header, std::size_t rows, std::size_t cols);

}  // namespace dermis::bytes::files
