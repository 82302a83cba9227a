// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/learning/expert_fusion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "dermis/touch/frames/random.hpp"

namespace dermis::learn::recognition {
namespace {

constexpr std::size_t kExamples = 400;
constexpr std::size_t kClasses = 3;

Judged judged_examples() {
  Judged judged;
  for (std::size_t i = 0; i < kExamples; ++i) judged.classes.push_back(i % kClasses);
  judged.fold_of.assign(kExamples, 0);
  judged.is_known.assign(1, std::vector<std::uint8_t>(kClasses, 1));
  return judged;
}

/// Scores that favour the right class by so much on average.
Matrix scores_of(double advantage, std::uint64_t seed) {
  Random random(seed);
  Matrix scores(static_cast<Eigen::Index>(kExamples), static_cast<Eigen::Index>(kClasses));
  for (Eigen::Index row = 0; row < scores.rows(); ++row) {
    for (Eigen::Index label = 0; label < scores.cols(); ++label) {
      scores(row, label) = random.normal() + (row % scores.cols() == label ? advantage : 0.0);
    }
  }
  return scores;
}

double objective(const Judged& judged, const std::vector<Matrix>& scores, const std::vector<double>& weights) {
  double sum = log_loss(judged, fused_scores(scores, weights), 1.0);
  for (const double weight : weights) sum += 1e-3 * weight * weight;
  return sum;
}

TEST(Fusion, finds_the_least_log_loss) {
  const Judged judged = judged_examples();
  const std::vector<Matrix> scores{scores_of(1.0, 1), scores_of(2.0, 2), scores_of(0.5, 3)};
  const std::vector<double> weights = fuse(judged, scores);
  const double least = objective(judged, scores, weights);
  for (std::size_t expert = 0; expert < weights.size(); ++expert) {
    for (const double step : {-0.01, 0.01}) {
      std::vector<double> moved = weights;
      moved[expert] = std::max(moved[expert] + step, 0.0);
      EXPECT_GE(objective(judged, scores, moved), least - 1e-9) << expert;
    }
  }
  EXPECT_GT(weights[1], weights[0]);
}

TEST(Fusion, out_of_fold_takes_the_weights_that_suit_the_other_folds) {
  Judged judged = judged_examples();
  for (std::size_t i = 0; i < kExamples; ++i) judged.fold_of[i] = i < kExamples / 2 ? 0 : 1;
  judged.is_known.assign(2, std::vector<std::uint8_t>(kClasses, 1));
  const std::vector<Matrix> scores{scores_of(1.0, 1), scores_of(2.0, 2)};
  const Matrix fused = fused_out_of_fold(judged, scores);
  for (std::size_t fold = 0; fold < 2; ++fold) {
    Judged others = judged_examples();
    std::vector<Matrix> of_others;
    const Eigen::Index half = index(kExamples / 2);
    const Eigen::Index first = fold == 0 ? half : 0;
    for (const Matrix& all : scores) of_others.emplace_back(all.middleRows(first, half));
    others.classes.assign(judged.classes.begin() + first, judged.classes.begin() + first + half);
    others.fold_of.resize(kExamples / 2);
    const Matrix expected = fused_scores(scores, fuse(others, of_others)).middleRows(half - first, half);
    EXPECT_TRUE(fused.middleRows(half - first, half).isApprox(expected, 1e-6)) << fold;
  }
}

TEST(Fusion, gives_no_weight_to_an_expert_that_is_wrong) {
  const Judged judged = judged_examples();
  const std::vector<double> weights = fuse(judged, {scores_of(2.0, 4), scores_of(-1.0, 5)});
  EXPECT_GT(weights[0], 0.5);
  EXPECT_EQ(weights[1], 0.0);
}

TEST(Fusion, does_not_judge_by_a_class_that_was_not_known) {
  Judged judged = judged_examples();
  judged.is_known[0][2] = 0;
  Matrix scores = scores_of(1.0, 6);
  const double before = log_loss(judged, scores, 1.0);
  scores.col(2).setConstant(100.0);
  EXPECT_EQ(log_loss(judged, scores, 1.0), before);
  softmax(judged, scores);
  EXPECT_EQ(scores.col(2).norm(), 0.0);
  EXPECT_NEAR(scores.row(0).sum(), 1.0, 1e-12);
}

TEST(Sharpness, is_that_of_the_least_log_loss) {
  const Judged judged = judged_examples();
  const Matrix scores = 20.0 * scores_of(1.5, 7);
  const double sharpness = best_sharpness(judged, scores);
  EXPECT_LT(log_loss(judged, scores, sharpness), log_loss(judged, scores, 0.95 * sharpness));
  EXPECT_LT(log_loss(judged, scores, sharpness), log_loss(judged, scores, 1.05 * sharpness));
}

TEST(Sharpness, is_bounded_where_all_answers_are_right) {
  const Judged judged = judged_examples();
  const double sharpness = best_sharpness(judged, scores_of(1000.0, 8));
  EXPECT_TRUE(std::isfinite(sharpness));
}

}  // namespace
}  // namespace dermis::learn::recognition
