// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::sources {

/// The order as parameters of a URI: "transpose=1&row_order=0,2,1". Empty where nothing changes.
[[nodiscard]] std::string order_parameters(const LineOrder& order);

/// Recordings hold frames that are turned already. Fails where `array` turns its device, but the recording was made
/// before its description said so. `recorded_toml` is the array.toml in the recording, empty where there is none.
/// `path` stands for the recording in the error, which says how to turn it.
[[nodiscard]] Status check_recorded_order(const std::string& path, std::string_view recorded_toml,
                                          const ArrayDescription& array);

}  // namespace dermis::live::sources
