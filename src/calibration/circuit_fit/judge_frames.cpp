// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "calibration/circuit_fit/inverted_frame.hpp"
#include "calibration/circuit_fit/pressed_readings.hpp"
#include "calibration/circuit_fit/resistance_fit.hpp"
#include "dermis/core/parallel.hpp"

namespace dermis::calibration {
namespace {

double idle_square(double siemens, double sigma_siemens, double expected_siemens) {
  return std::pow((siemens - expected_siemens) / sigma_siemens, 2);
}

double pressed_square(const PressedReading& reading, const Rubber& rubber, double cut) {
  const Scatter scatter;  // the same for all circuits
  const PressedPoint point = pressed_point(reading, rubber, scatter);
  if (!point.usable) return cut;
  return point.residual * point.residual / (point.relative_variance + scatter.rubber_variance);
}

double judge_frame(SlopedInversion& inversion, const CircuitFrame& frame, const Rubber& rubber, double cut) {
  const std::optional<InvertedFrame> inverted = invert_frame(inversion, frame, rubber);
  if (!inverted) return cut;
  const Eigen::VectorXd basis = unloaded_basis(rubber, frame.temperature);
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t taxel = 0; taxel < rubber.laws.size(); ++taxel) {
    const TaxelLaw& law = rubber.laws[taxel];
    const auto newtons = static_cast<double>(frame.newtons[taxel]);
    const double siemens = inverted->siemens[taxel];
    const double sigma = inverted->sigma_siemens[taxel];
    double square = 0.0;
    if (newtons == 0.0 && law.unloaded.size() > 0) {
      square = idle_square(siemens, sigma, law.unloaded.dot(basis) * rubber.reference_siemens);
    } else if (newtons > 0.0 && law.pressed.size() > 0) {
      const double log_force = rubber.force_scale.log_force(newtons);
      square = pressed_square({taxel, log_force, frame.temperature, siemens, sigma, {}}, rubber, cut);
    } else {
      continue;
    }
    sum += square < cut ? square : cut;
    count += 1.0;
  }
  return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<double> judge_frames(const ResistanceFit& fit, const CircuitFrames& frames, double cut) {
  const LineParameters known(fit.array);
  std::vector<double> squares(frames.frames.size(), cut);
  parallel_for((squares.size() + kFramesPerTask - 1) / kFramesPerTask, [&](std::size_t task) {
    auto inversion = SlopedInversion::create(known, Eigen::VectorXd(0), Slopes::none);
    if (!inversion) return;
    const std::size_t end = std::min(squares.size(), (task + 1) * kFramesPerTask);
    for (std::size_t k = task * kFramesPerTask; k < end; ++k) {
      squares[k] = judge_frame(*inversion, frames.frames[k], fit.rubber, cut);
    }
  });
  return squares;
}

}  // namespace dermis::calibration
