// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "report/wording.hpp"

#include <fmt/format.h>

#include <cmath>

namespace dermis::report {
namespace {

constexpr const char* kNoForce = "no force";

}  // namespace

std::string two_digits(double value) {
  if (value == 0.0) return "0";
  if (value < 9.95e-5 || value >= 1e6) return fmt::format("{:.1e}", value);
  if (value >= 9.95) return fmt::format("{:.0f}", value);
  return fmt::format("{:.{}f}", value, 1 - static_cast<int>(std::floor(std::log10(value * (10.0 / 9.95)))));
}

std::string percent(double fraction) {
  return std::isfinite(fraction) ? two_digits(100.0 * fraction) + " %" : kNoForce;
}

std::string newtons(double force) {
  return std::isfinite(force) ? two_digits(force) + " N" : kNoForce;
}

std::string grouped(std::size_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t place = digits.size(); place > 3; place -= 3) digits.insert(place - 3, ",");
  return digits;
}

std::string counted(std::size_t count, const std::string& noun) {
  return grouped(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace dermis::report
