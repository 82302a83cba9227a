// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <istream>
#include <memory>
#include <string>

#include "dermis/bytes/formats/matlab.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::formats {

/// A file of version 4 or 5. Lists at most 1000 variables. Nothing is kept of their values.
[[nodiscard]] Result<std::unique_ptr<MatlabFile>> open_matlab_file(std::unique_ptr<std::istream> in,
                                                                   const std::string& name);

}  // namespace dermis::bytes::formats
