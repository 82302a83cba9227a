// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/uncertainty.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "learn/calibration/even_choice.hpp"
#include "learn/calibration/mean.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kOneSigmaShare = 0.682689;  // of a normal distribution within one standard deviation
constexpr double kOutlierRatio = 9.0;        // of mean squares: three standard deviations
constexpr std::size_t kLeastUnloadedSamples = 5;
constexpr double kMostShareAtEnd = 0.1;  // cuts 8 % off the standard deviation
constexpr double kMostShareCut = 0.8;    // at the lower end, of the readings of a taxel that still counts
constexpr double kLeastCutNoise = 2.0;   // counts; rounding hides less
constexpr std::size_t kLeastTemperatures = 20;
constexpr double kMostTemperatureNoise = 1.0;

/// Leaves out what is far above the median.
void erase_outliers(std::vector<double>& mean_squares) {
  const double most = kOutlierRatio * quantile(mean_squares, 0.5);
  std::erase_if(mean_squares, [&](double square) { return square > most; });
}

std::vector<const Sample*> unloaded_samples(const SampleDatabase& database) {
  std::vector<const Sample*> samples;
  for (const Sample& sample : database.samples) {
    if (sample.unloaded) samples.push_back(&sample);
  }
  return samples;
}

/// Taxels that hardly any unloaded sample shows at an end of the ADC.
std::vector<std::size_t> free_taxels(const SampleDatabase& database, const std::vector<const Sample*>& unloaded) {
  const double half_count = 0.5 / database.array.readout.full_scale_counts();
  std::vector<std::size_t> taxels;
  for (std::size_t taxel = 0; taxel < database.array.taxel_count(); ++taxel) {
    const auto at_end = std::count_if(unloaded.begin(), unloaded.end(), [&](const Sample* sample) {
      const double reading = bare_reading(database, *sample, taxel);
      return reading < half_count || reading > 1.0 - half_count;
    });
    const double share = static_cast<double>(at_end) / static_cast<double>(unloaded.size());
    if (share <= kMostShareAtEnd) taxels.push_back(taxel);
  }
  return taxels;
}

/// Variance of a normal distribution [counts^2] of which readings below half a count show as 0: Tobin 1958, by the EM
/// algorithm.
double variance_of_cut(const std::vector<double>& counts) {
  constexpr double kCut = 0.5;
  constexpr int kSteps = 100;
  double middle = mean_of(counts);
  double variance = 1.0;
  for (const double count : counts) variance = std::max(variance, std::pow(count - middle, 2));
  for (int step = 0; step < kSteps; ++step) {
    const double sigma = std::sqrt(variance);
    const double cut = (kCut - middle) / sigma;
    const double below = std::max(0.5 * std::erfc(-cut / std::numbers::sqrt2), 1e-12);
    const double ratio = std::exp(-0.5 * cut * cut) / std::sqrt(2.0 * std::numbers::pi) / below;
    const double hidden = middle - sigma * ratio;  // mean of the readings below
    const double hidden_square = hidden * hidden + variance * (1.0 - cut * ratio - ratio * ratio);
    double sum = 0.0;
    double square = 0.0;
    for (const double count : counts) {
      sum += count < kCut ? hidden : count;
      square += count < kCut ? hidden_square : count * count;
    }
    middle = sum / static_cast<double>(counts.size());
    variance = std::max(square / static_cast<double>(counts.size()) - middle * middle, 1.0 / 12.0);
  }
  return variance;
}

/// Where the lower end of the ADC cuts the readings of most taxels.
std::optional<double> noise_of_cut(const SampleDatabase& database, const std::vector<const Sample*>& unloaded) {
  const double full_scale = database.array.readout.full_scale_counts();
  std::vector<double> of_taxel;
  for (std::size_t taxel = 0; taxel < database.array.taxel_count(); ++taxel) {
    std::vector<double> counts;
    for (const Sample* sample : unloaded) counts.push_back(full_scale * bare_reading(database, *sample, taxel));
    const auto cut = std::count_if(counts.begin(), counts.end(), [](double count) { return count < 0.5; });
    if (static_cast<double>(cut) > kMostShareCut * static_cast<double>(counts.size())) continue;
    of_taxel.push_back(variance_of_cut(counts));
  }
  if (of_taxel.empty()) return std::nullopt;
  erase_outliers(of_taxel);
  const double noise = std::sqrt(mean_of(of_taxel));
  return noise >= kLeastCutNoise ? std::optional(noise) : std::nullopt;
}

/// Half the square of the difference of two readings [counts^2]: on average the variance of one.
double half_square_difference(const SampleDatabase& database, const Sample& a, const Sample& b, std::size_t taxel) {
  const double sigma = std::hypot(a.sigma_ratio, b.sigma_ratio);
  const double difference =
      (double{a.ratio[taxel]} - double{b.ratio[taxel]}) / sigma * database.array.readout.adc_noise_counts;
  return difference * difference;
}

}  // namespace

std::optional<double> measure_adc_noise(const SampleDatabase& database) {
  const std::vector<const Sample*> unloaded = unloaded_samples(database);
  if (unloaded.size() < kLeastUnloadedSamples) return std::nullopt;
  const std::vector<std::size_t> taxels = free_taxels(database, unloaded);
  if (2 * taxels.size() < database.array.taxel_count()) return noise_of_cut(database, unloaded);
  std::vector<double> of_pair(unloaded.size() - 1);
  for (std::size_t k = 0; k < of_pair.size(); ++k) {
    for (const std::size_t taxel : taxels) {
      of_pair[k] += half_square_difference(database, *unloaded[k], *unloaded[k + 1], taxel);
    }
  }
  const double most = kOutlierRatio * quantile(of_pair, 0.5);  // beyond: something touched the array
  std::vector<double> of_taxel;
  for (const std::size_t taxel : taxels) {
    std::vector<double> squares;
    for (std::size_t k = 0; k < of_pair.size(); ++k) {
      if (of_pair[k] > most) continue;
      squares.push_back(half_square_difference(database, *unloaded[k], *unloaded[k + 1], taxel));
    }
    of_taxel.push_back(mean_of(squares));
  }
  erase_outliers(of_taxel);
  return std::sqrt(std::max(mean_of(of_taxel), 1.0 / 12.0));
}

namespace {

double temperature_noise(const std::vector<double>& celsius) {
  if (celsius.size() < kLeastTemperatures) return 0.0;
  std::vector<double> differences;
  for (std::size_t k = 1; k + 1 < celsius.size(); ++k) {
    differences.push_back(std::abs(celsius[k - 1] - 2.0 * celsius[k] + celsius[k + 1]));
  }
  const double sigma = quantile(std::move(differences), kOneSigmaShare) / std::sqrt(6.0);  // 1 + 4 + 1 variances
  return sigma <= kMostTemperatureNoise ? sigma : 0.0;
}

}  // namespace

double measure_temperature_noise(const SampleDatabase& database) {
  constexpr std::size_t kMostTaxels = 16;
  const bool is_map = !database.samples.empty() && !database.samples.front().taxel_celsius.empty();
  double squares = 0.0;
  const std::vector<std::size_t> taxels = even_choice(is_map ? database.array.taxel_count() : 1, kMostTaxels);
  for (const std::size_t taxel : taxels) {
    std::vector<double> celsius;
    for (const Sample& sample : database.samples) {
      if (!sample.taxel_celsius.empty()) {
        celsius.push_back(static_cast<double>(sample.taxel_celsius[taxel]));
      } else if (sample.temperature_celsius) {
        celsius.push_back(*sample.temperature_celsius);
      }
    }
    squares += std::pow(temperature_noise(celsius), 2) / static_cast<double>(taxels.size());
  }
  return std::sqrt(squares);
}

}  // namespace dermis::learn::calibration
