// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/resistance_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "learn/calibration/circuit_fit/common_ratio.hpp"
#include "learn/calibration/circuit_fit/driver_presses.hpp"
#include "learn/calibration/circuit_fit/frame_selection.hpp"
#include "learn/calibration/circuit_fit/gauss_newton.hpp"
#include "learn/calibration/circuit_fit/line_parameters.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kStartFrames = 300;   // the start is found with these, fewer where they are large
constexpr std::size_t kFirstFrames = 1500;  // and the way to the solution with these
constexpr double kEnoughAtFirst = 0.1;      // a step this small against the standard errors ends the fit
constexpr double kEnough = 0.25;            // the same, with all frames

/// Given errors stay where the drivers were given.
void keep_given_errors(const Readout& given, Readout& fitted) {
  if (given.drive_error_ohm.empty()) return;
  const auto is_fitted = [](double ohm) { return ohm > 0.0; };
  const bool any_fitted = std::any_of(fitted.drive_error_ohm.begin(), fitted.drive_error_ohm.end(), is_fitted);
  if (!any_fitted) fitted.drive_error_correlation = given.drive_error_correlation;
  fitted.drive_error_ohm.resize(given.drive_error_ohm.size());
  for (std::size_t line = 0; line < given.drive_error_ohm.size(); ++line) {
    if (!is_fitted(fitted.drive_error_ohm[line])) fitted.drive_error_ohm[line] = given.drive_error_ohm[line];
  }
}

ResistanceFit report(const Readout& given, const LineParameters& lines, const Iteration& last,
                     const CircuitFrames& frames) {
  ResistanceFit fit;
  fit.array = lines.array_at(last.estimate.parameters);
  fit.errors = standard_errors(lines, last.estimate.parameters, last.covariance);
  fit.array.readout.drive_error_ohm = fit.errors.drive_ohm;
  fit.array.readout.drive_error_correlation = fit.errors.correlation;
  keep_given_errors(given, fit.array.readout);
  const Eigen::Index drives = lines.drive_count();
  fit.driver_presses = driver_presses(lines, last.estimate, last.covariance.topLeftCorner(drives, drives), frames);
  fit.rubber_scatter = std::sqrt(last.estimate.scatter.rubber_variance);
  fit.sheet_scatter = last.estimate.scatter.sheet;
  fit.has_idle_readings = last.has_idle_readings;
  fit.has_absolute = lines.has_absolute();
  return fit;
}

}  // namespace

Result<ResistanceFit> fit_resistances(const ArrayDescription& array, const CircuitFrames& frames) {
  const LineParameters lines(array);
  const std::size_t most = affordable_frames(lines);
  const auto first = select_frames(frames, std::min(kFirstFrames, most));
  const Rubber unknown = unknown_rubber(frames, array.taxel_count(), 1.0 / lines.reference_ohm());
  const std::size_t quick = affordable_frames_of_choice(array.taxel_count(), is_inverted_slowly(array));
  const auto few =
      select_frames(frames, std::min({kStartFrames, most, std::max(few_frames(array.taxel_count()), quick)}));
  const Result<CommonRatio> common = fit_common_ratio(lines, few, unknown);
  if (!common) return common.error();
  Estimate start{lines.start(common->ratio), common->rubber, common->scatter};
  start.scatter.rubber_variance = std::max(start.scatter.rubber_variance, kRubberScatter * kRubberScatter);
  Result<Iteration> last = iterate(lines, first, start, kEnoughAtFirst);
  if (last && most > first.size() && first.size() < frames.frames.size()) {
    last = iterate(lines, select_frames(frames, most), last->estimate, kEnough);
  }
  if (!last) return last.error();
  return report(array.readout, lines, *last, frames);
}

}  // namespace dermis::learn::calibration
