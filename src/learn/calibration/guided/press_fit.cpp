// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/guided/press_fit.hpp"

#include <string>

#include "dermis/learn/calibration/circuit_fit.hpp"

namespace dermis::learn::calibration {
namespace {

// A last job fits the model, a fit without some presses, and four without some taxels.
constexpr double kModelShare = 1.0 / 6.0;
constexpr double kPressesShare = 2.0 / 6.0;

FitOutcome fit_last(const ArrayDescription& described, const FitJob& job, const std::function<void(double)>& progress) {
  const GuidedData data = labelled_frames(described, *job.unloaded, job.presses);
  const auto fitted = [&](const std::string& stage, double share) {
    progress(kModelShare * (stage == "circuit" ? 0.0 : share));
  };
  FitOutcome outcome;
  outcome.calibration = calibrate(described, data.frames, data.loads, Nanos{0}, fitted);
  if (!*outcome.calibration) return outcome;
  const ArrayDescription& array = outcome.calibration->value().model.array;
  outcome.error = error_on_left_out_presses(array, *job.unloaded, job.presses);
  progress(kPressesShare);
  outcome.unpressed_error = error_on_left_out_taxels(array, *job.unloaded, job.presses, [&](double share) {
    progress(kPressesShare + (1.0 - kPressesShare) * share);
  });
  return outcome;
}

}  // namespace

FitOutcome fit_presses(const ArrayDescription& array, const FitJob& job, const std::function<void(double)>& progress) {
  if (job.is_last) return fit_last(array, job, progress);
  FitOutcome outcome;
  if (!array.has_unknown_circuit()) {
    outcome.error = error_on_left_out_presses(array, *job.unloaded, job.presses);
    return outcome;
  }
  const GuidedData data = labelled_frames(array, *job.unloaded, job.presses);
  if (const Result<CircuitFit> circuit = fit_circuit(array, data.frames, data.loads)) {
    outcome.error = error_on_left_out_presses(circuit->array, *job.unloaded, job.presses);
  }
  return outcome;
}

}  // namespace dermis::learn::calibration
