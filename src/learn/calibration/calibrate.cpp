// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/calibrate.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include "dermis/touch/frames/quantile.hpp"
#include "learn/calibration/memory/memory_training.hpp"
#include "learn/calibration/preparation.hpp"
#include "learn/calibration/tables/baselines.hpp"

namespace dermis::learn::calibration {
namespace {

/// Runs a stage of the calibration and notes its time.
template <typename Work>
auto timed(CalibrationReport& report, const char* stage, Work work) {
  const auto start = std::chrono::steady_clock::now();
  auto result = work();
  report.stages.push_back({stage, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()});
  return result;
}

/// Errors in the labels may be the reason why nothing can be learned from them.
Error with_remarks(Error error, const std::vector<std::string>& remarks) {
  if (!remarks.empty()) error.message += fmt::format("; {}", fmt::join(remarks, "; "));
  return error;
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
  facts["uncertainty"] = describe(report.uncertainty, array);
  facts["temperature"] = training.uses_temperature
                             ? fmt::format("{:.1f} to {:.1f} C", training.lowest_celsius, training.highest_celsius)
                             : "not an input (less than 3 C apart, or missing in many frames)";
  if (report.unseen) {
    facts["loads left out"] = fmt::format("half of them within {:.2g} %, 19 of 20 within {:.2g} %",
                                          100.0 * report.unseen->median, 100.0 * report.unseen->p95);
  }
  if (!report.memory.empty()) facts["memory"] = report.memory;
  if (!report.remarks.empty()) facts["remarks"] = fmt::format("{}", fmt::join(report.remarks, "; "));
  if (!report.doubts.empty()) facts[touch::pipeline::kDoubts] = fmt::format("{}", fmt::join(report.doubts, "; "));
  if (!report.circuit.empty()) facts["circuit"] = fmt::format("{}", fmt::join(report.circuit, "; "));
  return facts;
}

/// Remarks on the quality of most of the array, before any other.
void remark_unpressed(const ArrayDescription& array, CalibrationReport& report) {
  const UncertaintyReport& uncertainty = report.uncertainty;
  const auto& sigma = uncertainty.relative_sigma_of_unpressed;
  if (!sigma || 2 * uncertainty.unpressed_taxels < array.taxel_count()) return;
  report.remarks.insert(report.remarks.begin(), fmt::format("{} of {} taxels were not pressed: their forces are \u00b1 "
                                                            "{:.0f} % at best, as taxels differ; five loads of an "
                                                            "air bladder over all of them tell each one's gain",
                                                            uncertainty.unpressed_taxels, array.taxel_count(),
                                                            100.0 * *std::min_element(sigma->begin(), sigma->end())));
}

/// Forces are judged on heavier loads alone: less than a fiftieth of the heaviest is no force to rely on.
std::optional<UnseenErrors> unseen_errors(const ForceTraining& training) {
  constexpr double kJudgedShare = 1.0 / 50.0;
  std::vector<double> errors;
  for (const auto* loads : {&training.tested_own, &training.tested_shared, &training.tested_tables}) {
    for (const TestedLoad& load : *loads) {
      const bool is_judged = load.newtons >= kJudgedShare * training.report.heaviest_newtons;
      if (is_judged) errors.push_back(std::abs(load.error_n) / load.newtons);
    }
  }
  if (errors.empty()) return std::nullopt;
  return UnseenErrors{upper_median(errors), quantile(errors, 0.95)};
}

void report_samples(const SampleDatabase& database, CalibrationReport& report) {
  report.frames = database.samples.size();
  report.frames_rejected = database.frames_rejected;
  report.first_rejection = database.first_rejection;
  report.remarks = database.remarks;
  report.doubts = database.doubts;
  report.lacks_proof = database.lacks_proof;
  if (!database.circuit_fit) return;
  report.circuit = database.circuit_fit->statements;
  report.discriminating_presses = database.circuit_fit->discriminating_presses;
  report.driver_presses = database.circuit_fit->driver_presses;
}

}  // namespace

Result<SampleDatabase> build_sample_database(const ArrayDescription& array, std::span<const RawFrame> frames,
                                             std::span<const Load> loads, Nanos settle_time,
                                             const std::function<void(double)>& progress) {
  Preparation preparation(array, frames, loads, settle_time);
  if (Status checked = preparation.check_labels(); !checked) return checked.error();
  preparation.find_rail();
  preparation.find_settling();
  preparation.find_cover();
  if (Status found = preparation.find_circuit(); !found) return found.error();
  preparation.find_film();
  preparation.judge_instrument();
  preparation.doubt_circuit();
  return preparation.invert(progress);
}

Result<Calibration> calibrate(const ArrayDescription& array, std::span<const RawFrame> frames,
                              std::span<const Load> loads, Nanos settle_time, const Progress& progress) {
  CalibrationReport circuit;
  if (progress) progress("circuit", 0.0);
  const Result<SampleDatabase> database =
      timed(circuit, "circuit", [&] { return build_sample_database(array, frames, loads, settle_time); });
  if (!database) return database.error();
  if (progress) progress("circuit", 1.0);
  Result<Calibration> calibration = calibrate(*database, frames, progress);
  if (calibration) {
    std::vector<StageTime>& stages = calibration->report.stages;
    stages.insert(stages.begin(), circuit.stages.begin(), circuit.stages.end());
  }
  return calibration;
}

Result<Calibration> calibrate(const SampleDatabase& database, const Progress& progress) {
  return calibrate(database, {}, progress);
}

Result<Calibration> calibrate(const SampleDatabase& database, std::span<const RawFrame> frames,
                              const Progress& progress) {
  std::mutex progress_mutex;
  const auto tell_networks = [&](double share) {
    if (!progress) return;
    const std::lock_guard lock(progress_mutex);
    progress("networks", share);
  };

  Calibration calibration;
  CalibrationReport& report = calibration.report;
  Result<ForceTraining> training =
      timed(report, "networks", [&] { return train_force_networks(database, tell_networks); });
  if (!training) return with_remarks(training.error(), database.remarks);
  std::optional<LearnedMemory> memory;
  if (is_continuous(frames) || loads_follow_each_other(database, frames))
    memory = timed(report, "memory", [&] { return learn_memory(database, frames, *training); });
  if (memory) {
    calibration.model.memory = memory->law;
    report.memory = describe(*memory);
    training = std::move(memory->training);
  }
  calibration.model.baselines = timed(report, "baselines", [&] { return make_baselines(database); });

  report_samples(database, report);
  calibration.model.array = database.array;
  calibration.model.supply = database.supply;
  calibration.model.networks = training->networks;
  Result<UncertaintyReport> uncertainty = timed(report, "uncertainty", [&] {
    return fit_uncertainty(memory ? memory->material : database, *training, calibration.model);
  });
  if (!uncertainty) return uncertainty.error();
  report.uncertainty = *uncertainty;
  report.unseen = unseen_errors(*training);
  remark_unpressed(database.array, report);
  report.training = std::move(training->report);
  calibration.model.provenance = provenance(database.array, report);
  return calibration;
}

}  // namespace dermis::learn::calibration
