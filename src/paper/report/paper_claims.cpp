// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/report/paper_claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "dermis/out/report/estimator_table.hpp"
#include "dermis/out/report/wording.hpp"
#include "paper/report/paper_points.hpp"
#include "paper/report/training_plot.hpp"

namespace dermis::paper {

using out::report::counted;
using out::report::fine_percent;
using out::report::grouped;
using out::report::kPaperTolerance;
using out::report::steps;
using out::report::three_digits;

namespace {

constexpr const char* kNothing = "Nothing is known.";

/// Residuals of a solved system that come from rounding alone are far below this.
constexpr double kSolved = 1e-9;

bool reaches(const PeaksReproduction& peaks, double mse) {
  return mse > 0.0 && mse <= peaks.goal;
}

std::string share_of_variance(const PeaksReproduction& peaks, double mse) {
  return peaks.variance > 0.0 ? fmt::format(", {} of the variance of Peaks", fine_percent(mse / peaks.variance)) : "";
}

Claim gradient_descent_claim(const PeaksReproduction& peaks) {
  Claim claim{
      "eq. (1), (2), Fig. 5, 6",
      fmt::format("A 2-5-1 network, trained with traingdx for at most 10,000 steps, fits Peaks to E \u2264 {:.3g}.",
                  peaks.goal),
      kNothing, Verdict::open};
  if (peaks.adaptive_rate_starts == 0) return claim;
  claim.found = fmt::format("Best E of {} with {} each: {}{}.", counted(peaks.adaptive_rate_starts, "random start"),
                            counted(peaks.adaptive_rate_epochs, "step"), three_digits(peaks.adaptive_rate_best_mse),
                            share_of_variance(peaks, peaks.adaptive_rate_best_mse));
  claim.verdict = reaches(peaks, peaks.adaptive_rate_best_mse) ? Verdict::holds : Verdict::fails;
  return claim;
}

Claim network_size_claim(const PeaksReproduction& peaks) {
  Claim claim{"Fig. 5", fmt::format("The structure 2-5-1 is large enough for E \u2264 {:.3g}.", peaks.goal), kNothing,
              Verdict::open};
  const auto five = std::find_if(peaks.by_hidden.begin(), peaks.by_hidden.end(),
                                 [](const HiddenLayerFit& fit) { return fit.hidden == 5; });
  if (five == peaks.by_hidden.end()) return claim;
  claim.found =
      fmt::format("Best E that Levenberg-Marquardt finds from {}: {}{}.", counted(five->starts, "random start"),
                  three_digits(five->best_mse), share_of_variance(peaks, five->best_mse));
  if (five->best_mse_normalised > 0.0) {
    claim.found += fmt::format(" With targets scaled to [0, 1]: {}.", three_digits(five->best_mse_normalised));
  }
  claim.verdict = reaches(peaks, five->best_mse)              ? Verdict::holds
                  : reaches(peaks, five->best_mse_normalised) ? Verdict::holds_scaled
                                                              : Verdict::fails;
  return claim;
}

std::string smallest_words(const std::optional<std::size_t>& hidden) {
  return hidden ? fmt::format("from {} hidden units on", *hidden) : "with none of the sizes tried";
}

Claim approximation_claim(const PeaksReproduction& peaks) {
  Claim claim{"text to Fig. 6 and 8",
              "With enough neurons in the hidden layer a network reaches higher accuracy for any function.", kNothing,
              Verdict::open};
  if (peaks.by_hidden.empty()) return claim;
  claim.found = fmt::format(
      "E \u2264 {:.3g} is reached {} in the units of Peaks, and {} with targets scaled to [0, 1].", peaks.goal,
      smallest_words(peaks.smallest_hidden_raw), smallest_words(peaks.smallest_hidden_normalised));
  claim.verdict = peaks.smallest_hidden_raw          ? Verdict::holds
                  : peaks.smallest_hidden_normalised ? Verdict::holds_scaled
                                                     : Verdict::fails;
  return claim;
}

Claim unknowns_claim(const PaperReproduction& reproduction) {
  Claim claim{"text after eq. (6)",
              "A 16 x 16 array, N = 256, has 2N\u00b3 + N\u00b2 connections and 2N\u00b2 + N thresholds: 33,751,296 "
              "unknowns.",
              kNothing, Verdict::open};
  if (reproduction.unknowns == 0) return claim;
  const UnknownCount count = count_unknowns(reproduction.rows * reproduction.cols);
  const bool follows = reproduction.unknowns == count.connections + count.thresholds;
  claim.found = fmt::format("{} unknowns counted in the bank of {} networks {}-{}-{}-1; the two formulas say {}.",
                            grouped(reproduction.unknowns), grouped(count.n), count.n, count.n, count.n,
                            follows ? "the same" : grouped(count.connections + count.thresholds));
  claim.verdict = follows ? Verdict::holds : Verdict::fails;
  return claim;
}

double largest_residual(const std::vector<StartSystem>& systems) {
  double largest = 0.0;
  for (const StartSystem& system : systems) {
    if (!std::isfinite(system.residual)) return system.residual;
    largest = std::max(largest, system.residual);
  }
  return largest;
}

bool sees_own_position_only(const std::vector<StartSystem>& systems) {
  return std::all_of(systems.begin(), systems.end(), [](const StartSystem& system) {
    return std::abs(system.neighbour.value_or(0.0)) < kSolved && std::abs(system.other.value_or(0.0)) < kSolved;
  });
}

Claim start_claim(const PaperReproduction& reproduction) {
  Claim claim{"eq. (7) to (15)",
              "The systems (11), (12) and (15) give starting values that keep outputs between 0.25 and 0.75.", kNothing,
              Verdict::open};
  const std::vector<StartSystem>& systems = reproduction.start;
  if (systems.empty()) return claim;
  claim.found = fmt::format("{} solved; largest deviation from the printed equations {}.",
                            counted(systems.size(), "system"), three_digits(largest_residual(systems)));
  if (sees_own_position_only(systems)) {
    claim.found +=
        " But \u03c9_B = \u03c9_C = 0 throughout: until the small random numbers are added, the network has no "
        "connection to neighbours, and the start knows nothing of crosstalk.";
  }
  claim.verdict = largest_residual(systems) < kSolved ? Verdict::holds : Verdict::fails;
  return claim;
}

/// "structured start: 0.05 -> 0.002 in 2,000 steps; ...", with an arrow.
std::string errors_of_starts(const std::vector<TrainingCurve>& curves) {
  std::string words;
  for (const TrainingCurve& curve : curves) {
    if (!words.empty()) words += "; ";
    words += fmt::format("{}: {} \u2192 {} in {}", curve.name, three_digits(curve.value.front()),
                         three_digits(final_error(curve)), steps(curve.step.back()));
  }
  return words;
}

Claim convergence_claim(const PaperReproduction& reproduction) {
  Claim claim{"text before eq. (7), Fig. 9",
              "The nearer the start is to the optimum, the shorter the training; the structured start brings it near.",
              kNothing, Verdict::open};
  std::vector<TrainingCurve> curves = reproduction.convergence;
  if (curves.empty() || !has_points(curves.front())) return claim;
  std::erase_if(curves, [](const TrainingCurve& curve) { return !has_points(curve); });
  if (curves.size() < 2) return claim;
  claim.found =
      "Error of gradient descent from each start, first and mean of the last tenth: " + errors_of_starts(curves) + ".";
  const double structured = final_error(curves.front());
  const bool is_lowest = std::isfinite(structured) &&
                         std::none_of(curves.begin() + 1, curves.end(),
                                      [&](const TrainingCurve& curve) { return final_error(curve) <= structured; });
  claim.verdict = is_lowest ? Verdict::holds : Verdict::fails;
  return claim;
}

Claim error_claim(const PaperReproduction& reproduction, std::string claimed, PointError error) {
  Claim claim{"Fig. 11 to 13", std::move(claimed), kNothing, Verdict::open};
  if (reproduction.points.empty()) return claim;
  claim.found = fmt::format("{} of {} within 5\u00a0%. Largest error at {}.", count_within(reproduction.points, error),
                            counted(reproduction.points.size(), "point"), worst_by_level(reproduction, error));
  claim.verdict = worst_error(reproduction.points, error) <= kPaperTolerance ? Verdict::holds : Verdict::fails;
  return claim;
}

Claim voltages_claim(const PaperReproduction& reproduction) {
  Claim claim{"text to Fig. 11",
              "At 10, 20 and 50 N the output voltage is 3.635\u00a0V and 2.410\u00a0V: two values for three forces.",
              kNothing, Verdict::open};
  std::string voltages;
  for (const PaperLevel& level : paper_levels(reproduction)) {
    if (level.points.empty()) continue;
    if (!voltages.empty()) voltages += ", ";
    voltages += fmt::format("{}\u00a0V at {:.4g}\u00a0N", three_digits(mean_of(level.points, &PaperPoint::output_v)),
                            level.newtons);
  }
  if (!voltages.empty()) {
    claim.found = "On the simulated array the mean output is " + voltages +
                  ". Which force the two values belong to is not said, nor the circuit that gives them.";
  }
  return claim;
}

}  // namespace

std::string to_words(Verdict verdict) {
  switch (verdict) {
    case Verdict::holds: return "holds";
    case Verdict::holds_scaled: return "holds on scaled targets only";
    case Verdict::fails: return "does not hold";
    case Verdict::open: return "not judged";
  }
  return "";
}

std::vector<Claim> judge(const PaperReproduction& reproduction) {
  return {gradient_descent_claim(reproduction.peaks),
          network_size_claim(reproduction.peaks),
          approximation_claim(reproduction.peaks),
          unknowns_claim(reproduction),
          start_claim(reproduction),
          convergence_claim(reproduction),
          error_claim(reproduction, "The output voltage agrees with that of the calibration; we take: within 5\u00a0%.",
                      voltage_error),
          error_claim(reproduction, "The relative error of the force is within 5\u00a0%: the paper's bank of networks.",
                      bank_error),
          error_claim(reproduction,
                      "The same for dermis: first the exact inversion of the circuit, then a small BP network a taxel.",
                      dermis_error),
          voltages_claim(reproduction)};
}

UnknownCount count_unknowns(std::size_t n) {
  return {n, 2 * n * n * n + n * n, 2 * n * n + n};
}

}  // namespace dermis::paper
