// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/rubber.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dermis::learn::calibration {
namespace {

using Eigen::VectorXd;

constexpr double kLeastIdleSigmas = 1.0;  // an idle reading below this is cut at 0 too often

/// The taxels whose idle readings are well above 0 on average, whatever the circuit and the temperature.
std::vector<bool> readable_taxels(const CircuitFrames& frames, std::size_t taxels) {
  std::vector<double> sums(taxels);
  std::vector<double> counts(taxels);
  for (const CircuitFrame& frame : frames.frames) {
    for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
      if (frame.newtons[taxel] != 0.0F) continue;
      sums[taxel] += frame.ratio[taxel] / frame.described_sigma;
      counts[taxel] += 1.0;
    }
  }
  std::vector<bool> readable(taxels);
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    readable[taxel] = counts[taxel] > 0.0 && sums[taxel] >= kLeastIdleSigmas * counts[taxel];
  }
  return readable;
}

ForceScale force_scale(const CircuitFrames& frames) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const CircuitFrame& frame : frames.frames) {
    for (const float newtons : frame.newtons) {
      if (!(newtons > 0.0F)) continue;
      lowest = std::min(lowest, std::log(static_cast<double>(newtons)));
      highest = std::max(highest, std::log(static_cast<double>(newtons)));
    }
  }
  if (!(highest > lowest)) return {std::isfinite(lowest) ? lowest : 0.0, 1.0};
  return {0.5 * (lowest + highest), 0.5 * (highest - lowest)};
}

}  // namespace

double ForceScale::log_force(double newtons) const {
  return (std::log(newtons) - centre) / half_span;
}

Rubber unknown_rubber(const CircuitFrames& frames, std::size_t taxels, double reference_siemens) {
  Rubber rubber;
  rubber.reference_siemens = reference_siemens;
  rubber.force_scale = force_scale(frames);
  rubber.unloaded_terms = frames.has_temperature ? 3 : 1;
  const std::vector<bool> readable = readable_taxels(frames, taxels);
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) rubber.laws.push_back({{}, {}, readable[taxel]});
  return rubber;
}

VectorXd unloaded_basis(const Rubber& rubber, double temperature) {
  if (rubber.unloaded_terms == 1) return VectorXd::Ones(1);
  return Eigen::Vector3d(1.0, temperature, temperature * temperature);
}

VectorXd pressed_basis(double x, double t) {
  VectorXd basis(kPressedTerms);
  basis << 1.0, x, t, x * x, x * x * x, t * t, t * x;
  return basis;
}

VectorXd common_basis(double x, double t, double excess) {
  VectorXd basis(kCommonTerms);
  basis << std::pow(x, 4), std::pow(x, 5), std::pow(x, 6), t * x * x, t * x * x * x, t * t * x, -excess;
  return basis;
}

}  // namespace dermis::learn::calibration
