// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <memory>
#include <numeric>
#include <span>
#include <vector>

#include "dermis/learn/recognition/comparison.hpp"
#include "dermis/learn/recognition/learning.hpp"
#include "dermis/paper/bp_classifier.hpp"
#include "example_options.hpp"
#include "interruption.hpp"
#include "paper_commands.hpp"
#include "source_options.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

using learn::recognition::EstimatorFigures;
using learn::recognition::LearningSet;

void print_table(std::span<const EstimatorFigures> estimators) {
  fmt::print("{:<16}{:>10}{:>20}\n", "estimator", "accuracy", "calibration error");
  for (const EstimatorFigures& estimator : estimators) {
    const auto& error = estimator.calibration_error;
    fmt::print("{:<16}{:>8.1f} %{:>20}\n", estimator.name, 100.0 * estimator.accuracy,
               error ? fmt::format("{:.1f} %", 100.0 * *error) : "-");
  }
}

Status learn(const recognising::ExampleOptions& examples) {
  const Result<learn::recognition::LabelledFrames> data = recognising::read_examples(examples, source_options());
  if (!data) return data.error();
  Progress progress;
  const Result<LearningSet> set = LearningSet::create(*data, [&](double share) { progress.show("features", share); });
  if (!set) return set.error();
  std::vector<std::size_t> all(data->labels.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const Result<learn::recognition::Learned> learned = set->learn(all);
  if (!learned) return learned.error();
  const learn::recognition::ComparedEstimator network{"BP network", paper::answer_by_bp_network};
  const auto estimators = learn::recognition::compare_estimators(
      *data, *set, *learned, std::span(&network, 1), [&](double share) { progress.show("comparison", share); });
  if (!estimators) return estimators.error();
  print_table(*estimators);
  return Done{};
}

}  // namespace

void add_paper_learn(Command& command) {
  auto examples = std::make_shared<recognising::ExampleOptions>();
  add_taught_examples(command, *examples);
  command.action([examples] {
    end_when_interrupted();
    return learn(*examples);
  });
}

}  // namespace dermis::app
