// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/wording.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <utility>

namespace dermis::out::report {
namespace {

constexpr const char* kNoForce = "no force";

std::string replaced(std::string text, std::string_view old, std::string_view by) {
  for (std::size_t at = text.find(old); at != std::string::npos; at = text.find(old, at + by.size())) {
    text.replace(at, old.size(), by);
  }
  return text;
}

}  // namespace

std::string two_digits(double value) {
  if (value == 0.0) return "0";
  if (value < 9.95e-5 || value >= 1e6) return fmt::format("{:.1e}", value);
  if (value >= 9.95) return fmt::format("{:.0f}", value);
  return fmt::format("{:.{}f}", value, 1 - static_cast<int>(std::floor(std::log10(value * (10.0 / 9.95)))));
}

std::string percent(double fraction) {
  const double value = 100.0 * fraction;
  return std::isfinite(value) ? two_digits(value) + " %" : kNoForce;
}

std::string fine_percent(double fraction) {
  const double value = 100.0 * fraction;
  if (!std::isfinite(value)) return kNoForce;
  if (value < 0.1) return fmt::format("{:.3g}\u00a0%", value);
  return fmt::format("{:.{}f}\u00a0%", value, value < 9.995 ? 2 : 1);
}

std::string three_digits(double value) {
  return std::isfinite(value) ? fmt::format("{:.3g}", value) : "-";
}

std::string newtons(double force) {
  return std::isfinite(force) ? two_digits(force) + " N" : kNoForce;
}

std::string grouped(std::size_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t place = digits.size(); place > 3; place -= 3) digits.insert(place - 3, ",");
  return digits;
}

std::string steps(double count) {
  constexpr double kMostSteps = 1e15;
  const bool is_count = count >= 0.0 && count < kMostSteps;
  return is_count ? counted(static_cast<std::size_t>(count), "step") : "- steps";
}

std::string counted(std::size_t count, const std::string& noun) {
  return grouped(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string estimator_words(std::string name) {
  return replaced(replaced(std::move(name), "_", " "), "lookup", "look-up");
}

}  // namespace dermis::out::report
