// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/report/tactile_image.hpp"

#include <algorithm>
#include <cassert>
#include <string>
#include <utility>

#include "dermis/out/report/heat_map.hpp"

namespace dermis::out::report {
namespace {

HeatMap base_map(const ArrayDescription& array, std::string title, std::vector<double> values) {
  const double high = heat_map_high(values);
  return {std::move(title), array.rows, array.cols, array.row_pitch_m, array.col_pitch_m, high, std::move(values)};
}

HeatMap percent_map(const ArrayDescription& array, std::string title, std::vector<double> shares) {
  for (double& share : shares) share *= 100.0;
  return base_map(array, std::move(title), std::move(shares));
}

/// Conductances are shown in the unit that gives numbers a person can read.
HeatMap conductance_map(const ArrayDescription& array, std::vector<double> siemens) {
  if (array.readout.circuit == Circuit::none) {
    return percent_map(array, "compensated: reading [% of full scale]", std::move(siemens));
  }
  const double high = heat_map_high(siemens);
  const auto [unit, factor] = high >= 1.0    ? std::pair{"S", 1.0}
                              : high >= 1e-3 ? std::pair{"mS", 1e3}
                                             : std::pair{"\u00b5S", 1e6};
  for (double& value : siemens) value *= factor;
  return base_map(array, "compensated: conductance [" + std::string(unit) + "]", std::move(siemens));
}

}  // namespace

std::vector<Drawing> tactile_panels(const ArrayDescription& array, const learn::calibration::TactileExample& example) {
  assert(example.reading.size() == array.taxel_count() && example.siemens.size() == array.taxel_count());
  assert(example.newtons.size() == array.taxel_count() && example.true_newtons.size() == array.taxel_count());
  HeatMap force = base_map(array, "dermis: force [N]", {example.newtons.begin(), example.newtons.end()});
  HeatMap truth = base_map(array, "truth: force [N]", example.true_newtons);
  force.high = truth.high = std::max(heat_map_high(force.values), heat_map_high(truth.values));
  return {heat_map(percent_map(array, "raw: reading [% of full scale]", example.reading)),
          heat_map(conductance_map(array, example.siemens)), heat_map(force), heat_map(truth)};
}

Drawing tactile_image(const ArrayDescription& array, const learn::calibration::TactileExample& example) {
  const std::vector<Drawing> panels = tactile_panels(array, example);
  return side_by_side(panels, panels.size());
}

}  // namespace dermis::out::report
