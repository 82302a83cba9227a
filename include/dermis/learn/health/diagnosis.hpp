// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dermis/learn/health/ageing_monitor.hpp"
#include "dermis/learn/health/fault_words.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "dermis/touch/preprocessing/supply_bounds.hpp"

namespace dermis::learn::health {

struct TemperatureRange {
  double coldest_celsius = 0.0;
  double hottest_celsius = 0.0;
};

/// The health of an array by its frames. Many members: reports show each of them.
struct Diagnosis {
  std::size_t frames = 0;
  std::size_t frames_rejected = 0;
  std::size_t frames_unsolved = 0;                ///< Their readings do not fit the circuit of the array.
  std::map<std::string, std::size_t> rejections;  ///< Frames by the reason.
  double seconds = 0.0;                           ///< From the first to the last frame that was not rejected [s].
  std::optional<double> noise_counts;             ///< Noise of a reading; empty: the array was touched all the time.
  double saturated_share = 0.0;                   ///< Of all readings, 0 ... 1.
  std::string missing_readings;                   ///< The taxels without a reading, in how many frames; empty: none.
  std::optional<double> offset_drift;             ///< Relative drift of the unloaded conductance; empty: not known.
  std::optional<double> offset_spread;            ///< Standard deviation of this drift over the taxels.
  AgeingEvidence ageing;                          ///< Of the gains.
  std::optional<TemperatureRange> temperature;    ///< Empty: no frame carried one.
  std::optional<touch::preprocessing::SupplyRange>
      supply;                            ///< Empty: no frame carried one, or it has no part in the forces.
  double worst_misfit_sigma = 0.0;       ///< Of a solved reading [standard deviations].
  std::vector<std::string> blind_lines;  ///< Read too little unloaded for a break to be seen: "row 3".
  std::vector<FaultHistory> faults;      ///< In the order in which they were found, each time anew.
  std::vector<std::string> findings;     ///< The problems, a sentence each, worst first.
  std::vector<std::string> remarks;      ///< The possible problems, a sentence each.

  [[nodiscard]] bool is_healthy() const noexcept { return findings.empty(); }
};

/// The diagnosis of frames of `model`'s array as lines of text: the measured values, then the findings or "healthy" and
/// the remarks.
[[nodiscard]] std::string describe(const Diagnosis& diagnosis, const touch::pipeline::Model& model);

}  // namespace dermis::learn::health
