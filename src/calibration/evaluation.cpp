// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/calibration/evaluation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "calibration/bound_collector.hpp"
#include "calibration/breakdown.hpp"
#include "calibration/coverage.hpp"
#include "calibration/estimator_row.hpp"
#include "calibration/example_choice.hpp"
#include "calibration/judgement.hpp"
#include "calibration/labels.hpp"
#include "dermis/calibration/sample_database.hpp"
#include "dermis/pipeline/pipeline.hpp"

namespace dermis::calibration {

Result<Evaluation> evaluate(const pipeline::Model& model, std::span<const RawFrame> frames, std::span<const Load> loads,
                            FurtherEstimator* further) {
  if (Status checked = check_loads(model.array, frames.size(), loads); !checked) return checked.error();
  Result<pipeline::Pipeline> pipeline = pipeline::Pipeline::create(model);
  if (!pipeline) return pipeline.error();
  if (further != nullptr && further->taxel_count() != model.array.taxel_count()) {
    return bad_input(fmt::format("{} is for {} taxels, the model for {}", further->name(), further->taxel_count(),
                                 model.array.taxel_count()));
  }

  Evaluation evaluation;
  evaluation.array = model.array;
  EstimatorRow row(model, std::move(*pipeline), further);
  evaluation.judged_from_n = row.judged_from_n();
  Judgement judgement(row.names().size());
  ExampleChoice examples;
  const LoadsOfFrames loads_of(loads, frames.size());
  std::size_t labelled = 0;
  for (std::size_t frame = 0; frame < frames.size(); ++frame) labelled += loads_of[frame].empty() ? 0 : 1;
  BoundCollector bound(model, labelled);
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    const bool accepted = row.run(frames[frame]);
    if (loads_of[frame].empty()) continue;
    if (!accepted) {
      ++evaluation.frames_rejected;
      continue;
    }
    ++evaluation.frames;
    Sample truth;
    expand_loads(model.array, loads_of[frame], truth);
    judgement.add(frame, frames[frame], truth, row);
    examples.offer(frame, truth, row);
    bound.offer(truth, row);
  }
  if (evaluation.frames == 0) return bad_input("no labelled frame fits the model's array");
  for (std::size_t k = 0; k < row.names().size(); ++k) {
    evaluation.estimators.push_back(judgement.result(k, row.names()[k]));
  }
  if (further != nullptr) evaluation.estimators.back().description = further->description();
  evaluation.taxels = std::move(judgement.taxels);
  evaluation.totals = std::move(judgement.totals);
  evaluation.bound = bound.comparison();
  evaluation.coverage = coverage_of(evaluation.taxels);
  evaluation.examples = std::move(examples).chosen();
  break_down(evaluation);
  return evaluation;
}

}  // namespace dermis::calibration
