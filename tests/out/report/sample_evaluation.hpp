// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/reference_array.hpp"

namespace dermis::out::report {

/// Relative errors as they are found on a 16 x 16 array: dermis, raw, with temperature, without crosstalk.
inline std::vector<float> sample_estimates(double truth, double temperature, std::size_t contacts, Random& random) {
  const double drift = 0.008 * (temperature - 25.0);
  const double crosstalk = 0.25 * static_cast<double>(contacts);
  const double noise = 0.004 + 0.01 / truth;
  const auto spread = [&](double scale) { return std::exp(scale * random.normal()); };
  return {static_cast<float>(truth * spread(noise)),
          static_cast<float>(truth * spread(0.3) * (1.0 - drift - crosstalk)),
          static_cast<float>(truth * spread(0.3) * (1.0 - crosstalk)),
          static_cast<float>(truth * spread(2.0 * noise) * (1.0 - drift))};
}

inline std::vector<learn::calibration::ErrorSummary> sample_summaries(const learn::calibration::Evaluation& evaluation,
                                                                      const std::function<bool(std::size_t)>& is_in) {
  std::vector<learn::calibration::ErrorSummary> summaries;
  for (std::size_t k = 0; k < evaluation.estimators.size(); ++k) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < evaluation.taxels.size(); ++i) {
      const auto& taxel = evaluation.taxels[i];
      if (is_in(i)) errors.push_back(std::abs(static_cast<double>(taxel.newtons[k]) / taxel.true_newtons - 1.0));
    }
    summaries.push_back(learn::calibration::summarise(std::move(errors)));
  }
  return summaries;
}

inline std::vector<learn::calibration::BreakdownBin> sample_bins(const learn::calibration::Evaluation& evaluation,
                                                                 const std::vector<double>& edges,
                                                                 const std::function<double(std::size_t)>& quantity) {
  std::vector<learn::calibration::BreakdownBin> bins;
  for (std::size_t b = 0; b + 1 < edges.size(); ++b) {
    const auto is_in = [&](std::size_t i) { return quantity(i) >= edges[b] && quantity(i) < edges[b + 1]; };
    learn::calibration::BreakdownBin bin{edges[b], edges[b + 1], sample_summaries(evaluation, is_in)};
    if (bin.relative_error.front().count > 0) bins.push_back(std::move(bin));
  }
  return bins;
}

/// Fills the summaries and breakdowns from the judged taxels.
inline void summarise_sample(learn::calibration::Evaluation& evaluation) {
  const auto all = sample_summaries(evaluation, [](std::size_t) { return true; });
  for (std::size_t k = 0; k < all.size(); ++k) evaluation.estimators[k].relative_error = all[k];
  const auto& taxels = evaluation.taxels;
  evaluation.by_force =
      sample_bins(evaluation, {1, 2, 5, 10, 20, 50.0001}, [&](std::size_t i) { return taxels[i].true_newtons; });
  const std::vector<double> shares = learn::calibration::covered_shares(taxels, std::array{0.99446, 1.95996});
  evaluation.coverage = {taxels.size(), shares[0], shares[1]};
  evaluation.by_temperature = sample_bins(evaluation, {0, 10, 20, 30, 40, 50},
                                          [&](std::size_t i) { return taxels[i].temperature_celsius.value_or(-1.0); });
  evaluation.by_supply = sample_bins(evaluation, {4.5, 4.7, 4.9, 5.1, 5.3, 5.5},
                                     [&](std::size_t i) { return taxels[i].supply_v.value_or(-1.0); });
  evaluation.by_contacts =
      sample_bins(evaluation, {1, 2, 3, 4, 5}, [&](std::size_t i) { return static_cast<double>(taxels[i].contacts); });
}

inline ArrayDescription sample_array(std::size_t rows, std::size_t cols) {
  ArrayDescription array = support::reference_array(rows, cols);
  array.name = "chest";
  return array;
}

/// A frame with three round contacts, its reading smeared along rows and columns as by crosstalk.
inline learn::calibration::TactileExample sample_example(std::size_t rows, std::size_t cols, std::size_t frame) {
  learn::calibration::TactileExample example;
  example.frame = frame;
  Random random(frame);
  const auto extent = [](std::size_t lines) { return static_cast<double>(lines); };
  std::vector<double> force(rows * cols, 0.0);
  for (int contact = 0; contact < 3; ++contact) {
    const double row = random.uniform(0.1, 0.9) * extent(rows);
    const double col = random.uniform(0.1, 0.9) * extent(cols);
    const double peak = random.uniform(8.0, 40.0);
    for (std::size_t i = 0; i < force.size(); ++i) {
      const std::size_t at_row = i / cols;
      const std::size_t at_col = i % cols;
      const double r = static_cast<double>(at_row) - row;
      const double c = static_cast<double>(at_col) - col;
      const double share = std::exp(-(r * r + c * c) / 3.0);
      if (share > 0.05) force[i] += peak * share;
    }
  }
  std::vector<double> row_sum(rows, 0.0);
  std::vector<double> col_sum(cols, 0.0);
  for (std::size_t i = 0; i < force.size(); ++i) {
    row_sum[i / cols] += force[i];
    col_sum[i % cols] += force[i];
  }
  for (std::size_t i = 0; i < force.size(); ++i) {
    const double smear = 0.06 * (row_sum[i / cols] + col_sum[i % cols]);
    example.reading.push_back(std::min(1.0, std::max(0.0, (force[i] + smear) / 90.0 + 0.004 * random.normal())));
    example.siemens.push_back(1.1e-4 * std::pow(force[i], 0.9) + 5e-6);
    example.newtons.push_back(static_cast<float>(force[i] * std::exp(0.006 * random.normal())));
  }
  example.true_newtons = std::move(force);
  return example;
}

inline learn::calibration::Evaluation empty_sample(std::size_t rows, std::size_t cols) {
  learn::calibration::Evaluation evaluation;
  evaluation.array = sample_array(rows, cols);
  for (const char* name : {"dermis", "raw_lookup", "temperature_lookup", "crosstalk_lookup"}) {
    evaluation.estimators.emplace_back().name = name;
  }
  return evaluation;
}

/// Multi-touch frames with forces of 1 to 50 N, 0 to 50 C and a supply of +-10 %.
inline learn::calibration::Evaluation sample_evaluation(std::size_t rows, std::size_t cols, std::size_t frames) {
  learn::calibration::Evaluation evaluation = empty_sample(rows, cols);
  evaluation.frames = frames;
  evaluation.judged_from_n = 1.0;
  Random random(7);
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const double temperature = random.uniform(0.0, 50.0);
    const double supply = random.uniform(4.5, 5.5);
    const std::size_t contacts = 1 + static_cast<std::size_t>(random.below(4));
    for (int i = 0; i < 8; ++i) {
      const double truth = random.log_uniform(1.0, 50.0);
      const auto taxel = static_cast<std::size_t>(random.below(rows * cols));
      evaluation.taxels.push_back(
          {frame, taxel, truth, temperature, supply, contacts, sample_estimates(truth, temperature, contacts, random)});
      evaluation.taxels.back().sigma_newtons = static_cast<float>(0.006 * truth);
    }
  }
  for (auto& estimator : evaluation.estimators) {
    std::vector<double> ghosts;
    const double scale = estimator.name == "dermis" ? 0.006 : 0.4;
    for (int i = 0; i < 1000; ++i) ghosts.push_back(std::abs(scale * random.normal()));
    estimator.ghost_n = learn::calibration::summarise(std::move(ghosts));
  }
  summarise_sample(evaluation);
  evaluation.examples = {sample_example(rows, cols, 12), sample_example(rows, cols, 57)};
  return evaluation;
}

/// The paper's protocol: 10, 20 and 50 N on 16 action points each, one a frame, at 20 C.
inline learn::calibration::Evaluation paper_sample() {
  learn::calibration::Evaluation evaluation = empty_sample(16, 16);
  evaluation.frames = 48;
  evaluation.judged_from_n = 1.0;
  Random random(3);
  for (std::size_t frame = 0; frame < 48; ++frame) {
    const double truth = frame < 16 ? 10.0 : frame < 32 ? 20.0 : 50.0;
    evaluation.taxels.push_back(
        {frame, 5 * frame, truth, 20.0, 5.0, 1, sample_estimates(truth, 20.0, 1, random), 0.02F});
  }
  summarise_sample(evaluation);
  return evaluation;
}

/// A load cell under the whole pad: only sums are known.
inline learn::calibration::Evaluation totals_sample() {
  learn::calibration::Evaluation evaluation = empty_sample(8, 8);
  evaluation.frames = 200;
  evaluation.judged_from_n = 1.0;
  Random random(5);
  for (std::size_t frame = 0; frame < 200; ++frame) {
    const double truth = random.log_uniform(5.0, 300.0);
    const std::vector<float> estimates = sample_estimates(truth, 20.0, 1, random);
    evaluation.totals.push_back({frame, truth, {}, {estimates.begin(), estimates.end()}});
  }
  for (std::size_t k = 0; k < evaluation.estimators.size(); ++k) {
    auto& estimator = evaluation.estimators[k];
    std::vector<double> errors;
    double square = 0.0;
    for (const auto& total : evaluation.totals) {
      errors.push_back(std::abs(total.newtons[k] / total.true_newtons - 1.0));
      square += (total.newtons[k] - total.true_newtons) * (total.newtons[k] - total.true_newtons);
    }
    estimator.totals_judged = errors.size();
    estimator.total_rmse_n = std::sqrt(square / 200.0);
    estimator.total_relative_error = learn::calibration::summarise(std::move(errors));
  }
  learn::calibration::BreakdownBin bin{5.0, 301.0, {}};
  for (const auto& estimator : evaluation.estimators) bin.relative_error.push_back(estimator.total_relative_error);
  evaluation.by_force = {bin};
  return evaluation;
}

inline touch::pipeline::Model sample_model(const learn::calibration::Evaluation& evaluation) {
  touch::pipeline::Model model;
  model.array = evaluation.array;
  model.networks.shape = {2, 4};
  for (const char* name : {"raw_lookup", "temperature_lookup", "crosstalk_lookup"}) {
    touch::fusion::LookUpTables tables;
    tables.name = name;
    const bool is_bare = tables.name != "crosstalk_lookup";
    tables.signal = is_bare ? touch::fusion::LookUpSignal::reading : touch::fusion::LookUpSignal::conductance;
    tables.temperature_coefficient.assign(4, tables.name == "temperature_lookup" ? 0.004 : 0.0);
    model.baselines.push_back(std::move(tables));
  }
  model.provenance = {{"dermis_version", "0.1.0"},
                      {"frames_sha256", "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08"},
                      {"labelled_frames", "17920"},
                      {"choice", "a network per taxel: 70 single presses on each"}};
  return model;
}

}  // namespace dermis::out::report
