// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/learning/expert_choice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "learn/recognition/answer/kernel_distance.hpp"
#include "learn/recognition/learning/kernel_regression.hpp"

namespace dermis::learn::recognition {
namespace {

constexpr std::array kNarrownesses{0.1, 0.3, 1.0, 3.0};
constexpr std::array kPenalties{0.005, 0.1};

/// Scores in the order of ways_of().
using Path = std::vector<Matrix>;

std::vector<LearningWay> ways_of(Estimator estimator, bool strays) {
  std::vector<LearningWay> ways;
  if (estimator == Estimator::discriminant) {
    for (const double shrinkage : kShrinkages) ways.push_back({strays, shrinkage, 0.0});
    return ways;
  }
  for (const double narrowness : kNarrownesses) {
    for (const double penalty : kPenalties) ways.push_back({false, penalty, narrowness});
  }
  return ways;
}

Path score_by_kernels(const Teaching& teaching, const Matrix& others) {
  const Matrix centres = centres_of(teaching);
  Path path;
  for (const double narrowness : kNarrownesses) {
    const double width = narrowness / static_cast<double>(centres.cols());
    const KernelEquations equations = equations_of(teaching, centres, width);
    const Matrix of_others = likeness(others, centres, width);
    for (const double penalty : kPenalties) path.emplace_back(of_others * influences_of(equations, penalty));
  }
  return path;
}

Path score_others(Estimator estimator, const Teaching& teaching, const Matrix& others) {
  if (estimator == Estimator::kernel) return score_by_kernels(teaching, others);
  std::array<Matrix, kShrinkages.size()> scores = score_others(teaching, others);
  return {std::make_move_iterator(scores.begin()), std::make_move_iterator(scores.end())};
}

/// The examples of one fold, and the others.
struct Parted {
  std::vector<std::size_t> taught;   ///< Rows of the features.
  std::vector<std::size_t> classes;  ///< Of those.
  std::vector<std::size_t> asked;    ///< Rows of the features.
  std::vector<std::size_t> places;   ///< Of those among the examples.
};

Parted part(const TrainingTable& table, const Folds& folds, std::size_t fold) {
  Parted parted;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (folds.fold_of[i] == fold) {
      parted.asked.push_back(table.rows[i]);
      parted.places.push_back(i);
    } else {
      parted.taught.push_back(table.rows[i]);
      parted.classes.push_back(table.classes[i]);
    }
  }
  return parted;
}

/// Scores of all examples, each by what the other folds taught.
Path score_out_of_fold(const TrainingTable& table, const ExpertColumns& expert, const Folds& folds, bool strays) {
  Path all(ways_of(expert.estimator, strays).size(), Matrix::Zero(index(table.rows.size()), index(table.class_count)));
  for (std::size_t fold = 0; fold < folds.count; ++fold) {
    const Parted parted = part(table, folds, fold);
    const Standardisation standardisation = standardisation_of(table.features, parted.taught, expert.columns);
    if (parted.asked.empty() || standardisation.columns.empty()) continue;
    const Path path =
        score_others(expert.estimator, teaching_of(table, parted.taught, parted.classes, standardisation, strays),
                     standardised(table.features, parted.asked, standardisation));
    for (std::size_t i = 0; i < path.size(); ++i) {
      for (std::size_t place = 0; place < parted.places.size(); ++place) {
        all[i].row(index(parted.places[place])) = path[i].row(index(place));
      }
    }
  }
  return all;
}

}  // namespace

Teaching teaching_of(const TrainingTable& table, const std::vector<std::size_t>& rows, std::vector<std::size_t> classes,
                     const Standardisation& standardisation, bool strays) {
  Teaching teaching{standardised(table.features, rows, standardisation), std::move(classes), table.class_count};
  if (!strays) return teaching;
  const Eigen::Index count = teaching.examples.rows();
  teaching.strays.resize(index(table.raised.size()) * count, teaching.examples.cols());
  const double share = 1.0 / std::sqrt(static_cast<double>(std::max<std::size_t>(table.raised.size(), 1)));
  for (std::size_t i = 0; i < table.raised.size(); ++i) {
    teaching.strays.middleRows(index(i) * count, count) =
        share * (standardised(table.raised[i], rows, standardisation) - teaching.examples);
  }
  return teaching;
}

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
                           const Judged& judged, bool strays) {
  strays = strays && expert.estimator == Estimator::discriminant;
  const Path path = score_out_of_fold(table, expert, folds, strays);
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
  choice.way = ways_of(expert.estimator, strays)[best];
  choice.scores = choice.sharpness * path[best];
  return choice;
}

Matrix distances_out_of_fold(const TrainingTable& table, const ExpertColumns& expert, const Folds& folds,
                             const ExpertChoice& choice) {
  if (expert.estimator == Estimator::kernel) return (choice.scores / choice.sharpness).unaryExpr(&kernel_distance);
  const LearningWay& way = choice.way;
  Matrix all = Matrix::Zero(index(table.rows.size()), index(table.class_count));
  for (std::size_t fold = 0; fold < folds.count; ++fold) {
    const Parted parted = part(table, folds, fold);
    const Standardisation standardisation = standardisation_of(table.features, parted.taught, expert.columns);
    if (parted.asked.empty() || standardisation.columns.empty()) continue;
    const Discriminant discriminant = train_discriminant(
        teaching_of(table, parted.taught, parted.classes, standardisation, way.strays), way.shrinkage);
    const Matrix distances = discriminant.distances(standardised(table.features, parted.asked, standardisation));
    for (std::size_t place = 0; place < parted.places.size(); ++place) {
      all.row(index(parted.places[place])) = distances.row(index(place));
    }
  }
  return all;
}

}  // namespace dermis::learn::recognition
