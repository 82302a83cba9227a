// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/force_text.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>

#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::files {
namespace {

constexpr double kGravity = 9.80665;  // standard [m/s2]

struct Unit {
  std::string_view name;
  double factor;
};
constexpr std::array kForces = {Unit{"N", 1.0}, Unit{"mN", 1e-3}, Unit{"kN", 1e3}, Unit{"g", 1e-3 * kGravity},
                                Unit{"kg", kGravity}};
constexpr std::array kPressures = {Unit{"kPa", 1e3}, Unit{"MPa", 1e6}, Unit{"Pa", 1.0}};

/// A number alone is in `usual`.
std::optional<double> parse(std::string_view text, std::span<const Unit> units, std::string_view usual) {
  const std::string_view whole = trimmed(text);
  double value = 0.0;
  for (const Unit& unit : units) {
    if (unit.name == usual && parse_number(whole, value)) return value * unit.factor;
    if (!whole.ends_with(unit.name)) continue;
    if (parse_number(trimmed(whole.substr(0, whole.size() - unit.name.size())), value)) return value * unit.factor;
  }
  return std::nullopt;
}

}  // namespace

Result<double> parse_force(std::string_view text, std::string_view usual) {
  if (const std::optional<double> newtons = parse(text, kForces, usual)) return *newtons;
  if (parse(text, kPressures, "")) return bad_input(in_quotes(text) + " is a pressure; write a force, as 2 N or 200 g");
  return bad_input(in_quotes(text) + " is no force; write newtons, or a unit as in 2 N, 200 g or 0.2 kg");
}

Result<double> parse_pressure(std::string_view text) {
  if (const std::optional<double> pascal = parse(text, kPressures, "kPa")) return *pascal;
  return bad_input(in_quotes(text) + " is no pressure; write kPa, or a unit as in 20 kPa, 500 Pa or 0.1 MPa");
}

bool is_force_unit(std::string_view name) {
  return std::any_of(kForces.begin(), kForces.end(), [&](const Unit& unit) { return unit.name == name; });
}

}  // namespace dermis::bytes::files
