// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/calibration/calibrate.hpp"

#include <fmt/core.h>

#include <chrono>
#include <mutex>
#include <utility>

#include "dermis/calibration/baselines.hpp"
#include "dermis/calibration/sample_database.hpp"

namespace dermis::calibration {
namespace {

/// Runs a stage of the calibration and notes its time.
template <typename Work>
auto timed(CalibrationReport& report, const char* stage, Work work) {
  const auto start = std::chrono::steady_clock::now();
  auto result = work();
  report.stages.push_back({stage, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()});
  return result;
}

std::map<std::string, std::string> provenance(const ArrayDescription& array, const CalibrationReport& report) {
  const TrainingReport& training = report.training;
  std::map<std::string, std::string> facts{
      {"labelled frames", fmt::format("{}", report.frames)},
      {"rejected frames", fmt::format("{}", report.frames_rejected)},
      {"networks", training.choice},
      {"loads", fmt::format("{:.3g} to {:.3g} N", training.lightest_newtons, training.heaviest_newtons)},
      {"dead taxels", fmt::format("{}", training.dead_taxels.size())},
      {"fit error", describe_fit(training, array)}};
  facts["temperature"] = training.uses_temperature
                             ? fmt::format("{:.1f} to {:.1f} C", training.lowest_celsius, training.highest_celsius)
                             : "not an input (less than 3 C apart, or missing in many frames)";
  return facts;
}

}  // namespace

Result<Calibration> calibrate(const ArrayDescription& array, std::span<const RawFrame> frames,
                              std::span<const Load> loads, Nanos settle_time, const Progress& progress) {
  std::mutex progress_mutex;
  const auto tell = [&](const char* stage, double share) {
    if (!progress) return;
    const std::lock_guard lock(progress_mutex);
    progress(stage, share);
  };

  Calibration calibration;
  CalibrationReport& report = calibration.report;
  tell("circuit", 0.0);
  const Result<SampleDatabase> database =
      timed(report, "circuit", [&] { return build_sample_database(array, frames, loads, settle_time); });
  if (!database) return database.error();
  tell("circuit", 1.0);
  Result<ForceTraining> training = timed(report, "networks", [&] {
    return train_force_networks(*database, [&](double share) { tell("networks", share); });
  });
  if (!training) return training.error();
  calibration.model.baselines = timed(report, "baselines", [&] { return make_baselines(*database); });

  report.frames = database->samples.size();
  report.frames_rejected = database->frames_rejected;
  report.first_rejection = database->first_rejection;
  report.training = std::move(training->report);
  calibration.model.array = array;
  calibration.model.networks = std::move(training->networks);
  calibration.model.provenance = provenance(array, report);
  return calibration;
}

}  // namespace dermis::calibration
