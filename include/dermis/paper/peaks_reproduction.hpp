// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "dermis/paper/paper_report.hpp"

namespace dermis::paper {

/// How hard Peaks is tried.
struct PeaksEffort {
  std::size_t adaptive_rate_starts = 32;  ///< Each of the paper's 10,000 epochs.
  std::uint64_t adaptive_rate_epochs = 10'000;
  std::size_t paper_size_starts = 2000;  ///< Levenberg-Marquardt on 2-5-1.
  std::size_t starts = 16;               ///< For every other size of the hidden layer.
  /// For the sizes just below one that reached the goal: this number over the square of the hidden units. That takes
  /// about the same time for every size.
  std::size_t starts_times_size_squared = 90'000;
  std::size_t most_hidden = 48;  ///< The search ends there at the latest.
  int iterations = 1000;         ///< Of Levenberg-Marquardt, at most.
};

/// Eq. (1), (2), Fig. 5 and 6: `progress` gets the share that is done. Deterministic.
[[nodiscard]] PeaksReproduction reproduce_peaks(const PeaksEffort& effort, const std::function<void(double)>& progress);

}  // namespace dermis::paper
