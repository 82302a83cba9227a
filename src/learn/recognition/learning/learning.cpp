// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/learning.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <utility>

#include "dermis/learn/recognition/stream_recogniser.hpp"
#include "learn/recognition/features/aspects.hpp"
#include "learn/recognition/features/feature_columns.hpp"
#include "learn/recognition/features/segment_features.hpp"
#include "learn/recognition/learning/confused_pair.hpp"
#include "learn/recognition/learning/discriminant.hpp"
#include "learn/recognition/learning/expert_choice.hpp"
#include "learn/recognition/learning/expert_fusion.hpp"
#include "learn/recognition/learning/folds.hpp"
#include "learn/recognition/learning/kernel_regression.hpp"
#include "learn/recognition/learning/learning_judgement.hpp"
#include "learn/recognition/learning/unknown_learning.hpp"
#include "learn/recognition/names.hpp"
#include "learn/recognition/valid_reading.hpp"

namespace dermis::learn::recognition {
namespace {

/// The zero of an array is not the same on another day. It is raised so much in copies of the examples, as shares of
/// the largest reading of each. Classes are not distinguished by that difference.
constexpr std::array kRaisedZeros{0.03, 0.08};

/// The loads of a segment above a level that is a share of its largest.
void raise_zero(std::span<const float> frames, double share, std::vector<float>& raised) {
  double largest = 0.0;
  for (const float reading : frames) largest = std::max(largest, valid_reading(reading));
  raised.clear();
  for (const float reading : frames) {
    raised.push_back(static_cast<float>(std::max(valid_reading(reading) - share * largest, 0.0)));
  }
}

/// Features of each label.
struct Features {
  Matrix seen;                 ///< [labels, features]
  std::vector<Matrix> raised;  ///< Of each of kRaisedZeros.
};

Features compute_features(const LabelledFrames& data, bool moving, const std::function<void(double)>& progress) {
  SegmentFeatures features(data.layout, data.layout, moving, data.longest());
  const auto labels = static_cast<Eigen::Index>(data.labels.size());
  const Matrix empty(labels, static_cast<Eigen::Index>(feature_columns(data.layout, moving).count));
  Features tables{empty, std::vector<Matrix>(kRaisedZeros.size(), empty)};
  std::vector<float> raised;
  for (Eigen::Index row = 0; row < labels; ++row) {
    const auto put = [&](const Segment& segment, Matrix& table) {
      const std::span<const double> values = features.compute(segment);
      std::copy(values.begin(), values.end(), table.row(row).begin());
    };
    const Segment segment = data.segment(data.labels[static_cast<std::size_t>(row)]);
    put(segment, tables.seen);
    for (std::size_t i = 0; i < kRaisedZeros.size(); ++i) {
      raise_zero(segment.frames, kRaisedZeros[i], raised);
      put({raised, segment.extras}, tables.raised[i]);
    }
    if (progress) progress(static_cast<double>(row + 1) / static_cast<double>(labels));
  }
  return tables;
}

std::vector<Touch> touches_of(const std::vector<Label>& labels) {
  std::vector<Touch> touches;
  for (const Label& label : labels) touches.push_back({label.first, label.last});
  return touches;
}

/// Force of each frame.
std::vector<double> forces_of(const LabelledFrames& data) {
  std::vector<double> forces;
  const std::span<const float> frames = data.frames;
  for (std::size_t frame = 0; frame < data.frame_count(); ++frame) {
    forces.push_back(force_of(data.layout, frames.subspan(frame * data.layout.readings, data.layout.readings)));
  }
  return forces;
}

/// Names, sorted, and how many examples each has.
std::map<std::string, std::int64_t> count_names(const std::vector<Label>& labels) {
  std::map<std::string, std::int64_t> counts;
  for (const Label& label : labels) ++counts[label.name];
  return counts;
}

Status check_counts(const std::map<std::string, std::int64_t>& counts) {
  if (counts.empty()) return bad_input("there is no example to learn from");
  if (counts.size() == 1) {
    return bad_input("all examples are of class '" + counts.begin()->first + "'; two classes or more are needed");
  }
  if (counts.size() > kMostClasses) {
    return bad_input("there are " + std::to_string(counts.size()) + " classes; at most " +
                     std::to_string(kMostClasses) + " can be learned");
  }
  for (const auto& [name, count] : counts) {
    if (Status checked = check_class_name(name); !checked) return checked;
    if (count == 1) return bad_input("class '" + name + "' has one example; give it two or more, or leave it out");
  }
  return Done{};
}

template <typename To, typename From>
std::vector<To> converted(const From& values) {
  std::vector<To> result;
  result.reserve(static_cast<std::size_t>(values.size()));
  for (const auto value : values) result.push_back(static_cast<To>(value));
  return result;
}

Expert train_expert(const TrainingTable& table, const ExpertColumns& columns, const LearningWay& way) {
  const Standardisation standardisation = standardisation_of(table.features, table.rows, columns.columns);
  Expert expert{.name = columns.name,
                .columns = converted<std::int64_t>(standardisation.columns),
                .mean = converted<float>(standardisation.mean),
                .scale = converted<float>(standardisation.scale)};
  const Teaching teaching = teaching_of(table, table.rows, table.classes, standardisation, way.strays);
  if (columns.estimator == Estimator::kernel) {
    expert.width = way.narrowness / static_cast<double>(standardisation.columns.size());
    const KernelRegression kernels = train_kernels(teaching, expert.width, way.shrinkage);
    expert.centres = converted<float>(kernels.centres.reshaped<Eigen::RowMajor>());
    expert.influences = converted<float>(kernels.influences.reshaped<Eigen::RowMajor>());
    return expert;
  }
  const Discriminant discriminant = train_discriminant(teaching, way.shrinkage);
  expert.rank = static_cast<std::size_t>(discriminant.axes.rows());
  expert.axes = converted<float>(discriminant.axes.reshaped<Eigen::RowMajor>());
  expert.class_means = converted<float>(discriminant.means.reshaped<Eigen::RowMajor>());
  return expert;
}

/// The experts that distinguish anything, each with its answers on examples that it had not learned from.
struct Panel {
  std::vector<ExpertColumns> columns;
  std::vector<ExpertChoice> choices;
};

Panel panel_of(const TrainingTable& table, const std::vector<ExpertColumns>& experts, const Folds& folds,
               const Judged& judged, Estimator estimator, bool strays) {
  Panel panel;
  for (const ExpertColumns& expert : experts) {
    if (expert.estimator != estimator) continue;
    if (standardisation_of(table.features, table.rows, expert.columns).columns.empty()) continue;
    panel.columns.push_back(expert);
    panel.choices.push_back(choose_expert(table, expert, folds, judged, strays));
  }
  return panel;
}

std::vector<Matrix> scores_of(const Panel& panel) {
  std::vector<Matrix> scores;
  for (const ExpertChoice& choice : panel.choices) scores.push_back(choice.scores);
  return scores;
}

double log_loss_of(const Panel& panel, const Judged& judged) {
  const std::vector<Matrix> scores = scores_of(panel);
  return log_loss(judged, fused_scores(scores, fuse(judged, scores)), 1.0);
}

/// With strays where the log likelihood gains 1 by them: Akaike's criterion for one more parameter.
Panel choose_panel(const TrainingTable& table, const std::vector<ExpertColumns>& experts, const Folds& folds,
                   const Judged& judged) {
  Panel panel = panel_of(table, experts, folds, judged, Estimator::discriminant, false);
  if (panel.choices.empty()) return panel;
  Panel steady = panel_of(table, experts, folds, judged, Estimator::discriminant, true);
  const double least_gain = 1.0 / static_cast<double>(table.rows.size());
  if (log_loss_of(steady, judged) < log_loss_of(panel, judged) - least_gain) panel = std::move(steady);
  Panel kernels = panel_of(table, experts, folds, judged, Estimator::kernel, false);
  std::move(kernels.columns.begin(), kernels.columns.end(), std::back_inserter(panel.columns));
  std::move(kernels.choices.begin(), kernels.choices.end(), std::back_inserter(panel.choices));
  return panel;
}

std::vector<Matrix> distances_of(const TrainingTable& table, const Panel& panel, const Folds& folds) {
  std::vector<Matrix> distances;
  for (std::size_t i = 0; i < panel.choices.size(); ++i) {
    distances.push_back(distances_out_of_fold(table, panel.columns[i], folds, panel.choices[i]));
  }
  return distances;
}

/// Answers for runs of time that were not seen, where the folds do not hold out whole groups already. `scores`: by the
/// folds.
LearningReport report_of(const Classes& classes, const TrainingTable& table, const Folds& folds,
                         const std::vector<Label>& labels, const std::vector<Matrix>& scores) {
  const bool by_group = folds.kind == Folds::Kind::by_group;
  const Folds held_out = by_group ? folds : make_folds(labels, table.classes, Deal::in_runs);
  const Judged judged = judged_by(held_out, table.classes, table.class_count);
  const std::vector<ExpertColumns> experts = expert_columns(classes.layout, classes.moving);
  LearningReport report =
      judge(judged, held_out, labels, by_group ? scores : scores_of(choose_panel(table, experts, held_out, judged)));
  report.confused = find_confused_pair(report, table, aspect_columns(classes.layout, classes.moving), held_out);
  return report;
}

}  // namespace

struct LearningSet::State {
  Layout layout;
  bool moving = false;
  std::vector<Label> labels;
  Features features;
};

Result<LearningSet> LearningSet::create(const LabelledFrames& data, const std::function<void(double)>& progress) {
  if (Status checked = data.validate(); !checked) return checked.error();
  const bool moving =
      std::any_of(data.labels.begin(), data.labels.end(), [](const Label& label) { return label.last > label.first; });
  return LearningSet(
      std::make_unique<State>(State{data.layout, moving, data.labels, compute_features(data, moving, progress)}));
}

LearningSet::LearningSet(std::unique_ptr<State> state) : state_(std::move(state)) {}
LearningSet::LearningSet(LearningSet&&) noexcept = default;
LearningSet& LearningSet::operator=(LearningSet&&) noexcept = default;
LearningSet::~LearningSet() = default;

std::span<const double> LearningSet::features() const noexcept {
  const Matrix& seen = state_->features.seen;
  return {seen.data(), static_cast<std::size_t>(seen.size())};
}

Result<Learned> LearningSet::learn(std::span<const std::size_t> chosen) const {
  std::vector<Label> labels;
  for (const std::size_t label : chosen) labels.push_back(state_->labels[label]);
  const std::map<std::string, std::int64_t> counts = count_names(labels);
  if (Status checked = check_counts(counts); !checked) return checked.error();

  Learned learned;
  Classes& classes = learned.classes;
  classes.layout = state_->layout;
  classes.moving = state_->moving;
  for (const auto& [name, count] : counts) {
    classes.names.push_back(name);
    classes.examples.push_back(count);
  }
  TrainingTable table{
      state_->features.seen, state_->features.raised, {chosen.begin(), chosen.end()}, {}, counts.size()};
  for (const Label& label : labels) {
    table.classes.push_back(static_cast<std::size_t>(std::distance(counts.begin(), counts.find(label.name))));
  }
  const Folds folds = make_folds(labels, table.classes, Deal::in_turns);
  const Judged judged = judged_by(folds, table.classes, table.class_count);
  const std::vector<ExpertColumns> experts = expert_columns(classes.layout, classes.moving);
  const Panel panel = choose_panel(table, experts, folds, judged);
  if (panel.choices.empty()) return bad_input("all examples are the same; are the frames the right ones?");

  const std::vector<Matrix> scores = scores_of(panel);
  const std::vector<double> weights = fuse(judged, scores);
  for (std::size_t i = 0; i < panel.choices.size(); ++i) {
    classes.experts.push_back(train_expert(table, panel.columns[i], panel.choices[i].way));
    classes.experts.back().weight = weights[i] * panel.choices[i].sharpness;
  }
  learn_unknown(classes, judged, fused_out_of_fold(judged, scores), distances_of(table, panel, folds));
  learned.report = report_of(classes, table, folds, labels, scores);
  return learned;
}

std::optional<TouchLimits> learn_touches(const LabelledFrames& data) {
  constexpr std::size_t kLeastIdle = 10;  // one of so many frames
  const std::vector<Touch> labelled = touches_of(data.labels);
  std::size_t held = 0;
  bool moving = false;
  for (const Touch& touch : labelled) {
    held += touch.last - touch.first + 1;
    moving = moving || touch.last > touch.first;
  }
  if (!moving || kLeastIdle * (data.frame_count() - held) < data.frame_count()) return std::nullopt;
  return learn_touch_limits(forces_of(data), labelled);
}

FindingReport judge_touches(const LabelledFrames& data, const TouchLimits& limits) {
  return judge_finding(touches_of(data.labels), find_touches(limits, forces_of(data)));
}

}  // namespace dermis::learn::recognition
