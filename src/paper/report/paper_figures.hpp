// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/out/report/page.hpp"
#include "dermis/paper/paper_report.hpp"

namespace dermis::paper {

/// Figures of the reproduction of the paper. One without data has no panels, and its caption says what is missing.

// Peaks.
[[nodiscard]] out::report::Figure peaks_network_figure();                                ///< Fig. 5
[[nodiscard]] out::report::Figure peaks_surface_figure(const PeaksReproduction& peaks);  ///< Fig. 6
[[nodiscard]] out::report::Figure peaks_maps_figure(const PeaksReproduction& peaks);
[[nodiscard]] out::report::Figure peaks_training_figure(const PeaksReproduction& peaks);
[[nodiscard]] out::report::Figure hidden_units_figure(const PeaksReproduction& peaks);

// The bank.
[[nodiscard]] out::report::Figure bank_network_figure(std::size_t n);  ///< Fig. 8
[[nodiscard]] out::report::Figure log_sigmoid_figure();                ///< Fig. 10
[[nodiscard]] out::report::Figure convergence_figure(const PaperReproduction& reproduction);
[[nodiscard]] out::report::Figure bank_training_figure(const PaperReproduction& reproduction);

/// Fig. 11 to 13.
[[nodiscard]] std::vector<out::report::Figure> point_figures(const PaperReproduction& reproduction);

/// Number of the series of the paper's bank, so that it looks as in the table of estimators.
[[nodiscard]] std::size_t bank_style(const PaperReproduction& reproduction);

}  // namespace dermis::paper
