// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "dermis/out/report/plot.hpp"
#include "dermis/out/report/wording.hpp"
#include "out/report/figures.hpp"

namespace dermis::out::report {
namespace {

using learn::calibration::BreakdownBin;
using learn::calibration::ErrorSummary;
using learn::calibration::Evaluation;
using learn::calibration::JudgedTaxel;
using learn::calibration::JudgedTotal;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr double kShift = 5.0;  // Between the whiskers of two estimators in one bin [px].

/// How the errors of one breakdown are drawn.
struct Breakdown {
  std::string file;
  std::string title;
  std::string x_label;
  std::string nothing;  // The sentence where there are no bins.
  Scale scale;
  bool whole_numbers;  // Each bin is one number, its `low`.
  std::optional<double> (*of_taxel)(const JudgedTaxel&);
  std::optional<double> (*of_total)(const JudgedTotal&);
};

/// A bin as it is drawn.
struct Bin {
  double x;
  std::span<const ErrorSummary> errors;  // [estimators]
};

/// In percent; where the estimator gave no force, infinite, which stands on the upper edge of the plot.
double percent_of(const std::optional<double>& error) {
  if (!error) return kMissing;
  return std::isfinite(*error) ? 100.0 * *error : std::numeric_limits<double>::infinity();
}

/// The quantity of everything that was judged, as far as it is known.
std::vector<double> quantities(const Breakdown& breakdown, const Evaluation& evaluation) {
  std::vector<double> values;
  for (const JudgedTaxel& taxel : evaluation.taxels) values.push_back(breakdown.of_taxel(taxel).value_or(kMissing));
  if (!values.empty()) return values;
  for (const JudgedTotal& total : evaluation.totals) values.push_back(breakdown.of_total(total).value_or(kMissing));
  return values;
}

/// Mean of the values in the bin, on the scale of the axis. A bin from 5 to 6 V may hold nothing but 5.0 V.
double place_of(const Breakdown& breakdown, const BreakdownBin& bin, std::span<const double> values) {
  if (breakdown.whole_numbers) return bin.low;
  const bool is_logarithmic = breakdown.scale == Scale::logarithmic;
  double sum = 0.0;
  std::size_t count = 0;
  for (const double value : values) {
    if (!(value >= bin.low && value < bin.high)) continue;
    sum += is_logarithmic ? std::log(value) : value;
    ++count;
  }
  const double mean = sum / static_cast<double>(count);
  return is_logarithmic ? std::exp(mean) : mean;
}

std::vector<Bin> drawable_bins(const Breakdown& breakdown, const Evaluation& evaluation,
                               const std::vector<BreakdownBin>& all_bins) {
  const std::vector<double> values = quantities(breakdown, evaluation);
  std::vector<Bin> bins;
  for (const BreakdownBin& bin : all_bins) {
    if (bin.relative_error.empty() || bin.relative_error.front().count == 0) continue;
    if (const double x = place_of(breakdown, bin, values); std::isfinite(x)) bins.push_back({x, bin.relative_error});
  }
  return bins;
}

/// Some room beyond the first and the last tick, so that no mark stands on the frame.
Axis padded(Axis axis) {
  constexpr double kShare = 0.04;
  if (axis.scale == Scale::logarithmic) {
    const double factor = std::pow(axis.high / axis.low, kShare);
    axis.low /= factor;
    axis.high *= factor;
  } else {
    const double room = kShare * (axis.high - axis.low);
    axis.low -= room;
    axis.high += room;
  }
  return axis;
}

Axis x_axis(const Breakdown& breakdown, const Evaluation& evaluation, std::span<const Bin> bins) {
  if (!breakdown.whole_numbers) {
    return padded(nice_axis(breakdown.x_label, breakdown.scale, quantities(breakdown, evaluation)));
  }
  Axis axis{breakdown.x_label, Scale::linear, bins.front().x - 0.5, bins.back().x + 0.5, {}};
  for (const Bin& bin : bins) axis.ticks.push_back(bin.x);
  return axis;
}

Axis y_axis(std::span<const Bin> bins) {
  std::vector<double> errors;
  for (const Bin& bin : bins) {
    for (const ErrorSummary& error : bin.errors) {
      errors.insert(errors.end(), {percent_of(error.median), percent_of(error.p95)});
    }
  }
  return nice_axis("relative error [%]", Scale::logarithmic, errors);
}

void draw_estimator(const Evaluation& evaluation, std::span<const Bin> bins, std::size_t estimator, Plot& plot) {
  std::vector<Point> medians;
  std::vector<Point> tails;
  for (const Bin& bin : bins) {
    medians.push_back({bin.x, percent_of(bin.errors[estimator].median)});
    tails.push_back({bin.x, percent_of(bin.errors[estimator].p95)});
  }
  const double middle = static_cast<double>(evaluation.estimators.size() - 1) / 2.0;
  const double shift = kShift * (static_cast<double>(estimator) - middle);
  plot.whiskers(estimator, medians, std::move(tails), shift);
  plot.curve(estimator_words(evaluation.estimators[estimator].name), estimator, std::move(medians));
}

bool has_missing_force(std::span<const Bin> bins) {
  return std::any_of(bins.begin(), bins.end(), [](const Bin& bin) {
    return std::any_of(bin.errors.begin(), bin.errors.end(), [](const ErrorSummary& error) {
      return std::isinf(percent_of(error.median)) || std::isinf(percent_of(error.p95));
    });
  });
}

/// The frame of the onset itself has no place on an axis of logarithms.
std::optional<double> above_zero(const std::optional<double>& seconds) {
  return seconds && *seconds > 0.0 ? seconds : std::nullopt;
}

Figure breakdown_figure(const Breakdown& breakdown, const Evaluation& evaluation,
                        const std::vector<BreakdownBin>& all_bins) {
  Figure figure{breakdown.file, breakdown.title, breakdown.nothing, {}, 1};
  const std::vector<Bin> bins = drawable_bins(breakdown, evaluation, all_bins);
  if (bins.empty() || evaluation.estimators.empty()) return figure;
  Plot plot(breakdown.title, x_axis(breakdown, evaluation, bins), y_axis(bins), 480.0, 350.0);
  for (const Bin& bin : bins) plot.count(bin.x, bin.errors.front().count);
  for (std::size_t i = 0; i < evaluation.estimators.size(); ++i) draw_estimator(evaluation, bins, i, plot);
  figure.panels.push_back(plot.drawing());
  figure.caption = fmt::format(
      "Marks: median of the relative error, at the mean of their bin; whiskers, side by side: up to the 95th "
      "percentile; n: judged {} in each bin.",
      evaluation.taxels.empty() ? "totals" : "taxels");
  if (has_missing_force(bins)) figure.caption += " What reaches the upper edge includes taxels without any force.";
  return figure;
}

Breakdown by_force() {
  return {"error_vs_force.svg",
          "Error against force",
          "true force [N]",
          "Nothing was judged, so there is no error against force.",
          Scale::logarithmic,
          false,
          [](const JudgedTaxel& taxel) { return std::optional(taxel.true_newtons); },
          [](const JudgedTotal& total) { return std::optional(total.true_newtons); }};
}

Breakdown by_temperature() {
  return {"error_vs_temperature.svg",
          "Error against temperature",
          "temperature [\u00b0C]",
          "No temperature is known for what was judged, so there is no error against temperature.",
          Scale::linear,
          false,
          [](const JudgedTaxel& taxel) { return taxel.temperature_celsius; },
          [](const JudgedTotal& total) { return total.temperature_celsius; }};
}

Breakdown by_supply() {
  return {"error_vs_supply.svg",
          "Error against supply",
          "supply [V]",
          "No supply voltage is known for what was judged, so there is no error against supply.",
          Scale::linear,
          false,
          [](const JudgedTaxel& taxel) { return taxel.supply_v; },
          [](const JudgedTotal&) { return std::optional<double>(); }};
}

Breakdown by_contacts() {
  return {"error_vs_contacts.svg",
          "Error against number of contacts",
          "contacts at the same time",
          "No single taxels were judged, so there is no error against the number of contacts.",
          Scale::linear,
          true,
          [](const JudgedTaxel& taxel) { return std::optional(static_cast<double>(taxel.contacts)); },
          [](const JudgedTotal&) { return std::optional<double>(); }};
}

Breakdown by_onset() {
  return {"error_vs_time.svg",
          "Error against time since the onset",
          "time since the load came [s]",
          "No load was seen coming, so there is no error against time.",
          Scale::logarithmic,
          false,
          [](const JudgedTaxel& taxel) { return above_zero(taxel.touch.seconds_since_onset); },
          [](const JudgedTotal& total) { return above_zero(total.touch.seconds_since_onset); }};
}

}  // namespace

std::vector<Figure> breakdown_figures(const Evaluation& evaluation) {
  return {breakdown_figure(by_force(), evaluation, evaluation.by_force),
          breakdown_figure(by_temperature(), evaluation, evaluation.by_temperature),
          breakdown_figure(by_supply(), evaluation, evaluation.by_supply),
          breakdown_figure(by_contacts(), evaluation, evaluation.by_contacts),
          breakdown_figure(by_onset(), evaluation, evaluation.by_onset)};
}

}  // namespace dermis::out::report
