// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string_view>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"
#include "out/serve/requests/json_request.hpp"

namespace dermis::out::serve {

/// An array of unknown circuit, as a client describes it: {"name": "mat", "rows": 12, "cols": 10, "pitch_um": 10000,
/// "adc_bits": 12}. "transpose", "flip_rows" and "flip_cols" may be added. Its name is one for files.
[[nodiscard]] Result<ArrayDescription> array_request(std::string_view text);

/// The same of "sent_rows" and "sent_cols".
[[nodiscard]] Result<FrameShape> sent_shape_request(const JsonRequest& request);

/// {"rows": 12, "cols": 10}, each 1 ... kMaxLines.
[[nodiscard]] Result<FrameShape> shape_request(std::string_view text);

}  // namespace dermis::out::serve
