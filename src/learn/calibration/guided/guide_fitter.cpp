// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/guided/guide_fitter.hpp"

#include <utility>

#include "dermis/learn/calibration/circuit_fit.hpp"

namespace dermis::learn::calibration {

namespace {

// A last job fits the model, a fit without some presses, and four without some taxels.
constexpr double kModelShare = 1.0 / 6.0;
constexpr double kPressesShare = 2.0 / 6.0;

}  // namespace

GuideFitter::GuideFitter(ArrayDescription array, std::function<void(Outcome)> on_outcome,
                         std::function<void(double)> on_progress)
    : array_(std::move(array)),
      on_outcome_(std::move(on_outcome)),
      on_progress_(std::move(on_progress)),
      thread_([this] { work(); }) {}

GuideFitter::~GuideFitter() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void GuideFitter::fit(Job job) {
  {
    const std::lock_guard lock(mutex_);
    waiting_ = std::move(job);
  }
  wake_.notify_one();
}

void GuideFitter::work() {
  for (;;) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return is_ending_ || waiting_; });
      if (is_ending_) return;
      job = *std::exchange(waiting_, std::nullopt);
    }
    on_outcome_(run(job));
  }
}

GuideFitter::Outcome GuideFitter::run(const Job& job) const {
  if (job.is_last) return run_last(job);
  Outcome outcome;
  if (!array_.has_unknown_circuit()) {
    outcome.error = error_on_left_out_presses(array_, *job.unloaded, job.presses);
    return outcome;
  }
  const GuidedData data = labelled_frames(array_, *job.unloaded, job.presses);
  if (const Result<CircuitFit> circuit = fit_circuit(array_, data.frames, data.loads)) {
    outcome.error = error_on_left_out_presses(circuit->array, *job.unloaded, job.presses);
  }
  return outcome;
}

GuideFitter::Outcome GuideFitter::run_last(const Job& job) const {
  const GuidedData data = labelled_frames(array_, *job.unloaded, job.presses);
  const auto fitted = [this](const std::string& stage, double share) {
    on_progress_(kModelShare * (stage == "circuit" ? 0.0 : share));
  };
  Outcome outcome;
  outcome.calibration = calibrate(array_, data.frames, data.loads, Nanos{0}, fitted);
  if (!*outcome.calibration) return outcome;
  const ArrayDescription& array = outcome.calibration->value().model.array;
  outcome.error = error_on_left_out_presses(array, *job.unloaded, job.presses);
  on_progress_(kPressesShare);
  outcome.unpressed_error = error_on_left_out_taxels(array, *job.unloaded, job.presses, [this](double share) {
    on_progress_(kPressesShare + (1.0 - kPressesShare) * share);
  });
  return outcome;
}

}  // namespace dermis::learn::calibration
