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

Sample make_sample(const ArrayDescription& array, std::size_t frame, const RawFrame& raw, std::span<const Load> loads,
                   const ConditionedFrame& conditioned, ConductanceFrame& conductance) {
  Sample sample;
  sample.frame = frame;
  sample.temperature_celsius = conductance.temperature_celsius;
  sample.reading.resize(array.taxel_count());
  preprocessing::bare_readings(array, raw, sample.reading);
  sample.ratio = conditioned.ratio;
  sample.sigma_ratio = conditioned.sigma_ratio;
  sample.siemens = std::move(conductance.siemens);
  expand_loads(array, loads, sample);
  // A reading at the end of the ADC no longer tells its force.
  for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
    if (conductance.taxels[taxel] != TaxelStatus::ok) {
      sample.known_newtons[taxel] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  std::erase_if(sample.totals, [&](const TotalForce& total) {
    return std::any_of(total.taxels.begin(), total.taxels.end(),
                       [&](std::size_t taxel) { return conductance.taxels[taxel] != TaxelStatus::ok; });
  });
  return sample;
}

/// Leaves out the samples for which `is_bad` holds, and counts them.
template <typename Predicate>
void reject_if(SampleDatabase& database, Predicate is_bad, const char* reason) {
  for (const Sample& sample : database.samples) {
    if (!is_bad(sample)) continue;
    if (database.frames_rejected++ == 0) database.first_rejection = fmt::format("frame {}: {}", sample.frame, reason);
  }
  std::erase_if(database.samples, is_bad);
}

void reject_unsolved(SampleDatabase& database) {
  reject_if(
      database, [](const Sample& sample) { return sample.siemens.empty(); },
      "readings that the circuit of the array cannot give; check drive_ohm, load_ohm, supply and stuck lines");
}

/// A few samples without a temperature among many with one are left out, so that temperature stays an input.
void reject_without_temperature(SampleDatabase& database) {
  const auto lacks_temperature = [](const Sample& sample) { return !sample.temperature_celsius; };
  const auto lacking = std::count_if(database.samples.begin(), database.samples.end(), lacks_temperature);
  if (static_cast<double>(lacking) > kMaxRejectedShare * static_cast<double>(database.samples.size())) return;
  reject_if(database, lacks_temperature, "no temperature, where most frames have one");
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
  if (array.has_unknown_circuit()) {
    Result<CircuitFit> fit = fit_circuit(array, frames, loads, settle_time);
    if (!fit) return fit.error();
    Result<SampleDatabase> database = build_sample_database(fit->array, frames, loads, settle_time);
    if (database) database->circuit_fit = std::move(*fit);
    return database;
  }
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
      solver->forget();  // whatever task a frame is in, its bits are the same
      solver->process(selection.conditioned[k], conductance);
      const std::size_t frame = selection.frame[k];
      database.samples[k].frame = frame;
      if (has(conductance.status, FrameStatus::not_converged)) continue;
      database.samples[k] =
          make_sample(array, frame, frames[frame], loads_of[frame], selection.conditioned[k], conductance);
    }
  });
  reject_unsolved(database);
  reject_without_temperature(database);
  if (Status checked = check_rejected(database); !checked) return checked.error();
  return database;
}

}  // namespace dermis::calibration
