// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/evaluation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/touch/pipeline/frame_troubles.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "learn/calibration/evaluation/bound_collector.hpp"
#include "learn/calibration/evaluation/breakdown.hpp"
#include "learn/calibration/evaluation/coverage.hpp"
#include "learn/calibration/evaluation/estimator_row.hpp"
#include "learn/calibration/evaluation/example_choice.hpp"
#include "learn/calibration/evaluation/judgement.hpp"
#include "learn/calibration/evaluation/sum_judgement.hpp"
#include "learn/calibration/labels/label_check.hpp"
#include "learn/calibration/labels/labels.hpp"

namespace dermis::learn::calibration {
namespace {

/// The most that the loads say of one taxel, of a total its share [N].
double heaviest_of(const ArrayDescription& array, const LoadsOfFrames& loads_of) {
  double heaviest = 0.0;
  for (std::size_t frame = 0; frame < loads_of.frame_count(); ++frame) {
    if (loads_of[frame].empty()) continue;
    Sample truth;
    expand_loads(array, loads_of[frame], truth);
    for (const float newtons : truth.known_newtons) heaviest = std::max(heaviest, static_cast<double>(newtons));
    for (const TotalForce& total : truth.totals) {
      heaviest = std::max(heaviest, total.newtons / static_cast<double>(total.taxels.size()));
    }
  }
  return heaviest;
}

/// Readings that are forces already have no calibration whose range could be followed: that of the loads is.
double judged_from(const touch::pipeline::Model& model, const LoadsOfFrames& loads_of) {
  const auto [least, most] = model.networks.sigma_knots_newtons;
  if (model.array.readout.quantity == Quantity::counts) return kJudgedShare * static_cast<double>(most);
  return std::max(kJudgedShare * heaviest_of(model.array, loads_of), static_cast<double>(least));
}

}  // namespace

Result<Evaluation> evaluate(const touch::pipeline::Model& model, std::span<const RawFrame> frames,
                            std::span<const Load> loads, FurtherEstimator* further) {
  if (Status checked = check_loads(model.array, frames.size(), loads); !checked) return checked.error();
  if (const auto turn = check_labels(model.array, frames, loads, {}).turn) return bad_input(*turn);
  Result<touch::pipeline::Pipeline> pipeline = touch::pipeline::Pipeline::create(model);
  if (!pipeline) return pipeline.error();
  if (further != nullptr && further->taxel_count() != model.array.taxel_count()) {
    return bad_input(fmt::format("{} is for {} taxels, the model for {}", further->name(), further->taxel_count(),
                                 model.array.taxel_count()));
  }

  Evaluation evaluation;
  evaluation.array = model.array;
  const LoadsOfFrames loads_of(loads, frames.size());
  EstimatorRow row(model, std::move(*pipeline), further, judged_from(model, loads_of));
  evaluation.judged_from_n = row.judged_from_n();
  Judgement judgement(row.names().size(), model.array.taxel_count());
  ExampleChoice examples;
  SumJudgement sums;
  std::size_t labelled = 0;
  for (std::size_t frame = 0; frame < frames.size(); ++frame) labelled += loads_of[frame].empty() ? 0 : 1;
  BoundCollector bound(model, labelled);
  touch::pipeline::FrameTroubles troubles(model.array, "");
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    const bool accepted = row.run(frames[frame]);
    troubles.add(frames[frame], row.force(), row.pipeline());
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
    sums.add(truth, row.force());
    bound.offer(truth, row);
  }
  evaluation.most_have_forces = troubles.verdict();
  if (evaluation.frames == 0) {
    if (!evaluation.most_have_forces) return evaluation.most_have_forces.error();
    return bad_input("no labelled frame fits the model's array");
  }
  for (std::size_t k = 0; k < row.names().size(); ++k) {
    evaluation.estimators.push_back(judgement.result(k, row.names()[k]));
  }
  if (further != nullptr) evaluation.estimators.back().description = further->description();
  evaluation.taxels = std::move(judgement.taxels);
  evaluation.totals = std::move(judgement.totals);
  evaluation.after_release = judgement.after_release.bins();
  evaluation.bound = bound.comparison();
  evaluation.coverage = coverage_of(evaluation.taxels);
  evaluation.sums = sums.errors();
  evaluation.examples = std::move(examples).chosen();
  break_down(evaluation);
  return evaluation;
}

}  // namespace dermis::learn::calibration
