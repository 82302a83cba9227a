// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/measurements.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "dermis/learn/calibration/parallel.hpp"
#include "learn/calibration/circuit_fit/sloped_inversion.hpp"

namespace dermis::learn::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Other readings give a first law and are no further evidence.
bool tells_when_idle(const TaxelLaw& law) {
  return law.is_readable || law.unloaded.size() == 0;
}

void add_idle(const CircuitFrame& frame, const InvertedFrame& inverted, const Estimate& estimate,
              NormalEquations& idle) {
  const Rubber& rubber = estimate.rubber;
  const Index slopes = inverted.slopes.cols();
  const VectorXd basis = unloaded_basis(rubber, frame.temperature);
  MatrixXd rows(slopes + 1, inverted.slopes.rows());
  Index used = 0;
  for (std::size_t taxel = 0; taxel < rubber.laws.size(); ++taxel) {
    if (frame.newtons[taxel] != 0.0F || !tells_when_idle(rubber.laws[taxel])) continue;
    if (!std::isfinite(inverted.sigma_siemens[taxel])) continue;
    const double relative_sigma = inverted.sigma_siemens[taxel] / rubber.reference_siemens;
    const double weight = 1.0 / (relative_sigma * relative_sigma);
    auto row = rows.col(used++);
    row.head(slopes) = inverted.slopes_of(taxel) / rubber.reference_siemens;
    row[slopes] = inverted.siemens[taxel] / rubber.reference_siemens;
    idle.add_local(taxel, basis, row, weight);
    row *= std::sqrt(weight);
  }
  if (used == 0) return;  // a product over no columns divides by their number
  idle.global.selfadjointView<Eigen::Lower>().rankUpdate(rows.leftCols(used));
}

void add_pressed(const CircuitFrame& frame, const InvertedFrame& inverted, const ForceScale& scale,
                 std::vector<PressedReading>& pressed) {
  for (std::size_t taxel = 0; taxel < frame.newtons.size(); ++taxel) {
    if (!(frame.newtons[taxel] > 0.0F)) continue;
    pressed.push_back({taxel, scale.log_force(static_cast<double>(frame.newtons[taxel])), frame.temperature,
                       inverted.siemens[taxel], inverted.sigma_siemens[taxel], inverted.slopes_of(taxel)});
  }
}

Measurements no_measurements(const Rubber& rubber, Index parameters) {
  return {NormalEquations(rubber.laws.size(), rubber.unloaded_terms, parameters + 1), {}, 0};
}

void add(const CircuitFrame& frame, const std::optional<InvertedFrame>& inverted, const Estimate& estimate,
         Measurements& measurements) {
  if (!inverted) {
    ++measurements.lost_frames;
    return;
  }
  add_idle(frame, *inverted, estimate, measurements.idle);
  add_pressed(frame, *inverted, estimate.rubber.force_scale, measurements.pressed);
}

Measurements merge(std::vector<Measurements> parts) {
  Measurements all = std::move(parts.front());
  for (std::size_t k = 1; k < parts.size(); ++k) {
    all.idle += parts[k].idle;
    all.lost_frames += parts[k].lost_frames;
    std::move(parts[k].pressed.begin(), parts[k].pressed.end(), std::back_inserter(all.pressed));
  }
  return all;
}

}  // namespace

Result<Measurements> measure(const LineParameters& lines, const std::vector<const CircuitFrame*>& frames,
                             const Estimate& estimate) {
  if (auto trial = SlopedInversion::create(lines, estimate.parameters, Slopes::none); !trial) return trial.error();
  const Rubber& rubber = estimate.rubber;
  const Measurements nothing = no_measurements(rubber, lines.count());
  const std::size_t per_task = frames_per_task(lines.array());
  const std::size_t tasks = std::max<std::size_t>(1, (frames.size() + per_task - 1) / per_task);
  std::vector<Measurements> parts(tasks, nothing);
  parallel_for(tasks, [&](std::size_t task) {
    auto inversion = SlopedInversion::create(lines, estimate.parameters, Slopes::all);
    for (std::size_t k = task * per_task; k < std::min(frames.size(), (task + 1) * per_task); ++k) {
      add(*frames[k], invert_frame(*inversion, *frames[k], rubber), estimate, parts[task]);
    }
  });
  return merge(std::move(parts));
}

Measurements measure(const InvertedFrames& inverted, const std::vector<const CircuitFrame*>& frames,
                     const Estimate& estimate) {
  Measurements all = no_measurements(estimate.rubber, 0);
  for (std::size_t k = 0; k < frames.size(); ++k) add(*frames[k], inverted[k], estimate, all);
  return all;
}

}  // namespace dermis::learn::calibration
