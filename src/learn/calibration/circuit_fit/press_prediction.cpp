// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/press_prediction.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::calibration {
namespace {

/// At the middle of the temperatures, over the reference.
double conductance(const Rubber& rubber, std::size_t taxel, double newtons) {
  const TaxelLaw& law = rubber.laws[taxel];
  const double unloaded = law.unloaded.size() > 0 ? std::max(0.0, law.unloaded[0]) : 0.0;
  if (newtons == 0.0) return unloaded;
  const double log_force = rubber.force_scale.log_force(newtons);
  const double open = law.pressed.dot(pressed_basis(log_force, 0.0)) +
                      rubber.sheet.tail(kCommonTerms).dot(common_basis(log_force, 0.0, 0.0));
  // The series resistance that all taxels share: ln g = open - r g.
  double excess = std::exp(open);
  const double series = rubber.sheet[kSheetTerms - 1];
  constexpr int kSteps = 20;
  for (int k = 0; k < kSteps; ++k) excess = std::sqrt(excess * std::exp(open - series * excess));
  return unloaded + excess;
}

}  // namespace

std::vector<double> siemens_under(const Rubber& rubber, const PressPair& pair) {
  std::vector<double> siemens(rubber.laws.size());
  for (std::size_t taxel = 0; taxel < siemens.size(); ++taxel) {
    const bool is_pressed = taxel == pair.first || taxel == pair.second;
    siemens[taxel] = rubber.reference_siemens * conductance(rubber, taxel, is_pressed ? pair.newtons : 0.0);
  }
  return siemens;
}

std::vector<double> heaviest_loads(const Rubber& rubber, const CircuitFrames& frames) {
  std::vector<double> heaviest(rubber.laws.size());
  for (const CircuitFrame& frame : frames.frames) {
    for (std::size_t taxel = 0; taxel < heaviest.size(); ++taxel) {
      if (rubber.laws[taxel].pressed.size() == 0) continue;
      heaviest[taxel] = std::fmax(heaviest[taxel], static_cast<double>(frame.newtons[taxel]));
    }
  }
  return heaviest;
}

bool are_apart(std::size_t cols, std::size_t a, std::size_t b) {
  const auto between = [](std::size_t x, std::size_t y) { return x > y ? x - y : y - x; };
  return std::max(between(a / cols, b / cols), between(a % cols, b % cols)) > 1;
}

double noise_of_presses(const CircuitFrames& frames) {
  std::vector<double> sigmas;
  for (const CircuitFrame& frame : frames.frames) {
    const bool is_pressed =
        std::any_of(frame.newtons.begin(), frame.newtons.end(), [](float newtons) { return newtons > 0.0F; });
    if (is_pressed) sigmas.push_back(frame.sigma_ratio);
  }
  return upper_median(std::move(sigmas));
}

}  // namespace dermis::learn::calibration
