// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/calibration_plan.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "learn/calibration/guided/press_hold.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::array kDefaultWeightsN = {1.0, 2.0, 5.0, 10.0, 20.0};
constexpr double kDefaultTaxels = 16.0;
constexpr std::size_t kMostWeights = 16;
constexpr double kLeastWeightN = 0.01;
constexpr double kMostWeightN = 1000.0;
constexpr double kMostFrameValues = 24e6;         // kept frames x taxels: 96 MB
constexpr std::size_t kSamplesForOwnNetwork = 8;  // of a taxel

Status check_seconds(const char* field, Nanos time, double least, double most) {
  const double seconds = std::chrono::duration<double>(time).count();
  if (seconds >= least && seconds <= most) return Done{};
  return bad_input(fmt::format("{}: must be {:g} to {:g} s", field, least, most));
}

Status check_taxels(const std::vector<std::size_t>& taxels, const ArrayDescription& array) {
  if (taxels.empty()) return bad_input("taxels: there are none");
  std::vector<bool> seen(array.taxel_count());
  for (const std::size_t taxel : taxels) {
    if (taxel >= seen.size()) {
      return bad_input(fmt::format("taxels: {} is beyond the last one, {}", taxel, seen.size() - 1));
    }
    if (array.is_absent(taxel)) return bad_input("taxels: the sheet has no " + array.taxel_name(taxel));
    if (seen[taxel]) return bad_input("taxels: " + array.taxel_name(taxel) + " is there twice");
    seen[taxel] = true;
  }
  return Done{};
}

Status check_weights(const std::vector<double>& weights_n) {
  if (weights_n.empty() || weights_n.size() > kMostWeights) {
    return bad_input(fmt::format("weights_n: must be 1 to {} weights", kMostWeights));
  }
  for (const double weight_n : weights_n) {
    if (!(weight_n >= kLeastWeightN && weight_n <= kMostWeightN)) {
      return bad_input(fmt::format("weights_n: {:g} is not {:g} to {:g} N", weight_n, kLeastWeightN, kMostWeightN));
    }
    if (std::count(weights_n.begin(), weights_n.end(), weight_n) > 1) {
      return bad_input(fmt::format("weights_n: {:g} is there twice", weight_n));
    }
  }
  return Done{};
}

}  // namespace

std::size_t CalibrationPlan::frames_per_press() const noexcept {
  if (weights_n.size() >= kSamplesForOwnNetwork) return 1;
  return 2 * weights_n.size() >= kSamplesForOwnNetwork ? 2 : PressHold::kParts;
}

Status CalibrationPlan::validate(const ArrayDescription& array) const {
  if (Status checked = check_taxels(taxels, array); !checked) return checked;
  if (Status checked = check_weights(weights_n); !checked) return checked;
  const auto values = static_cast<double>(press_count() * frames_per_press() * array.taxel_count());
  if (press_count() > kMostGuidedPresses || values > kMostFrameValues) {
    return bad_input(fmt::format("taxels: {} presses are too many; press fewer taxels", press_count()));
  }
  if (Status checked = check_seconds("unloaded_time", unloaded_time, 0.2, 60.0); !checked) return checked;
  return check_seconds("hold_time", hold_time, 0.05, 30.0);
}

std::vector<std::size_t> taxels_with_stride(const ArrayDescription& array, std::size_t stride) {
  std::vector<std::size_t> taxels;
  const auto first = [&](std::size_t lines) { return (lines - 1) % stride / 2; };
  for (std::size_t row = first(array.rows); row < array.rows; row += stride) {
    for (std::size_t col = first(array.cols); col < array.cols; col += stride) taxels.push_back(array.index(row, col));
  }
  std::erase_if(taxels, [&](std::size_t taxel) { return array.is_absent(taxel); });
  return taxels;
}

CalibrationPlan default_plan(const ArrayDescription& array) {
  const double stride = std::round(std::sqrt(static_cast<double>(array.taxel_count()) / kDefaultTaxels));
  CalibrationPlan plan;
  plan.taxels = taxels_with_stride(array, static_cast<std::size_t>(std::max(1.0, stride)));
  plan.weights_n.assign(kDefaultWeightsN.begin(), kDefaultWeightsN.end());
  return plan;
}

}  // namespace dermis::learn::calibration
