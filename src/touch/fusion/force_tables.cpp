// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/fusion/force_tables.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <span>

namespace dermis::touch::fusion {
namespace {

constexpr float kLeastTemperatureFactor = 0.01F;  // a linear term ends before it turns the conductance round
constexpr float kFarEnough = 0.5F;  // of the heaviest force: noise of two knots does not make the exponent
constexpr float kLeastEndExponent = 0.3F;
constexpr float kMostEndExponent = 3.0F;
constexpr float kOnLine = 1e-5F;  // relative, in single precision

bool is_strictly_rising(std::span<const float> values) {
  const auto is_not_less = [](float a, float b) { return !(a < b); };
  return values.front() > 0.0F && std::isfinite(values.back()) &&
         std::adjacent_find(values.begin(), values.end(), is_not_less) == values.end();
}

}  // namespace

ForceTables::Value ForceTables::at(std::size_t table, float excess_siemens, float temperature_offset) const noexcept {
  assert(table < taxels.size() && !(excess_siemens <= 0.0F));  // NaN stays NaN
  const std::span<const float> x = std::span(siemens).subspan(table * knots, knots);
  const std::span<const float> y = std::span(newtons).subspan(table * knots, knots);
  const float factor = std::max(1.0F + per_celsius[table] * temperature_offset, kLeastTemperatureFactor);
  const float s = excess_siemens * factor;
  if (s > x.back()) {
    const float exponent = end_exponent(table);
    return {std::log(y.back()) + exponent * std::log(s / x.back()), exponent, exponent * per_celsius[table] / factor};
  }
  const auto above = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end() - 1, s) - x.begin());
  const float x_below = above == 0 ? 0.0F : x[above - 1];
  const float y_below = above == 0 ? 0.0F : y[above - 1];
  const float slope = (y[above] - y_below) / (x[above] - x_below);
  const float force = y_below + slope * (s - x_below);
  const float exponent = slope * s / force;
  return {std::log(force), exponent, exponent * per_celsius[table] / factor};
}

float ForceTables::end_exponent(std::size_t table) const noexcept {
  assert(table < taxels.size());
  if (knots == 1) return 1.0F;
  const std::span<const float> x = std::span(siemens).subspan(table * knots, knots);
  const std::span<const float> y = std::span(newtons).subspan(table * knots, knots);
  const float half = kFarEnough * y.back();
  auto from = static_cast<std::size_t>(std::lower_bound(y.begin(), y.end() - 1, half) - y.begin());
  if (from + 1 == knots || (from > 0 && half - y[from - 1] <= y[from] - half)) --from;
  return std::clamp(std::log(y.back() / y[from]) / std::log(x.back() / x[from]), kLeastEndExponent, kMostEndExponent);
}

float ForceTables::line_end_siemens(std::size_t table) const noexcept {
  assert(table < taxels.size());
  const std::span<const float> x = std::span(siemens).subspan(table * knots, knots);
  const std::span<const float> y = std::span(newtons).subspan(table * knots, knots);
  const float slope = y[0] / x[0];
  std::size_t last = 0;
  while (last + 1 < knots && std::abs(y[last + 1] - slope * x[last + 1]) <= kOnLine * y[last + 1]) ++last;
  return x[last];
}

bool ForceTables::is_consistent(std::size_t taxel_count) const noexcept {
  const std::size_t tables = taxels.size();
  if (tables > 0 && (knots == 0 || taxels.back() >= taxel_count)) return false;
  if (std::adjacent_find(taxels.begin(), taxels.end(), std::greater_equal<>()) != taxels.end()) return false;
  if (siemens.size() != tables * knots || newtons.size() != tables * knots || per_celsius.size() != tables) {
    return false;
  }
  for (std::size_t table = 0; table < tables; ++table) {
    if (!is_strictly_rising(std::span(siemens).subspan(table * knots, knots))) return false;
    if (!is_strictly_rising(std::span(newtons).subspan(table * knots, knots))) return false;
  }
  return std::all_of(per_celsius.begin(), per_celsius.end(), [](float value) { return std::isfinite(value); });
}

}  // namespace dermis::touch::fusion
