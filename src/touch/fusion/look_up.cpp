// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/fusion/look_up.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace dermis::touch::fusion {
namespace {

double interpolate(std::span<const double> x, std::span<const double> y, double at) {
  if (std::isnan(at)) return at;
  if (at <= x.front()) return y.front();
  if (at >= x.back()) return y.back();
  const auto above = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin());
  const double share = (at - x[above - 1]) / (x[above] - x[above - 1]);
  return y[above - 1] + share * (y[above] - y[above - 1]);
}

}  // namespace

bool LookUpTables::is_consistent() const noexcept {
  const std::size_t taxels = taxel_count();
  if (knots < 2 || knot_signal.size() != taxels * knots || knot_newtons.size() != taxels * knots) return false;
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const auto first = static_cast<std::ptrdiff_t>(taxel * knots);
    const auto last = first + static_cast<std::ptrdiff_t>(knots);
    if (!std::is_sorted(knot_signal.begin() + first, knot_signal.begin() + last) ||
        !std::is_sorted(knot_newtons.begin() + first, knot_newtons.begin() + last)) {
      return false;
    }
  }
  const auto finite = [](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  };
  return std::isfinite(reference_celsius) && finite(knot_signal) && finite(knot_newtons) &&
         finite(temperature_coefficient);
}

void LookUpTables::estimate(std::span<const double> signal_values, std::optional<double> temperature_celsius,
                            std::span<float> newtons) const noexcept {
  assert(signal_values.size() == taxel_count() && newtons.size() == taxel_count());
  const double offset = temperature_celsius.value_or(reference_celsius) - reference_celsius;
  for (std::size_t taxel = 0; taxel < taxel_count(); ++taxel) {
    const double at = signal_values[taxel] * (1.0 + temperature_coefficient[taxel] * offset);
    const std::span<const double> x(&knot_signal[taxel * knots], knots);
    const std::span<const double> y(&knot_newtons[taxel * knots], knots);
    newtons[taxel] = static_cast<float>(interpolate(x, y, at));
  }
}

}  // namespace dermis::touch::fusion
