// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/evaluation/breakdown.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "learn/calibration/evaluation/coverage.hpp"
#include "learn/calibration/evaluation/error_summary.hpp"

namespace dermis::learn::calibration {
namespace {

/// Bins of the judged taxels (of the totals, where no taxel is judged) by `quantity`, a function of either that gives
/// an optional<double>. Bins without anything in them are left out.
template <typename Quantity>
std::vector<BreakdownBin> bins_of(const Evaluation& evaluation, const std::vector<double>& edges, Quantity quantity) {
  std::vector<BreakdownBin> bins;
  for (std::size_t b = 0; b + 1 < edges.size(); ++b) {
    BreakdownBin bin{edges[b], edges[b + 1], {}, {}};
    std::vector<JudgedTaxel> taxels;
    std::vector<std::vector<double>> errors(evaluation.estimators.size());
    const auto gather = [&](const auto& judged) {
      const std::optional<double> value = quantity(judged);
      if (!value || *value < bin.low || *value >= bin.high) return;
      for (std::size_t k = 0; k < errors.size(); ++k) {
        errors[k].push_back(relative_error(static_cast<double>(judged.newtons[k]), judged.true_newtons));
      }
      if constexpr (std::is_same_v<std::decay_t<decltype(judged)>, JudgedTaxel>) taxels.push_back(judged);
    };
    if (evaluation.taxels.empty()) {
      std::for_each(evaluation.totals.begin(), evaluation.totals.end(), gather);
    } else {
      std::for_each(evaluation.taxels.begin(), evaluation.taxels.end(), gather);
    }
    if (errors.empty() || errors.front().empty()) continue;
    for (std::vector<double>& of_estimator : errors) bin.relative_error.push_back(summarise(std::move(of_estimator)));
    bin.coverage = coverage_of(taxels);
    bins.push_back(std::move(bin));
  }
  return bins;
}

/// `count` equal bins over the values that the judged taxels take.
std::vector<double> equal_edges(const std::vector<JudgedTaxel>& taxels, std::size_t count,
                                std::optional<double> JudgedTaxel::*quantity) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const JudgedTaxel& taxel : taxels) {
    if (!(taxel.*quantity)) continue;
    lowest = std::min(lowest, *(taxel.*quantity));
    highest = std::max(highest, *(taxel.*quantity));
  }
  if (!(lowest < highest)) return lowest == highest ? std::vector<double>{lowest, lowest + 1.0} : std::vector<double>{};
  std::vector<double> edges;
  const double width = (highest - lowest) / static_cast<double>(count);
  for (std::size_t b = 0; b <= count; ++b) edges.push_back(lowest + width * static_cast<double>(b));
  edges.back() = std::nextafter(highest, std::numeric_limits<double>::infinity());
  return edges;
}

/// One bin for every number of contacts.
std::vector<double> contact_edges(const std::vector<JudgedTaxel>& taxels) {
  std::size_t most = 0;
  for (const JudgedTaxel& taxel : taxels) most = std::max(most, taxel.contacts);
  std::vector<double> edges;
  for (std::size_t contacts = 1; contacts <= most + 1; ++contacts) edges.push_back(static_cast<double>(contacts));
  return edges;
}

}  // namespace

void break_down(Evaluation& evaluation) {
  const auto force = [](const auto& judged) { return std::optional<double>(judged.true_newtons); };
  const auto temperature = [](const auto& judged) { return judged.temperature_celsius; };
  evaluation.by_force = bins_of(evaluation, {0, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 1e6}, force);
  evaluation.by_temperature =
      bins_of(evaluation, {-273, -20, -10, 0, 10, 20, 30, 40, 50, 60, 70, 85, 100, 1000}, temperature);
  evaluation.by_onset = bins_of(evaluation, {0, 0.3, 1, 3, 10, 30, 100, 1e6},
                                [](const auto& judged) { return judged.touch.seconds_since_onset; });
  evaluation.by_direction = bins_of(evaluation, {0, 1, 2}, [](const auto& judged) -> std::optional<double> {
    if (!judged.touch.is_unloading) return std::nullopt;
    return *judged.touch.is_unloading ? 1.0 : 0.0;
  });
  if (evaluation.taxels.empty()) return;
  const auto of_taxel = [&](auto quantity, const std::vector<double>& edges) {
    return bins_of(evaluation, edges, [&](const auto& judged) -> std::optional<double> {
      if constexpr (requires { judged.taxel; }) return quantity(judged);
      return std::nullopt;
    });
  };
  evaluation.by_supply = of_taxel([](const JudgedTaxel& taxel) { return taxel.supply_v; },
                                  equal_edges(evaluation.taxels, 5, &JudgedTaxel::supply_v));
  evaluation.by_contacts = of_taxel([](const JudgedTaxel& taxel) { return static_cast<double>(taxel.contacts); },
                                    contact_edges(evaluation.taxels));
}

}  // namespace dermis::learn::calibration
