// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/out/report/page.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::report {

/// Makes the directory and writes each figure that has panels, then the page as index.html; every file appears complete
/// or not at all.
[[nodiscard]] Status write_files(const std::string& directory, const std::vector<Figure>& figures,
                                 const std::string& page);

}  // namespace dermis::out::report
