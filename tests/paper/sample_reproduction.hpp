// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "dermis/paper/paper_bank.hpp"
#include "dermis/paper/paper_report.hpp"
#include "dermis/touch/frames/random.hpp"
#include "out/report/sample_evaluation.hpp"

namespace dermis::paper {

/// Falls from `first` to `last` over the steps as trainings do.
inline TrainingCurve sample_curve(std::string name, double steps, double first, double last) {
  TrainingCurve curve{std::move(name), {}, {}};
  for (double step = 1.0; step < steps; step = std::ceil(step * 1.06)) {
    const double done = std::log(step) / std::log(steps);
    curve.step.push_back(step);
    curve.value.push_back(first * std::pow(last / first, done * done));
  }
  curve.step.push_back(steps);
  curve.value.push_back(last);
  return curve;
}

inline PeaksReproduction sample_peaks() {
  PeaksReproduction peaks;
  peaks.variance = 3.41;
  peaks.range = 14.63;
  peaks.adaptive_rate_starts = 20;
  peaks.adaptive_rate_epochs = 10000;
  peaks.adaptive_rate_best_mse = 0.634;
  peaks.adaptive_rate_curve = sample_curve("E", 10000.0, 11.0, 0.634);
  peaks.side = 61;
  for (std::size_t row = 0; row < 61; ++row) {
    for (std::size_t col = 0; col < 61; ++col) {
      const double x = -3.0 + 0.1 * static_cast<double>(col);
      const double y = -3.0 + 0.1 * static_cast<double>(row);
      const double z = 3.0 * (1.0 - x) * (1.0 - x) * std::exp(-x * x - (y + 1.0) * (y + 1.0)) -
                       10.0 * (x / 5.0 - x * x * x - std::pow(y, 5.0)) * std::exp(-x * x - y * y) -
                       std::exp(-(x + 1.0) * (x + 1.0) - y * y) / 3.0;
      peaks.target.push_back(z);
      peaks.output.push_back(z + 0.5 * std::sin(2.1 * x + 0.4) * std::cos(1.7 * y) * std::exp(-(x * x + y * y) / 7.0));
    }
  }
  for (std::size_t hidden = 5; hidden <= 14; ++hidden) {
    const double size = static_cast<double>(hidden) - 5.0;
    peaks.by_hidden.push_back({hidden, 40, 0.071 * std::exp(-0.9 * size), 0.00033 * std::exp(-0.9 * size)});
  }
  peaks.smallest_hidden_raw = 10;
  peaks.smallest_hidden_normalised = 5;
  return peaks;
}

inline std::vector<StartSystem> sample_start() {
  const double ln3 = std::log(3.0);
  std::vector<StartSystem> systems;
  for (const auto& [where, neighbours] : {std::pair{"centre", 8U}, {"edge", 5U}, {"corner", 3U}}) {
    systems.push_back({"(11)", where, neighbours, 2.0 * ln3, 0.0, 0.0, -ln3, 2.2e-16});
    systems.push_back({"(12)", where, neighbours, 4.0 * ln3, 0.0, 0.0, -2.0 * ln3, 4.4e-16});
  }
  systems.push_back({"(15)", "output", 0, 4.0 * ln3 / 256.0, std::nullopt, std::nullopt, -2.0 * ln3, 2.2e-16});
  return systems;
}

/// The estimates of paper_sample() and of a bank that misses the truth by `bank_spread` and more.
inline void add_sample_points(PaperReproduction& reproduction, double bank_spread) {
  learn::calibration::Evaluation evaluation = out::report::paper_sample();
  learn::calibration::EstimatorResult& bank_result = evaluation.estimators.emplace_back();
  bank_result.name = kPaperBankName;
  bank_result.description = "one N-N-N-1 network a taxel";
  Random random(11);
  for (auto& judged : evaluation.taxels) {
    const double bank = judged.true_newtons * (1.0 + bank_spread * random.uniform(-1.0, 1.0));
    judged.newtons.push_back(static_cast<float>(bank));
    const double volts = 5.0 / (1.0 + 4.0 * std::pow(10.0 / judged.true_newtons, 0.9) * random.uniform(0.9, 1.1));
    reproduction.points.push_back({"r" + std::to_string(judged.taxel / 16) + "c" + std::to_string(judged.taxel % 16),
                                   judged.true_newtons, volts, volts * random.uniform(0.995, 1.005), bank,
                                   static_cast<double>(judged.newtons[0])});
  }
  out::report::summarise_sample(evaluation);
  reproduction.model = out::report::sample_model(evaluation);
  reproduction.evaluation = std::move(evaluation);
}

inline PaperReproduction sample_reproduction() {
  PaperReproduction reproduction;
  reproduction.peaks = sample_peaks();
  reproduction.unknowns = 33751296;
  reproduction.start = sample_start();
  reproduction.convergence = {sample_curve("structured start", 2000.0, 0.05, 0.0021),
                              sample_curve("uniform random start", 2000.0, 0.09, 0.0048),
                              sample_curve("all connections equal", 2000.0, 0.08, 0.031)};
  reproduction.bank_training = sample_curve("bank", 20000.0, 0.05, 0.00009);
  reproduction.bank_samples = 20480;
  reproduction.own_samples = 80;
  add_sample_points(reproduction, 0.12);
  reproduction.seconds = {{"Peaks", 41.2}, {"structured start", 0.0031}, {"bank", 212.0}, {"points", 0.8}};
  return reproduction;
}

}  // namespace dermis::paper
