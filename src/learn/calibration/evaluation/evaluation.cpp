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
#include "learn/calibration/sheet/felt_loads.hpp"

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

Status check_further(const touch::pipeline::Model& model, const FurtherEstimator* further) {
  if (further == nullptr || further->taxel_count() == model.array.taxel_count()) return Done{};
  return bad_input(fmt::format("{} is for {} taxels, the model for {}", further->name(), further->taxel_count(),
                               model.array.taxel_count()));
}

std::size_t labelled_frames(const LoadsOfFrames& loads_of) {
  std::size_t labelled = 0;
  for (std::size_t frame = 0; frame < loads_of.frame_count(); ++frame) labelled += loads_of[frame].empty() ? 0 : 1;
  return labelled;
}

/// The estimators side by side, and what their answers are counted for.
class Judges {
 public:
  Judges(const touch::pipeline::Model& model, const LoadsOfFrames& loads_of, EstimatorRow row)
      : array_(model.array),
        loads_of_(loads_of),
        row_(std::move(row)),
        judgement_(row_.names().size(), model.array.taxel_count()),
        bound_(model, labelled_frames(loads_of)),
        troubles_(model.array, "") {}

  void judge(std::size_t frame, const RawFrame& raw, Evaluation& evaluation) {
    const bool accepted = row_.run(raw);
    troubles_.add(raw, row_.force(), row_.pipeline());
    if (loads_of_[frame].empty()) return;
    ++(accepted ? evaluation.frames : evaluation.frames_rejected);
    if (!accepted) return;
    Sample truth;
    expand_loads(array_, loads_of_[frame], truth);
    judgement_.add(frame, raw, truth, row_);
    examples_.offer(frame, truth, row_);
    sums_.add(truth, row_.force());
    bound_.offer(truth, row_);
  }

  [[nodiscard]] Status verdict() const { return troubles_.verdict(); }

  void finish(const FurtherEstimator* further, Evaluation& evaluation) {
    for (std::size_t k = 0; k < row_.names().size(); ++k) {
      evaluation.estimators.push_back(judgement_.result(k, row_.names()[k]));
    }
    if (further != nullptr) evaluation.estimators.back().description = further->description();
    evaluation.taxels = std::move(judgement_.taxels);
    evaluation.totals = std::move(judgement_.totals);
    evaluation.after_release = judgement_.after_release.bins();
    evaluation.bound = bound_.comparison();
    evaluation.coverage = coverage_of(evaluation.taxels);
    evaluation.sums = sums_.errors();
    evaluation.examples = std::move(examples_).chosen();
    break_down(evaluation);
  }

 private:
  const ArrayDescription& array_;
  const LoadsOfFrames& loads_of_;
  EstimatorRow row_;
  Judgement judgement_;
  ExampleChoice examples_;
  SumJudgement sums_;
  BoundCollector bound_;
  touch::pipeline::FrameTroubles troubles_;
};

}  // namespace

Result<Evaluation> evaluate(const touch::pipeline::Model& model, std::span<const RawFrame> frames,
                            std::span<const Load> loads, FurtherEstimator* further) {
  if (Status checked = check_loads(model.array, frames.size(), loads); !checked) return checked.error();
  if (const auto turn = check_labels(model.array, frames, loads, {}).turn) return bad_input(*turn);
  Result<touch::pipeline::Pipeline> pipeline = touch::pipeline::Pipeline::create(model);
  if (!pipeline) return pipeline.error();
  if (Status checked = check_further(model, further); !checked) return checked.error();

  Evaluation evaluation;
  evaluation.array = model.array;
  const std::vector<Load> felt = felt_loads(model.array, loads);
  const LoadsOfFrames loads_of(felt, frames.size());
  evaluation.judged_from_n = judged_from(model, loads_of);
  Judges judges(model, loads_of, EstimatorRow(model, std::move(*pipeline), further, evaluation.judged_from_n));
  for (std::size_t frame = 0; frame < frames.size(); ++frame) judges.judge(frame, frames[frame], evaluation);
  evaluation.most_have_forces = judges.verdict();
  if (evaluation.frames == 0) {
    if (!evaluation.most_have_forces) return evaluation.most_have_forces.error();
    return bad_input("no labelled frame fits the model's array");
  }
  judges.finish(further, evaluation);
  return evaluation;
}

}  // namespace dermis::learn::calibration
