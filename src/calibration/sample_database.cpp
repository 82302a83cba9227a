// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/calibration/sample_database.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/labels.hpp"
#include "dermis/compensation/crosstalk.hpp"
#include "dermis/core/parallel.hpp"
#include "dermis/preprocessing/conditioner.hpp"
#include "dermis/preprocessing/phase.hpp"

namespace dermis::calibration {
namespace {

constexpr double kMaxRejectedShare = 0.1;
constexpr std::size_t kFramesPerTask = 128;

/// Labelled frames of the calibrate phase, in order, with supply removed.
struct Selection {
  std::vector<ConditionedFrame> conditioned;
  std::vector<std::size_t> frame;  // index of each in the recording
};

Selection select_and_condition(SampleDatabase& database, std::span<const RawFrame> frames,
                               const std::vector<std::vector<Load>>& loads_of, Nanos settle_time) {
  preprocessing::PhaseSelector phase(settle_time, preprocessing::Phase::calibrate);
  preprocessing::Conditioner conditioner(database.array);
  Selection selection;
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    const bool labelled = !loads_of[frame].empty();
    if (phase.select(frames[frame].time, labelled) != preprocessing::Destination::sample_database) continue;
    ConditionedFrame conditioned;
    conditioner.process(frames[frame], conditioned);
    if (conditioner.rejection() != preprocessing::Rejection::none) {
      if (database.frames_rejected++ == 0) {
        database.first_rejection =
            fmt::format("frame {}: {}", frame, preprocessing::to_string(conditioner.rejection()));
      }
      continue;
    }
    selection.conditioned.push_back(std::move(conditioned));
    selection.frame.push_back(frame);
  }
  return selection;
}

Sample make_sample(const ArrayDescription& array, const RawFrame& raw, std::span<const Load> loads,
                   ConductanceFrame& conductance) {
  Sample sample;
  sample.temperature_celsius = conductance.temperature_celsius;
  sample.reading.resize(array.taxel_count());
  preprocessing::bare_readings(array, raw, sample.reading);
  sample.siemens = std::move(conductance.siemens);
  expand_loads(array, loads, sample);
  // A reading at the end of the ADC no longer tells its force.
  for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
    if (conductance.taxels[taxel] != TaxelStatus::ok) {
      sample.known_newtons[taxel] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  return sample;
}

/// Removes the samples whose readings have no solution in the array's circuit.
void drop_unsolved(SampleDatabase& database, const Selection& selection) {
  for (std::size_t k = 0; k < database.samples.size(); ++k) {
    if (!database.samples[k].siemens.empty()) continue;
    if (database.frames_rejected++ == 0) {
      database.first_rejection = fmt::format(
          "frame {}: readings that the circuit of the array cannot give; check "
          "drive_ohm, load_ohm and supply",
          selection.frame[k]);
    }
  }
  std::erase_if(database.samples, [](const Sample& sample) { return sample.siemens.empty(); });
}

Status check_rejected(const SampleDatabase& database) {
  const auto rejected = static_cast<double>(database.frames_rejected);
  const double all = rejected + static_cast<double>(database.samples.size());
  if (rejected > kMaxRejectedShare * all) {
    return bad_input(
        fmt::format("{} of {} labelled frames cannot be used, the first: {}", rejected, all, database.first_rejection));
  }
  if (database.samples.empty()) return bad_input("no labelled frame is left after settling");
  if (std::none_of(database.samples.begin(), database.samples.end(), [](const Sample& s) { return s.unloaded; })) {
    return bad_input(
        "the loads name no unloaded frame: record a few frames with nothing on the array and label them "
        "'<frame>,force,all,0'");
  }
  return Done{};
}

}  // namespace

Result<SampleDatabase> build_sample_database(const ArrayDescription& array, std::span<const RawFrame> frames,
                                             std::span<const Load> loads, Nanos settle_time) {
  if (Status checked = check_loads(array, frames.size(), loads); !checked) return checked.error();
  SampleDatabase database;
  database.array = array;
  const std::vector<std::vector<Load>> loads_of = group_by_frame(loads, frames.size());
  Selection selection = select_and_condition(database, frames, loads_of, settle_time);
  const std::size_t selected = selection.conditioned.size();
  Result<compensation::Compensator> compensator = compensation::Compensator::create(array);
  if (!compensator) return compensator.error();
  const Readout& readout = array.readout;
  const double reference =
      readout.adc_reference_v && readout.supply_v ? *readout.adc_reference_v / *readout.supply_v : 1.0;
  database.siemens_per_count = compensator->siemens_per_ratio() * reference / readout.full_scale_counts();
  database.samples.resize(selected);
  parallel_for((selected + kFramesPerTask - 1) / kFramesPerTask, [&](std::size_t task) {
    Result<compensation::Compensator> solver = compensation::Compensator::create(array);
    const std::size_t end = std::min(selected, (task + 1) * kFramesPerTask);
    for (std::size_t k = task * kFramesPerTask; k < end; ++k) {
      ConductanceFrame conductance;
      solver->process(selection.conditioned[k], conductance);
      if (has(conductance.status, FrameStatus::not_converged)) continue;
      const std::size_t frame = selection.frame[k];
      database.samples[k] = make_sample(array, frames[frame], loads_of[frame], conductance);
    }
  });
  drop_unsolved(database, selection);
  if (Status checked = check_rejected(database); !checked) return checked.error();
  return database;
}

}  // namespace dermis::calibration
