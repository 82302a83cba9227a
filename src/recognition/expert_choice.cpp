// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recognition/expert_choice.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace dermis::recognition {
namespace {

using Path = std::array<Matrix, kShrinkages.size()>;

/// The examples of one fold, and the others.
struct Lesson {
  std::vector<std::size_t> taught;   ///< Rows of the features.
  std::vector<std::size_t> classes;  ///< Of those.
  std::vector<std::size_t> asked;    ///< Rows of the features.
  std::vector<std::size_t> places;   ///< Of those among the examples.
};

Lesson lesson_of(const TrainingTable& table, const Folds& folds, std::size_t fold) {
  Lesson lesson;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (folds.fold_of[i] == fold) {
      lesson.asked.push_back(table.rows[i]);
      lesson.places.push_back(i);
    } else {
      lesson.taught.push_back(table.rows[i]);
      lesson.classes.push_back(table.classes[i]);
    }
  }
  return lesson;
}

/// Scores of all examples, each by what the other folds taught.
Path score_out_of_fold(const TrainingTable& table, const ExpertColumns& expert, const Folds& folds) {
  Path all;
  all.fill(Matrix::Zero(index(table.rows.size()), index(table.class_count)));
  for (std::size_t fold = 0; fold < folds.count; ++fold) {
    const Lesson lesson = lesson_of(table, folds, fold);
    const Standardisation standardisation = standardisation_of(table.features, lesson.taught, expert.columns);
    if (lesson.asked.empty() || standardisation.columns.empty()) continue;
    const Path path = score_others(standardised(table.features, lesson.taught, standardisation), lesson.classes,
                                   table.class_count, standardised(table.features, lesson.asked, standardisation));
    for (std::size_t i = 0; i < path.size(); ++i) {
      for (std::size_t place = 0; place < lesson.places.size(); ++place) {
        all[i].row(index(lesson.places[place])) = path[i].row(index(place));
      }
    }
  }
  return all;
}

}  // namespace

Judged judged_by(const Folds& folds, const std::vector<std::size_t>& classes, std::size_t class_count) {
  Judged judged{classes, folds.fold_of, {}};
  judged.is_known.assign(folds.count, std::vector<std::uint8_t>(class_count, 0));
  for (std::size_t i = 0; i < classes.size(); ++i) {
    for (std::size_t fold = 0; fold < folds.count; ++fold) {
      if (folds.fold_of[i] != fold) judged.is_known[fold][classes[i]] = 1;
    }
  }
  return judged;
}

ExpertChoice choose_expert(const TrainingTable& table, const ExpertColumns& expert, const Folds& folds,
                           const Judged& judged) {
  const Path path = score_out_of_fold(table, expert, folds);
  ExpertChoice choice;
  double least = std::numeric_limits<double>::infinity();
  std::size_t best = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double sharpness = best_sharpness(judged, path[i]);
    const double loss = log_loss(judged, path[i], sharpness);
    if (!(loss < least)) continue;
    least = loss;
    best = i;
    choice.sharpness = sharpness;
  }
  choice.shrinkage = kShrinkages[best];
  choice.scores = choice.sharpness * path[best];
  return choice;
}

Matrix distances_out_of_fold(const TrainingTable& table, const ExpertColumns& expert, const Folds& folds,
                             double shrinkage) {
  Matrix all = Matrix::Zero(index(table.rows.size()), index(table.class_count));
  for (std::size_t fold = 0; fold < folds.count; ++fold) {
    const Lesson lesson = lesson_of(table, folds, fold);
    const Standardisation standardisation = standardisation_of(table.features, lesson.taught, expert.columns);
    if (lesson.asked.empty() || standardisation.columns.empty()) continue;
    const Discriminant discriminant = train_discriminant(standardised(table.features, lesson.taught, standardisation),
                                                         lesson.classes, table.class_count, shrinkage);
    const Matrix distances = discriminant.distances(standardised(table.features, lesson.asked, standardisation));
    for (std::size_t place = 0; place < lesson.places.size(); ++place) {
      all.row(index(lesson.places[place])) = distances.row(index(place));
    }
  }
  return all;
}

}  // namespace dermis::recognition
