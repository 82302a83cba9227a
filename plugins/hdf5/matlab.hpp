// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>

#include "dermis/bytes/formats/matlab.hpp"

namespace dermis::bytes::recordings {

[[nodiscard]] Result<std::unique_ptr<formats::MatlabFile>> open_matlab(const std::string& path);

}  // namespace dermis::bytes::recordings
