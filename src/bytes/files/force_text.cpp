// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/force_text.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::files {
namespace {

constexpr double kGravity = 9.80665;  // standard [m/s2]

struct Unit {
  std::string_view name;
  double newtons;
};
constexpr std::array kUnits = {
    Unit{"", 1.0}, Unit{"N", 1.0}, Unit{"mN", 1e-3}, Unit{"kN", 1e3}, Unit{"g", 1e-3 * kGravity}, Unit{"kg", kGravity}};

}  // namespace

Result<double> parse_force(std::string_view text) {
  const std::string_view whole = trimmed(text);
  for (const Unit& unit : kUnits) {
    double value = 0.0;
    if (!whole.ends_with(unit.name)) continue;
    if (parse_number(trimmed(whole.substr(0, whole.size() - unit.name.size())), value)) return value * unit.newtons;
  }
  return bad_input(in_quotes(text) + " is no force; write newtons, or a unit as in 2 N, 200 g or 0.2 kg");
}

}  // namespace dermis::bytes::files
