// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "dermis/paper/bank_training.hpp"

namespace dermis::paper {
namespace {

using learn::calibration::Sample;

constexpr double kNoTemperature = std::numeric_limits<double>::quiet_NaN();

/// All that the training of the bank knows of samples.
struct FlatSamples {
  std::vector<double> celsius;  ///< [samples]
  std::vector<float> ratio;     ///< [samples, taxels]
  std::vector<float> newtons;   ///< [samples, taxels]
};

FlatSamples flat(const std::vector<Sample>& samples) {
  FlatSamples all;
  for (const Sample& sample : samples) {
    all.celsius.push_back(sample.temperature_celsius.value_or(kNoTemperature));
    all.ratio.insert(all.ratio.end(), sample.ratio.begin(), sample.ratio.end());
    all.newtons.insert(all.newtons.end(), sample.known_newtons.begin(), sample.known_newtons.end());
  }
  return all;
}

std::vector<Sample> samples_of(const FlatSamples& all, std::size_t taxels) {
  std::vector<Sample> samples(all.celsius.size());
  for (std::size_t p = 0; p < samples.size(); ++p) {
    if (!std::isnan(all.celsius[p])) samples[p].temperature_celsius = all.celsius[p];
    const auto row = [&](const std::vector<float>& values) { return std::span(values).subspan(p * taxels, taxels); };
    samples[p].ratio.assign(row(all.ratio).begin(), row(all.ratio).end());
    samples[p].known_newtons.assign(row(all.newtons).begin(), row(all.newtons).end());
  }
  return samples;
}

}  // namespace

void broadcast_samples(learn::calibration::SampleDatabase& database, Ranks& ranks) {
  if (ranks.count() == 1) return;
  FlatSamples all = flat(database.samples);
  broadcast_value(ranks, database.array.rows);
  broadcast_value(ranks, database.array.cols);
  broadcast_list(ranks, all.celsius);
  broadcast_list(ranks, all.ratio);
  broadcast_list(ranks, all.newtons);
  database.samples = samples_of(all, database.array.taxel_count());
}

}  // namespace dermis::paper
