// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/learning/learning_judgement.hpp"

#include <algorithm>
#include <map>
#include <string>

#include "learn/recognition/answer/calibration_error.hpp"

namespace dermis::learn::recognition {
namespace {

/// Subjects or sessions and how many examples each has; none where some label names none.
std::map<std::string, std::size_t> groups_of(const std::vector<Label>& labels) {
  std::map<std::string, std::size_t> groups;
  for (const Label& label : labels) ++groups[label.group];
  if (groups.contains("")) groups.clear();
  return groups;
}

/// [classes]
std::vector<std::size_t> most_in_one_fold(const Judged& judged, std::size_t folds, std::size_t class_count) {
  std::vector<std::size_t> counts(folds * class_count, 0);
  std::vector<std::size_t> most(class_count, 0);
  for (std::size_t i = 0; i < judged.classes.size(); ++i) {
    const std::size_t count = ++counts[judged.fold_of[i] * class_count + judged.classes[i]];
    most[judged.classes[i]] = std::max(most[judged.classes[i]], count);
  }
  return most;
}

}  // namespace

LearningReport judge(const Judged& judged, const Folds& folds, const std::vector<Label>& labels,
                     const std::vector<Matrix>& scores) {
  const auto class_count = static_cast<std::size_t>(scores.front().cols());
  LearningReport report;
  report.by_group = folds.kind == Folds::Kind::by_group;
  report.folds = folds.count;
  report.fold_of = folds.fold_of;
  for (const auto& [name, size] : groups_of(labels)) {
    ++report.groups;
    report.largest_group = std::max(report.largest_group, size);
  }
  report.in_one_fold = most_in_one_fold(judged, folds.count, class_count);
  report.confusion.assign(class_count * class_count, 0);
  Matrix probabilities = fused_out_of_fold(judged, scores);
  softmax(judged, probabilities);
  CalibrationError calibration;
  std::size_t right = 0;
  for (std::size_t i = 0; i < judged.classes.size(); ++i) {
    if (!judged.counts(i)) continue;
    Eigen::Index answer = 0;
    const double confidence = probabilities.row(static_cast<Eigen::Index>(i)).maxCoeff(&answer);
    const bool is_right = static_cast<std::size_t>(answer) == judged.classes[i];
    ++report.confusion[judged.classes[i] * class_count + static_cast<std::size_t>(answer)];
    report.judgements.push_back({i, judged.classes[i], static_cast<std::size_t>(answer), confidence});
    ++report.judged;
    right += is_right ? 1 : 0;
    calibration.add(confidence, is_right);
  }
  report.accuracy = static_cast<double>(right) / static_cast<double>(std::max<std::size_t>(report.judged, 1));
  report.calibration_error = calibration.value();
  return report;
}

}  // namespace dermis::learn::recognition
