// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/learning/confused_pair.hpp"

#include <algorithm>
#include <array>

namespace dermis::learn::recognition {
namespace {

/// The examples of two classes, as classes 0 and 1, and their folds.
struct TwoClasses {
  TrainingTable table;
  Folds folds;
};

TwoClasses choose_two(const ConfusedPair& pair, const TrainingTable& table, const Folds& folds) {
  TwoClasses two{{table.features, table.raised, {}, {}, 2}, {folds.kind, {}, folds.count}};
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (table.classes[i] != pair.first && table.classes[i] != pair.second) continue;
    two.table.rows.push_back(table.rows[i]);
    two.table.classes.push_back(table.classes[i] == pair.first ? 0 : 1);
    two.folds.fold_of.push_back(folds.fold_of[i]);
  }
  return two;
}

/// Mean over both classes of the share that is right, of examples whose other folds know both; empty without one.
std::optional<double> discrimination_of(const Matrix& scores, const Judged& judged) {
  std::array<double, 2> right{};
  std::array<double, 2> count{};
  for (std::size_t i = 0; i < judged.classes.size(); ++i) {
    const auto& is_known = judged.is_known[judged.fold_of[i]];
    if (is_known[0] == 0 || is_known[1] == 0) continue;
    const std::size_t label = judged.classes[i];
    count[label] += 1.0;
    right[label] += scores(index(i), index(label)) > scores(index(i), index(1 - label)) ? 1.0 : 0.0;
  }
  if (count[0] == 0.0 || count[1] == 0.0) return std::nullopt;
  return 0.5 * (right[0] / count[0] + right[1] / count[1]);
}

}  // namespace

std::optional<ConfusedPair> find_confused_pair(const LearningReport& report, const TrainingTable& table,
                                               const std::vector<ExpertColumns>& aspects, const Folds& folds) {
  ConfusedPair pair;
  for (std::size_t a = 0; a < table.class_count; ++a) {
    for (std::size_t b = a + 1; b < table.class_count; ++b) {
      const std::size_t mistakes =
          report.confusion[a * table.class_count + b] + report.confusion[b * table.class_count + a];
      if (mistakes > pair.mistakes) pair = {a, b, mistakes, {}};
    }
  }
  if (pair.mistakes == 0) return std::nullopt;
  const TwoClasses two = choose_two(pair, table, folds);
  const Judged judged = judged_by(two.folds, two.table.classes, 2);
  for (const ExpertColumns& aspect : aspects) {
    if (standardisation_of(table.features, two.table.rows, aspect.columns).columns.empty()) continue;
    const Matrix scores = choose_expert(two.table, aspect, two.folds, judged, false).scores;
    if (const auto share = discrimination_of(scores, judged)) pair.aspects.push_back({aspect.name, *share});
  }
  std::stable_sort(pair.aspects.begin(), pair.aspects.end(),
                   [](const auto& a, const auto& b) { return a.discrimination < b.discrimination; });
  return pair;
}

}  // namespace dermis::learn::recognition
