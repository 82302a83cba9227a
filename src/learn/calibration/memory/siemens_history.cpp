// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/memory/siemens_history.hpp"

#include <algorithm>
#include <limits>

#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "dermis/touch/preprocessing/conditioner.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kMostNumbers = 25'000'000;  // 100 MB of conductances
constexpr std::size_t kFramesPerTask = 256;

std::vector<std::size_t> chosen_frames(const SampleDatabase& database, std::size_t frames) {
  const std::size_t most = std::max<std::size_t>(kMostNumbers / database.array.taxel_count(), 1);
  const std::size_t stride = (frames + most - 1) / most;
  std::vector<bool> is_chosen(frames);
  for (std::size_t k = 0; k < frames; k += stride) is_chosen[k] = true;
  for (const Sample& sample : database.samples) is_chosen[sample.frame] = true;
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < frames; ++k) {
    if (is_chosen[k]) chosen.push_back(k);
  }
  return chosen;
}

}  // namespace

Result<SiemensHistory> read_history(const SampleDatabase& database, std::span<const RawFrame> frames,
                                    const touch::fusion::ForceNetworks& networks) {
  const auto make_solver = [&] { return touch::pipeline::make_compensator(database.array, networks); };
  const Result<touch::compensation::Compensator> checked = make_solver();
  if (!checked) return checked.error();
  SiemensHistory history;
  history.taxels = database.array.taxel_count();
  history.frame = chosen_frames(database, frames.size());
  for (const std::size_t frame : history.frame) {
    history.time.push_back(frames[frame].time);
    history.temperature_celsius.push_back(frames[frame].temperature_celsius);
  }
  if (!database.array.temperature_sensors.empty()) {
    history.taxel_celsius.assign(history.frame.size() * history.taxels, std::numeric_limits<float>::quiet_NaN());
  }
  history.siemens.assign(history.frame.size() * history.taxels, std::numeric_limits<float>::quiet_NaN());
  parallel_for((history.frame.size() + kFramesPerTask - 1) / kFramesPerTask, [&](std::size_t task) {
    Result<touch::compensation::Compensator> solver = make_solver();
    touch::preprocessing::Conditioner conditioner(database.array);
    ConditionedFrame conditioned;
    ConductanceFrame conductance;
    const std::size_t end = std::min(history.frame.size(), (task + 1) * kFramesPerTask);
    for (std::size_t k = task * kFramesPerTask; k < end; ++k) {
      conditioner.process(frames[history.frame[k]], conditioned);
      if (!conditioned.taxel_celsius.empty()) {
        std::copy(conditioned.taxel_celsius.begin(), conditioned.taxel_celsius.end(),
                  history.taxel_celsius.begin() + static_cast<std::ptrdiff_t>(k * history.taxels));
        history.temperature_celsius[k] = conditioned.temperature_celsius;
      }
      solver->process(conditioned, conductance);
      const FrameStatus status = conductance.status;
      if (has(status, FrameStatus::rejected) || has(status, FrameStatus::not_converged)) continue;
      for (std::size_t taxel = 0; taxel < history.taxels; ++taxel) {
        if (conductance.taxels[taxel] == TaxelStatus::invalid) continue;
        history.siemens[k * history.taxels + taxel] = static_cast<float>(conductance.siemens[taxel]);
      }
    }
  });
  return history;
}

}  // namespace dermis::learn::calibration
