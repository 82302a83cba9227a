// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/out/report/page.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::out::report {

/// The origin of the judged frames, and of the model that judged them.
struct Origin {
  std::string summary;      ///< "Simulated frames." Empty: nothing is known.
  std::vector<Fact> facts;  ///< Files with their times and hashes, versions.
};

/// The report as one self-contained HTML page: no script, nothing loaded from elsewhere, light and dark, printable.
/// The page says in a sentence what could not be judged.
[[nodiscard]] std::string evaluation_page(const learn::calibration::Evaluation& evaluation,
                                          const touch::pipeline::Model& model, const Origin& origin = {});

/// Writes the page as DIR/index.html and each figure that has data as an SVG file beside it. The files are
/// calibration_vs_output.svg, error_vs_force.svg, error_vs_temperature.svg, error_vs_supply.svg, error_vs_contacts.svg,
/// tactile_1.svg, .... Creates the directory; every file appears complete or not at all, the page last. Errors: the
/// directory cannot be made or written.
[[nodiscard]] Status write_evaluation_report(const std::string& directory,
                                             const learn::calibration::Evaluation& evaluation,
                                             const touch::pipeline::Model& model, const Origin& origin = {});

}  // namespace dermis::out::report
