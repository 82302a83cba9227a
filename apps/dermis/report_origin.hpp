// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/out/report/evaluation_report.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::app {

/// The files of an evaluation.
struct JudgedFiles {
  std::string frames;  ///< As the user names the source.
  std::string loads;
  std::string model;
};

/// The origin of these files for a report: simulated or measured, when, with which hashes, by which dermis.
[[nodiscard]] out::report::Origin report_origin(const JudgedFiles& files, const std::vector<RawFrame>& frames);

}  // namespace dermis::app
