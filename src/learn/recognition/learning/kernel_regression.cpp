// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/learning/kernel_regression.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace dermis::learn::recognition {
namespace {

/// [examples] that give each class the same sum; of mean 1.
Vector even_weights(const Teaching& teaching) {
  std::vector<double> counts(teaching.class_count, 0.0);
  for (const std::size_t label : teaching.classes) counts[label] += 1.0;
  const auto present = std::count_if(counts.begin(), counts.end(), [](double count) { return count > 0.0; });
  const double share = static_cast<double>(teaching.classes.size()) / static_cast<double>(present);
  Vector weights(index(teaching.classes.size()));
  for (std::size_t i = 0; i < teaching.classes.size(); ++i) weights(index(i)) = share / counts[teaching.classes[i]];
  return weights;
}

/// [examples, classes] 1 for the class of an example and 0 for others, less the mean.
Matrix targets_of(const Teaching& teaching) {
  const double mean = 1.0 / static_cast<double>(teaching.class_count);
  Matrix targets = Matrix::Constant(index(teaching.classes.size()), index(teaching.class_count), -mean);
  for (std::size_t i = 0; i < teaching.classes.size(); ++i) targets(index(i), index(teaching.classes[i])) += 1.0;
  return targets;
}

}  // namespace

Matrix centres_of(const Teaching& teaching) {
  const std::size_t examples = teaching.classes.size();
  if (examples <= kMostCentres) return teaching.examples;
  std::vector<Eigen::Index> by_class(examples);
  std::iota(by_class.begin(), by_class.end(), Eigen::Index{0});
  std::stable_sort(by_class.begin(), by_class.end(), [&](Eigen::Index a, Eigen::Index b) {
    return teaching.classes[static_cast<std::size_t>(a)] < teaching.classes[static_cast<std::size_t>(b)];
  });
  std::vector<Eigen::Index> chosen;
  for (std::size_t i = 0; i < kMostCentres; ++i) chosen.push_back(by_class[i * examples / kMostCentres]);
  return teaching.examples(chosen, Eigen::all);
}

Matrix likeness(const Matrix& others, const Matrix& centres, double width) {
  Matrix squares = -2.0 * others * centres.transpose();
  squares.colwise() += others.rowwise().squaredNorm();
  squares.rowwise() += centres.rowwise().squaredNorm().transpose();
  return (-width * squares.array().max(0.0)).exp();
}

/// With all examples as centres (K + penalty / weights) influences = targets; else the same by least squares.
KernelEquations equations_of(const Teaching& teaching, const Matrix& centres, double width) {
  constexpr double kJitter = 1e-9;
  const Vector weights = even_weights(teaching);
  const Matrix targets = targets_of(teaching);
  const Matrix of_centres = likeness(centres, centres, width);
  if (centres.rows() == teaching.examples.rows()) {
    return {of_centres, Eigen::MatrixXd(weights.cwiseInverse().asDiagonal()), targets};
  }
  const Matrix of_examples = likeness(teaching.examples, centres, width);
  const Eigen::MatrixXd weighted = weights.cwiseSqrt().asDiagonal() * of_examples;
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(centres.rows(), centres.rows());
  square.diagonal().setConstant(kJitter * static_cast<double>(of_examples.rows()));
  square.selfadjointView<Eigen::Lower>().rankUpdate(weighted.transpose());
  return {square, of_centres, of_examples.transpose() * (weights.asDiagonal() * targets)};
}

Matrix influences_of(const KernelEquations& equations, double penalty) {
  return Eigen::LLT<Eigen::MatrixXd>(equations.square + penalty * equations.penalised).solve(equations.right);
}

KernelRegression train_kernels(const Teaching& teaching, double width, double penalty) {
  Matrix centres = centres_of(teaching);
  Matrix influences = influences_of(equations_of(teaching, centres, width), penalty);
  return {std::move(centres), std::move(influences)};
}

}  // namespace dermis::learn::recognition
