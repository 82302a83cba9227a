// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/learn/calibration/force_training.hpp"
#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/learn/calibration/uncertainty.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::learn::calibration {

/// Where the time of a calibration went.
struct StageTime {
  std::string stage;
  double seconds = 0.0;
};

/// Relative errors on loads that were left out of the networks' training, one at a time.
struct UnseenErrors {
  double median = 0.0;
  double p95 = 0.0;
};

/// The course of a calibration and its fit to its own samples.
struct CalibrationReport {
  std::size_t frames = 0;  ///< Labelled frames used.
  std::size_t frames_rejected = 0;
  std::string first_rejection;
  std::vector<std::string> remarks;               ///< On labels and readings: SampleDatabase::remarks.
  std::vector<std::string> doubts;                ///< On circuit and ADC: SampleDatabase::doubts.
  bool lacks_proof = false;                       ///< SampleDatabase::lacks_proof.
  std::vector<std::string> circuit;               ///< The findings on an unknown circuit; empty where all was given.
  std::vector<PressPair> discriminating_presses;  ///< Would distinguish the remaining circuits; see CircuitFit.
  std::vector<PressPair> driver_presses;          ///< Would determine drivers that are uncertain; see CircuitFit.
  std::string memory;  ///< A sentence on the memory of the material; empty: nothing was learned.
  TrainingReport training;
  std::optional<UnseenErrors> unseen;  ///< Empty where no load could be left out.
  UncertaintyReport uncertainty;
  std::vector<StageTime> stages;
};

struct Calibration {
  touch::pipeline::Model model;
  CalibrationReport report;
};

/// Called with the stage and the share of it that is done, [0, 1]; may come from any thread, one call at a time.
using Progress = std::function<void(const std::string& stage, double share)>;

/// The learning phase: frames with known loads -> a model. Deterministic, whatever the number of threads.
/// Errors: those of build_sample_database() and train_force_networks().
[[nodiscard]] Result<Calibration> calibrate(const ArrayDescription& array, std::span<const RawFrame> frames,
                                            std::span<const Load> loads, Nanos settle_time = Nanos{0},
                                            const Progress& progress = {});

/// The same from samples that are there already, of the recording `frames`; the report has no stage "circuit".
/// Errors: those of train_force_networks().
[[nodiscard]] Result<Calibration> calibrate(const SampleDatabase& database, std::span<const RawFrame> frames,
                                            const Progress& progress = {});

/// The same without the recording: the memory of the material is not learned.
[[nodiscard]] Result<Calibration> calibrate(const SampleDatabase& database, const Progress& progress = {});

}  // namespace dermis::learn::calibration
