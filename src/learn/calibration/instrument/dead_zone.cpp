// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/instrument/dead_zone.hpp"

#include <fmt/core.h>

#include <cmath>
#include <map>
#include <vector>

#include "learn/calibration/instrument/press_law.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kRisen = 4.0;         // standard deviations
constexpr double kLeastPresses = 8.0;  // of a weight

struct Answers {
  double presses = 0.0;
  double silent = 0.0;
};

std::vector<double> idle_ratios(const CircuitFrames& frames) {
  std::vector<double> sum(frames.frames.front().ratio.size());
  std::vector<double> count(sum.size());
  for (const CircuitFrame& frame : frames.frames) {
    for (std::size_t taxel = 0; taxel < sum.size(); ++taxel) {
      if (frame.newtons[taxel] != 0.0F) continue;
      sum[taxel] += frame.ratio[taxel];
      count[taxel] += 1.0;
    }
  }
  for (std::size_t taxel = 0; taxel < sum.size(); ++taxel) sum[taxel] /= std::max(count[taxel], 1.0);
  return sum;
}

}  // namespace

std::optional<std::string> describe_dead_zone(const CircuitFrames& frames) {
  const std::vector<double> idle = idle_ratios(frames);
  std::map<double, Answers> by_weight;
  for (const Press& press : sort_presses(frames, frames.frames.size()).single) {
    const std::size_t taxel = press.taxels.front();
    Answers& answers = by_weight[press.newtons];
    answers.presses += 1.0;
    if (press.frame->ratio[taxel] < idle[taxel] + kRisen * press.frame->described_sigma) answers.silent += 1.0;
  }
  Answers lightest;
  double heaviest_silent = 0.0;
  for (const auto& [newtons, answers] : by_weight) {
    if (answers.presses < kLeastPresses) continue;
    if (2.0 * answers.silent < answers.presses) {
      if (lightest.presses == 0.0) return std::nullopt;
      return fmt::format(
          "below {:.2g} N the readings tell nothing: {:.0f} of {:.0f} presses with {:.2g} N or less leave them as they "
          "were; an ADC may read nothing below some voltage, rubber may not answer",
          newtons, lightest.silent, lightest.presses, heaviest_silent);
    }
    lightest.presses += answers.presses;
    lightest.silent += answers.silent;
    heaviest_silent = newtons;
  }
  return std::nullopt;
}

}  // namespace dermis::learn::calibration
