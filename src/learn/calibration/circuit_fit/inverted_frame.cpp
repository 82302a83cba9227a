// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/inverted_frame.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dermis/learn/calibration/parallel.hpp"
#include "learn/calibration/circuit_fit/cut_readings.hpp"
#include "learn/calibration/circuit_fit/line_parameters.hpp"
#include "learn/calibration/labels/labels.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kKnownFramesPerTask = 16;  // few, so that no core is idle at the end

/// The readings that the circuit would give with the idle taxels at their laws, and their inversion.
struct SmoothFrame {
  std::vector<double> ratio;
  std::vector<double> siemens;
};

std::optional<SmoothFrame> without_idle_noise(SlopedInversion& inversion, const CircuitFrame& frame,
                                              const InvertedFrame& inverted, const Rubber& rubber) {
  constexpr int kMaxSteps = 10;
  constexpr double kEnoughSigmas = 0.02;
  SmoothFrame smooth{frame.ratio, inverted.siemens};
  const Eigen::VectorXd basis = unloaded_basis(rubber, frame.temperature);
  for (int k = 0; k < kMaxSteps; ++k) {
    double largest = 0.0;
    for (std::size_t taxel = 0; taxel < smooth.ratio.size(); ++taxel) {
      const Eigen::VectorXd& law = rubber.laws[taxel].unloaded;
      if (frame.newtons[taxel] != 0.0F || law.size() == 0) continue;
      const double expected = law.dot(basis) * rubber.reference_siemens;
      const double sigmas = (smooth.siemens[taxel] - expected) / inverted.sigma_siemens[taxel];
      smooth.ratio[taxel] -= sigmas * frame.sigma_ratio;
      largest = std::max(largest, std::abs(sigmas));
    }
    if (!inversion.invert(smooth.ratio, smooth.siemens)) return std::nullopt;
    if (largest < kEnoughSigmas) break;
  }
  return smooth;
}

/// Idle readings without the rise of their mean by the cut at 0; those that are no evidence have infinite noise.
void correct_for_cut(const CircuitFrame& frame, const SmoothFrame& smooth, const Rubber& rubber,
                     InvertedFrame& inverted) {
  for (std::size_t taxel = 0; taxel < inverted.siemens.size(); ++taxel) {
    if (frame.newtons[taxel] != 0.0F || rubber.laws[taxel].unloaded.size() == 0) continue;
    const double expected = smooth.ratio[taxel];
    double& sigma = inverted.sigma_siemens[taxel];
    const double added = mean_above(0.0, expected, frame.sigma_ratio) - expected;
    inverted.siemens[taxel] -= added * sigma / frame.sigma_ratio;
    if (expected < trusted_above(frame)) sigma = std::numeric_limits<double>::infinity();
  }
}

/// false: as invert_frame().
bool add_slopes(SlopedInversion& inversion, const CircuitFrame& frame, const Rubber& rubber, InvertedFrame& inverted) {
  const std::optional<SmoothFrame> smooth = without_idle_noise(inversion, frame, inverted, rubber);
  if (!smooth) return false;
  for (std::size_t taxel = 0; taxel < inverted.siemens.size(); ++taxel) {
    if (frame.newtons[taxel] != 0.0F) inverted.siemens[taxel] = smooth->siemens[taxel];
  }
  correct_for_cut(frame, *smooth, rubber, inverted);
  return inversion.differentiate(smooth->ratio, smooth->siemens, inverted.slopes);
}

bool invert_into(SlopedInversion& inversion, const CircuitFrame& frame, const Rubber& rubber, InvertedFrame& inverted) {
  inversion.hold_film(film_newtons(frame.newtons, frame.totals));
  if (!inversion.invert(frame.ratio, inverted.siemens)) return false;
  inversion.propagate_noise(frame.sigma_ratio, inverted.sigma_siemens);
  return inversion.slope_count() == 0 || add_slopes(inversion, frame, rubber, inverted);
}

}  // namespace

std::optional<InvertedFrame> invert_frame(SlopedInversion& inversion, const CircuitFrame& frame, const Rubber& rubber) {
  const std::size_t taxels = frame.ratio.size();
  InvertedFrame inverted{std::vector<double>(taxels), std::vector<double>(taxels),
                         Eigen::MatrixXd(static_cast<Eigen::Index>(taxels), inversion.slope_count())};
  if (invert_into(inversion, frame, rubber, inverted)) return inverted;
  inversion.forget();
  return std::nullopt;
}

Result<InvertedFrames> invert_frames(const ArrayDescription& array, const std::vector<const CircuitFrame*>& frames) {
  const LineParameters known(array);
  const auto create = [&] { return SlopedInversion::create(known, Eigen::VectorXd(0), Slopes::none); };
  if (auto trial = create(); !trial) return trial.error();
  InvertedFrames inverted(frames.size());
  parallel_for((frames.size() + kKnownFramesPerTask - 1) / kKnownFramesPerTask, [&](std::size_t task) {
    auto inversion = create();
    const std::size_t end = std::min(frames.size(), (task + 1) * kKnownFramesPerTask);
    for (std::size_t k = task * kKnownFramesPerTask; k < end; ++k) {
      inverted[k] = invert_frame(*inversion, *frames[k], {});
    }
  });
  return inverted;
}

}  // namespace dermis::learn::calibration
