// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/labels/unit_check.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "dermis/touch/preprocessing/conditioner.hpp"
#include "learn/calibration/labels/frame_sums.hpp"
#include "learn/calibration/labels/labels.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kMostPascal = 2e6;    // what rubber bears, and what is pressed on a robot's skin
constexpr double kLeastPascal = 10.0;  // a dozen sheets of paper
constexpr double kPressedShare = 0.1;  // of the taxel that rises most
constexpr double kMeasurableSigmas = 20.0;

struct Unit {
  const char* name;
  double factor;  // of what loads.csv is in
};

constexpr Unit kForces[] = {{"grams", 9.80665e-3}, {"millinewtons", 1e-3}, {"kilonewtons", 1e3}};
constexpr Unit kPressures[] = {{"Pa", 1e-3}, {"MPa", 1e3}};

double area_of_taxel(const ArrayDescription& array) {
  return std::max(array.taxel_area_m2.value_or(0.0), array.row_pitch_m * array.col_pitch_m);
}

/// Taxels that rise with the load of a frame; those that it names where no reading shows it.
std::size_t risen_taxels(const ArrayDescription& array, const RawFrame& frame, const Load& load,
                         std::span<const double> unloaded) {
  touch::preprocessing::Conditioner conditioner(array);
  ConditionedFrame conditioned;
  conditioner.process(frame, conditioned);
  const std::size_t named = load.where.taxel_count();
  if (conditioner.rejection() != touch::preprocessing::Rejection::none) return named;
  std::vector<double> rises;
  for (std::size_t taxel = 0; taxel < unloaded.size(); ++taxel) {
    rises.push_back(conditioned.ratio[taxel] - unloaded[taxel]);
  }
  const double most = *std::max_element(rises.begin(), rises.end());
  if (most < kMeasurableSigmas * conditioned.sigma_ratio) return named;
  return static_cast<std::size_t>(
      std::count_if(rises.begin(), rises.end(), [&](double rise) { return rise > kPressedShare * most; }));
}

bool is_plausible(double pascal) {
  return pascal >= kLeastPascal && pascal <= kMostPascal;
}

/// "17 MPa"
std::string pressure_text(double pascal) {
  if (pascal >= 1e6) return fmt::format("{:.3g} MPa", 1e-6 * pascal);
  if (pascal >= 1e3) return fmt::format("{:.3g} kPa", 1e-3 * pascal);
  return fmt::format("{:.3g} Pa", pascal);
}

std::string question(const ArrayDescription& array, const Load& load, std::size_t taxels, double pascal,
                     double newtons) {
  const bool is_force = load.kind == LoadKind::force;
  std::vector<std::string> likely;
  for (const Unit& unit : is_force ? std::span<const Unit>(kForces) : std::span<const Unit>(kPressures)) {
    if (!is_plausible(unit.factor * pascal)) continue;
    likely.push_back(fmt::format("{} ({} then)", unit.name, pressure_text(unit.factor * pascal)));
  }
  if (is_force && is_plausible(1e3 * load.value)) {
    likely.push_back(fmt::format("kPa ({} then)", pressure_text(1e3 * load.value)));
  }
  std::string text = fmt::format("the load of frame {} presses {} with {:.3g} N, {} over the {} {} that {} it",
                                 load.frame, to_string(load.where, array), newtons, pressure_text(pascal), taxels,
                                 taxels == 1 ? "taxel" : "taxels", taxels == 1 ? "feels" : "feel");
  text += fmt::format(": is it in {}?", is_force ? "newtons" : "kPa");
  if (!likely.empty()) text += fmt::format(" It may be in {}", fmt::join(likely, " or "));
  return text;
}

}  // namespace

std::optional<std::string> remark_on_units(const ArrayDescription& array, std::span<const RawFrame> frames,
                                           std::span<const Load> loads) {
  const std::vector<std::optional<double>> newtons = newtons_of_frames(array, frames.size(), loads);
  const std::vector<double> unloaded = unloaded_levels(array, frames, newtons);
  const auto heaviest = [&](auto weight_of) {
    return std::max_element(loads.begin(), loads.end(),
                            [&](const Load& a, const Load& b) { return weight_of(a) < weight_of(b); });
  };
  const auto named_pascal = [&](const Load& load) {
    return total_newtons(load, array) / static_cast<double>(load.where.taxel_count());
  };
  const auto of_frame = [&](const Load& load) { return *newtons[load.frame]; };
  for (const auto load : {heaviest(named_pascal), heaviest(of_frame)}) {
    const double total = *newtons[load->frame];
    if (!(total > 0.0)) return std::nullopt;
    const std::size_t taxels = risen_taxels(array, frames[load->frame], *load, unloaded);
    const double pascal = total / (area_of_taxel(array) * static_cast<double>(taxels));
    if (!is_plausible(pascal)) return question(array, *load, taxels, pascal, total);
  }
  return std::nullopt;
}

}  // namespace dermis::learn::calibration
