// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/circuit_statements.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "learn/calibration/circuit_fit/discriminating_presses.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kUnknown = 0.5;  // relative standard error of a resistance above which nothing can be said

std::string describe_misfit(const CircuitCandidate& candidate) {
  if (candidate.noise_share > 0.0) return "not resolved";
  return std::isfinite(candidate.misfit) ? fmt::format("{:.3g}", candidate.misfit) : "not possible";
}

std::string describe_candidates(const std::vector<CircuitCandidate>& candidates) {
  std::string text =
      fmt::format("circuit: {} (leaves {:.3g} times the noise", candidates.front().name, candidates.front().misfit);
  for (std::size_t k = 1; k < candidates.size(); ++k) {
    text += fmt::format("; {} {}", candidates[k].name, describe_misfit(candidates[k]));
  }
  return text + ")";
}

std::optional<std::string> describe_doubt(const ArrayDescription& array,
                                          const std::vector<CircuitCandidate>& candidates,
                                          const std::vector<PressPair>& discriminating_presses) {
  std::string names;
  for (const CircuitCandidate& candidate : candidates) {
    if (candidate.indistinguishable) names += (names.empty() ? "\"" : ", \"") + candidate.name + "\"";
  }
  if (names.empty()) return std::nullopt;
  const std::string mend = discriminating_presses.empty()
                               ? "two taxels at once with these weights would not either, and "
                                 "forces of one or two presses hardly depend on it"
                               : describe(discriminating_presses, array);
  return "these frames do not tell the chosen circuit from " + names + "; " + mend;
}

/// "18.2 to 22.1 ohm, ±2.6 to 3.1 % each" of the fitted lines of a kind.
struct Range {
  double least_ohm = std::numeric_limits<double>::infinity();
  double most_ohm = 0.0;
  double best_error = 1.0;
  double worst_error = 0.0;
  std::size_t count = 0;
};

Range fitted_range(const std::vector<double>& ohms, const std::vector<double>& errors) {
  Range range;
  for (std::size_t k = 0; k < ohms.size(); ++k) {
    if (errors[k] == 0.0) continue;
    range.least_ohm = std::min(range.least_ohm, ohms[k]);
    range.most_ohm = std::max(range.most_ohm, ohms[k]);
    range.best_error = std::min(range.best_error, errors[k]);
    range.worst_error = std::max(range.worst_error, errors[k]);
    ++range.count;
  }
  return range;
}

std::string describe(const char* name, const Range& range) {
  return fmt::format("{}: {} fitted, {:.4g} to {:.4g} ohm, standard error {:.1f} to {:.1f} % each", name, range.count,
                     range.least_ohm, range.most_ohm, 100.0 * range.best_error, 100.0 * range.worst_error);
}

void describe_drives(const ResistanceFit& fit, std::vector<std::string>& statements) {
  const Range drives = fitted_range(fit.array.readout.drive_ohm, fit.errors.drive);
  if (drives.count == 0) return;
  if (drives.worst_error > kUnknown) {
    statements.push_back(fmt::format(
        "drive_ohm: too small for these frames to tell, at most about {:.3g} ohm{}",
        drives.most_ohm + 2.0 * *std::max_element(fit.errors.drive_ohm.begin(), fit.errors.drive_ohm.end()),
        fit.driver_presses.empty() ? "; what is left of its crosstalk is as small, and forces hardly depend on it"
                                   : ""));
  } else {
    statements.push_back(describe("drive_ohm", drives));
    if (drives.count > 1) {
      statements.back() += fmt::format(", {:.1f} % their mean", 100.0 * fit.errors.common_drive);
    }
  }
  if (!fit.driver_presses.empty()) {
    statements.push_back("drive_ohm: these frames leave it uncertain; a uniform load on the whole array tells it, or " +
                         describe(fit.driver_presses, fit.array));
  }
}

void describe_loads(const ResistanceFit& fit, std::vector<std::string>& statements) {
  const Range loads = fitted_range(fit.array.readout.load_ohm, fit.errors.load);
  if (loads.count == 0) return;
  statements.push_back(describe("load_ohm", loads));
  if (fit.sheet_scatter > 0.0) {
    statements.push_back(
        fmt::format("load_ohm: rests on the unloaded rubber differing from line to line across the loads by no more "
                    "than it does along them, {:.1f} %",
                    100.0 * fit.sheet_scatter));
  }
}

}  // namespace

std::vector<std::string> describe_choice(const ArrayDescription& array, const std::vector<CircuitCandidate>& candidates,
                                         const std::vector<PressPair>& discriminating_presses) {
  std::vector<std::string> statements{describe_candidates(candidates)};
  if (const auto doubt = describe_doubt(array, candidates, discriminating_presses)) statements.push_back(*doubt);
  const bool is_none = candidates.front().name == "none";
  for (const CircuitCandidate& candidate : candidates) {
    if (candidate.noise_share == 0.0) continue;
    statements.push_back(describe_unresolved('"' + candidate.name + '"', candidate.noise_share) +
                         (is_none ? ": readings are taken as they are" : ": it was not compared") +
                         "; single presses would tell of it");
  }
  return statements;
}

std::string describe_unresolved(const std::string& circuit, double noise_share) {
  return fmt::format(
      "the ADC does not resolve {} under these loads (the noise of a reading is {:.0f} % of the conductance of its "
      "taxel)",
      circuit, 100.0 * noise_share);
}

std::vector<std::string> describe_fit(const ResistanceFit& fit) {
  std::vector<std::string> statements;
  if (fit.array.readout.circuit == Circuit::none) {
    statements.emplace_back("no circuit explains the frames better than none: crosstalk stays in the forces");
    return statements;
  }
  if (!fit.has_absolute) {
    statements.push_back(
        fmt::format("no resistance is known, so only ratios are determined: the loads' geometric mean is set to {:g} "
                    "ohm; forces do not depend on it",
                    kNominalLoadOhm));
  }
  describe_drives(fit, statements);
  describe_loads(fit, statements);
  if (!fit.has_idle_readings) {
    statements.emplace_back(
        "the readings of idle taxels are too close to 0 to show crosstalk: the resistances rest on taxels that are "
        "pressed together");
  }
  return statements;
}

}  // namespace dermis::learn::calibration
