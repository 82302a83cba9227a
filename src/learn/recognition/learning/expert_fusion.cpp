// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/learning/expert_fusion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "learn/recognition/answer/softmax.hpp"

namespace dermis::learn::recognition {
namespace {

constexpr double kWeightPenalty = 1e-3;
constexpr double kMostSharpness = 1e4;

/// softmax() of the scores of one example, among the known classes.
double softmax_of_known(const std::vector<std::uint8_t>& is_known, double* scores) {
  for (std::size_t i = 0; i < is_known.size(); ++i) {
    if (is_known[i] == 0) scores[i] = -std::numeric_limits<double>::infinity();
  }
  return softmax({scores, is_known.size()});
}

std::size_t counted(const Judged& judged) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < judged.classes.size(); ++i) count += judged.counts(i) ? 1 : 0;
  return std::max<std::size_t>(count, 1);
}

/// Objective, gradient and Hessian of the fusion at one point.
struct Expansion {
  double value = 0.0;
  Vector gradient;
  Eigen::MatrixXd hessian;
};

Expansion expand(const Judged& judged, const std::vector<Matrix>& scores, const Vector& weights) {
  const Eigen::Index experts = weights.size();
  const double share = 1.0 / static_cast<double>(counted(judged));
  Expansion result{kWeightPenalty * weights.squaredNorm(), 2.0 * kWeightPenalty * weights,
                   2.0 * kWeightPenalty * Eigen::MatrixXd::Identity(experts, experts)};
  Matrix of_example(experts, scores.front().cols());  // [experts, classes]
  Eigen::RowVectorXd probability(scores.front().cols());
  for (std::size_t i = 0; i < judged.classes.size(); ++i) {
    if (!judged.counts(i)) continue;
    for (Eigen::Index expert = 0; expert < experts; ++expert) {
      of_example.row(expert) = scores[static_cast<std::size_t>(expert)].row(index(i));
    }
    probability.noalias() = weights.transpose() * of_example;
    const Vector right = of_example.col(index(judged.classes[i]));
    const double right_score = weights.dot(right);
    result.value += share * (softmax_of_known(judged.is_known[judged.fold_of[i]], probability.data()) - right_score);
    const Vector mean = of_example * probability.transpose();
    result.gradient += share * (mean - right);
    result.hessian +=
        share * (of_example * probability.asDiagonal() * of_example.transpose() - mean * mean.transpose());
  }
  return result;
}

/// Newton's step on the weights that are not held at 0.
Vector newton_step(const Expansion& at, const Vector& weights) {
  std::vector<Eigen::Index> open;
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    if (weights(i) > 0.0 || at.gradient(i) < 0.0) open.push_back(i);
  }
  Vector step = Vector::Zero(weights.size());
  if (open.empty()) return step;
  const Eigen::MatrixXd hessian = at.hessian(open, open);
  const Vector gradient = at.gradient(open);
  step(open) = -hessian.ldlt().solve(gradient);
  return step;
}

struct Slope {
  double first = 0.0;
  double second = 0.0;
};

/// Derivatives of the log loss by the sharpness.
Slope slope_at(const Judged& judged, const Matrix& scores, double sharpness) {
  Slope slope;
  Eigen::RowVectorXd probability(scores.cols());
  for (std::size_t i = 0; i < judged.classes.size(); ++i) {
    if (!judged.counts(i)) continue;
    const auto row = scores.row(index(i));
    probability = sharpness * row;
    softmax_of_known(judged.is_known[judged.fold_of[i]], probability.data());
    const double mean = probability.dot(row);
    slope.first += mean - row(index(judged.classes[i]));
    slope.second += probability.dot(row.cwiseProduct(row)) - mean * mean;
  }
  return slope;
}

}  // namespace

void softmax(const Judged& judged, Matrix& scores) {
  for (Eigen::Index row = 0; row < scores.rows(); ++row) {
    softmax_of_known(judged.is_known[judged.fold_of[static_cast<std::size_t>(row)]], scores.row(row).data());
  }
}

double log_loss(const Judged& judged, const Matrix& scores, double sharpness) {
  double sum = 0.0;
  Eigen::RowVectorXd probability(scores.cols());
  for (std::size_t i = 0; i < judged.classes.size(); ++i) {
    if (!judged.counts(i)) continue;
    probability = sharpness * scores.row(index(i));
    const double right = probability(index(judged.classes[i]));
    sum += softmax_of_known(judged.is_known[judged.fold_of[i]], probability.data()) - right;
  }
  return sum / static_cast<double>(counted(judged));
}

/// Newton's method in the sharpness, at most by a factor of 3 a step; the log loss is convex in it.
double best_sharpness(const Judged& judged, const Matrix& scores) {
  constexpr int kMostSteps = 30;
  constexpr double kMostFactor = 3.0;
  constexpr double kEnough = 1e-3;
  double sharpness = 1.0;
  for (int step = 0; step < kMostSteps; ++step) {
    const Slope slope = slope_at(judged, scores, sharpness);
    const double wanted =
        slope.second > 0.0 ? sharpness - slope.first / slope.second : (slope.first < 0.0 ? kMostSharpness : 0.0);
    const double next = std::clamp(std::clamp(wanted, sharpness / kMostFactor, sharpness * kMostFactor),
                                   1.0 / kMostSharpness, kMostSharpness);
    const bool is_done = std::abs(next - sharpness) <= kEnough * sharpness;
    sharpness = next;
    if (is_done) break;
  }
  return sharpness;
}

std::vector<double> fuse(const Judged& judged, const std::vector<Matrix>& scores) {
  constexpr int kMostSteps = 50;
  constexpr int kMostHalvings = 20;
  constexpr double kEnough = 1e-9;
  Vector weights = Vector::Constant(index(scores.size()), 1.0 / static_cast<double>(scores.size()));
  Expansion at = expand(judged, scores, weights);
  for (int step = 0; step < kMostSteps; ++step) {
    const Vector direction = newton_step(at, weights);
    double length = 1.0;
    bool is_better = false;
    for (int halving = 0; halving < kMostHalvings && !is_better; ++halving, length *= 0.5) {
      const Vector moved = (weights + length * direction).cwiseMax(0.0);
      Expansion next = expand(judged, scores, moved);
      is_better = next.value < at.value - kEnough;
      if (!is_better) continue;
      weights = moved;
      at = std::move(next);
    }
    if (!is_better) break;
  }
  return {weights.begin(), weights.end()};
}

Matrix fused_scores(const std::vector<Matrix>& scores, const std::vector<double>& weights) {
  Matrix sum = weights.front() * scores.front();
  for (std::size_t expert = 1; expert < scores.size(); ++expert) sum += weights[expert] * scores[expert];
  return sum;
}

Matrix fused_out_of_fold(const Judged& judged, const std::vector<Matrix>& scores) {
  Matrix all(scores.front().rows(), scores.front().cols());
  for (std::size_t fold = 0; fold < judged.is_known.size(); ++fold) {
    Judged others = judged;
    for (std::size_t i = 0; i < judged.fold_of.size(); ++i) {
      if (judged.fold_of[i] == fold) others.is_known[fold][others.classes[i]] = 0;  // counts no more
    }
    const Matrix fused = fused_scores(scores, fuse(others, scores));
    for (std::size_t i = 0; i < judged.fold_of.size(); ++i) {
      if (judged.fold_of[i] == fold) all.row(index(i)) = fused.row(index(i));
    }
  }
  return all;
}

}  // namespace dermis::learn::recognition
