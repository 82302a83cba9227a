// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/series.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr double kMost = 0.9;  // of the steps are as expected: lines and packets may be missing
constexpr std::size_t kManySteps = 8;
constexpr std::size_t kFewestAbove = 16;  // packets
constexpr std::size_t kMostLines = 1024;
constexpr std::size_t kMostInTurn = 64;

bool is_whole(const Series& series) {
  return std::all_of(series.begin(), series.end(),
                     [](double value) { return value >= 0.0 && value < 9e15 && value == std::floor(value); });
}

/// From each number to the next other one.
Series steps_of(const Series& series, double modulus) {
  Series steps;
  for (std::size_t i = 1; i < series.size(); ++i) {
    double step = series[i] - series[i - 1];
    if (step < 0.0 && modulus > 0.0) step += modulus;
    if (step != 0.0) steps.push_back(step);
  }
  return steps;
}

template <typename Test>
bool are_most(const Series& steps, Test test) {
  const auto count = std::count_if(steps.begin(), steps.end(), test);
  return static_cast<double>(count) >= kMost * static_cast<double>(steps.size());
}

/// Each number stays for as many lines or packets as the others.
bool stays_evenly(const Series& series) {
  Series stays;  // but the first and the last, which may be cut
  std::size_t from = 0;
  for (std::size_t i = 1; i < series.size(); ++i) {
    if (series[i] == series[i - 1]) continue;
    if (from > 0) stays.push_back(static_cast<double>(i - from));
    from = i;
  }
  return !stays.empty() && are_most(stays, [&](double stay) { return stay == stays[stays.size() / 2]; });
}

/// Steps of one size, or of several that were lost.
bool are_even(const Series& steps) {
  const double least = *std::min_element(steps.begin(), steps.end());
  const auto is_even = [&](double step) { return step == least || (least > 1.0 && std::fmod(step, least) == 0.0); };
  return std::all_of(steps.begin(), steps.end(), is_even) &&
         are_most(steps, [&](double step) { return step == least; });
}

/// Its high bytes count evenly, and what stands below them does not go on with them: it is something else.
bool counts_above_others(const Series& series, const Series& steps, double modulus) {
  if (series.size() < kFewestAbove || steps.empty() || are_even(steps)) return false;
  for (double unit = 256.0; unit < modulus; unit *= 256.0) {
    Series high;
    for (const double value : series) high.push_back(std::floor(value / unit));
    const Series high_steps = steps_of(high, modulus / unit);
    if (high_steps.size() + 1 == series.size() && are_even(high_steps)) return true;
  }
  return false;
}

}  // namespace

std::optional<Cycle> cycle_of(const Series& series) {
  if (series.size() < 4 || !is_whole(series)) return std::nullopt;
  const auto [least, most] = std::minmax_element(series.begin(), series.end());
  const double span = *most - *least;
  if (span < 1.0 || span >= static_cast<double>(kMostLines)) return std::nullopt;
  const Series steps = steps_of(series, 0.0);
  for (const double direction : {1.0, -1.0}) {
    const auto wraps = std::count(steps.begin(), steps.end(), -direction * span);
    const bool is_cycle = are_most(steps, [&](double step) { return step == direction || step == -direction * span; });
    if (is_cycle && wraps >= 1 && steps.size() >= 3 && stays_evenly(series)) {
      return Cycle{static_cast<std::uint64_t>(*least), static_cast<std::size_t>(span) + 1};
    }
  }
  return std::nullopt;
}

bool is_frame_number(const Series& series, double modulus) {
  if (!is_whole(series)) return false;
  if (const auto cycle = cycle_of(series); cycle && static_cast<double>(cycle->count) != modulus) return false;
  const Series steps = steps_of(series, modulus);
  const bool counts = steps.size() >= 2 && are_most(steps, [](double step) { return step == 1.0; });
  return counts && stays_evenly(series);
}

bool is_time(const Series& series, double modulus) {
  const Series steps = steps_of(series, modulus);
  if (counts_above_others(series, steps, modulus)) return false;
  if (steps.size() < 3 || *std::min_element(series.begin(), series.end()) < 0.0) return false;
  const bool never_falls =
      modulus == 0.0 && steps.size() >= kManySteps && *std::min_element(steps.begin(), steps.end()) > 0.0;
  if (never_falls) return true;
  const double usual = upper_median(steps);
  if (modulus > 0.0 && usual > modulus / 16.0) return false;  // as of any bytes
  return usual > 0.0 && are_most(steps, [&](double step) { return step > 0.0 && step < 4.0 * usual; });
}

bool is_even_clock(const Series& series, double modulus) {
  const Series steps = steps_of(series, modulus);
  if (steps.size() + 1 != series.size() || !is_time(series, modulus)) return false;
  const double usual = upper_median(steps);
  return usual > 1.0 &&
         std::all_of(steps.begin(), steps.end(), [&](double step) { return step > 0.5 * usual && step < 2.0 * usual; });
}

std::string time_field_of(const Series& series, double modulus) {
  const double value = series.back();
  if (value > 1e17) return "time_ns";  // since 1970
  if (value > 1e14) return "time_us";
  if (value > 1e11) return "time_ms";
  const double step = upper_median(steps_of(series, modulus));
  const bool has_fractions =
      std::any_of(series.begin(), series.end(), [](double one) { return one != std::floor(one); });
  if (has_fractions && step < 1.0) return "time_s";
  if (step >= 1e6) return "time_ns";
  return step >= 1000.0 ? "time_us" : "time_ms";
}

std::vector<std::uint64_t> numbers_in_turn(const Series& series) {
  if (series.size() < 4 || !is_whole(series)) return {};
  const std::set<double> different(series.begin(), series.end());
  const std::size_t count = different.size();
  if (count < 2 || count > kMostInTurn || series.size() < 2 * count) return {};
  std::size_t again = 0;
  for (std::size_t i = count; i < series.size(); ++i) {
    again += series[i] == series[i - count] && series[i] != series[i - 1] ? 1 : 0;
  }
  if (static_cast<double>(again) < kMost * static_cast<double>(series.size() - count)) return {};
  return {different.begin(), different.end()};
}

}  // namespace dermis::bytes::proposals
