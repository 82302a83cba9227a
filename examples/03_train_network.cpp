// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The BP engine alone: learns Peaks, eq. (1) of the paper, with a network 2-20-1 and asks it for one point.
#include <cstdio>
#include <vector>

#include "dermis/paper/feed_forward.hpp"
#include "dermis/paper/initialisation.hpp"
#include "dermis/paper/peaks.hpp"
#include "dermis/paper/training.hpp"

int main() {
  using namespace dermis::paper;  // NOLINT(google-build-using-namespace)
  const PeaksSamples known = peaks_samples();
  const Samples<double> samples{PeaksSamples::kCount, known.inputs, known.targets, {}};
  const NetworkShape shape{2, {{20, Activation::log_sigmoid}, {1, Activation::linear}}};

  TrainingOptions options;
  options.algorithm = TrainingAlgorithm::levenberg_marquardt;
  options.epochs = 200;
  options.error_goal = 0.05;  // the mean square of eq. (2); Peaks has a variance of 3.52
  auto state = start_training(shape, uniform_start<double>(shape, 3.0, 1), options);
  const dermis::Result<TrainingReport> report = train(state, samples, options);
  if (!report) {
    std::fprintf(stderr, "%s\n", report.error().message.c_str());
    return 2;
  }
  const std::string_view stop = name(report->stop);
  std::printf("%s: error %.3g after %llu epochs (%.*s)\n", shape.describe().c_str(), state.best_error,
              static_cast<unsigned long long>(state.epoch), static_cast<int>(stop.size()), stop.data());

  FeedForward<double> network(shape);
  const std::vector<double> point = {0.5, -1.0};
  std::vector<double> output(1);
  network.evaluate(state.best_parameters, point, output);
  std::printf("peaks(0.5, -1) = %.3f, the network says %.3f\n", peaks(0.5, -1.0), output.front());
  return 0;
}
