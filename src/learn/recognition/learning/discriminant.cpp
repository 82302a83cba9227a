// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/learning/discriminant.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace dermis::learn::recognition {
namespace {

constexpr double kNegligible = 1e-10;  // of the largest eigenvalue

/// [classes, columns]; 0 for classes without an example.
Matrix class_means(const Teaching& teaching) {
  Matrix means = Matrix::Zero(index(teaching.class_count), teaching.examples.cols());
  Vector counts = Vector::Zero(index(teaching.class_count));
  for (std::size_t row = 0; row < teaching.classes.size(); ++row) {
    means.row(index(teaching.classes[row])) += teaching.examples.row(index(row));
    counts(index(teaching.classes[row])) += 1.0;
  }
  for (Eigen::Index label = 0; label < means.rows(); ++label) means.row(label) /= std::max(counts(label), 1.0);
  return means;
}

/// The examples without the means of their classes, and the strays, scaled so that W is transposed() * itself.
Matrix within_classes(const Teaching& teaching, const Matrix& means) {
  const Eigen::Index examples = teaching.examples.rows();
  Matrix within(examples + teaching.strays.rows(), teaching.examples.cols());
  within.topRows(examples) = teaching.examples;
  for (std::size_t row = 0; row < teaching.classes.size(); ++row) {
    within.row(index(row)) -= means.row(index(teaching.classes[row]));
  }
  if (teaching.strays.rows() > 0) within.bottomRows(teaching.strays.rows()) = teaching.strays;
  std::vector<std::size_t> present = teaching.classes;
  std::sort(present.begin(), present.end());
  const auto kinds = std::unique(present.begin(), present.end()) - present.begin();
  const Eigen::Index freedom = std::max<Eigen::Index>(examples - static_cast<Eigen::Index>(kinds), 1);
  return within / std::sqrt(static_cast<double>(freedom));
}

/// Eigenvectors of W whose eigenvalue is not 0, [columns, vectors], and those values.
struct Basis {
  Matrix vectors;
  Vector values;
};

Basis basis_of(const Matrix& within) {
  const bool is_wide = within.cols() > within.rows();  // then the Gram matrix of the examples is the smaller one
  Eigen::MatrixXd square(is_wide ? within.rows() : within.cols(), is_wide ? within.rows() : within.cols());
  if (is_wide) {
    square.noalias() = within * within.transpose();
  } else {
    square.noalias() = within.transpose() * within;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(square);
  const Vector& all = solver.eigenvalues();  // rising
  const double least = kNegligible * std::max(all(all.size() - 1), 0.0);
  Eigen::Index first = 0;
  while (first < all.size() && !(all(first) > least)) ++first;
  const Eigen::Index count = all.size() - first;
  Basis basis{solver.eigenvectors().rightCols(count), all.tail(count)};
  if (is_wide) {
    basis.vectors = within.transpose() * basis.vectors * basis.values.cwiseSqrt().cwiseInverse().asDiagonal();
  }
  return basis;
}

double mean_variance(const Matrix& within) {
  const double trace = within.squaredNorm();
  return std::max(trace, kNegligible) / static_cast<double>(std::max<Eigen::Index>(within.cols(), 1));
}

/// Points in the basis, and what of their products is outside of it.
struct Projections {
  Matrix others;    ///< [others, vectors]
  Matrix means;     ///< [classes, vectors]
  Matrix products;  ///< [others, classes] outside of the basis
  Vector of_means;  ///< squared lengths of the means outside of the basis
};

Projections project(const Basis& basis, const Matrix& others, const Matrix& means) {
  Projections result;
  result.others.noalias() = others * basis.vectors;
  result.means.noalias() = means * basis.vectors;
  result.products.noalias() = others * means.transpose();
  result.products.noalias() -= result.others * result.means.transpose();
  result.of_means = (means.rowwise().squaredNorm() - result.means.rowwise().squaredNorm()).cwiseMax(0.0);
  return result;
}

/// x' C^-1 m - m' C^-1 m / 2 for C = (1 - a) W + a t I.
Matrix scores_of(const Projections& points, const Vector& values, double shrinkage, double variance) {
  const double outside = 1.0 / (shrinkage * variance);
  const Vector inverse = ((1.0 - shrinkage) * values.array() + shrinkage * variance).inverse();
  const Matrix scaled_means = points.means * inverse.asDiagonal();
  const Vector of_means = scaled_means.cwiseProduct(points.means).rowwise().sum() + outside * points.of_means;
  Matrix scores = points.others * scaled_means.transpose();
  scores += outside * points.products;
  scores.rowwise() -= 0.5 * of_means.transpose();
  return scores;
}

/// Axes of the space that the means span, y = l^-1/2 V' M C^-1 z. With C = L L', V are eigenvectors of M C^-1 M', and l
/// their values. Where there are more classes than columns it is the whole space.
Discriminant spanned(const Eigen::LLT<Eigen::MatrixXd>& cholesky, const Matrix& means) {
  Discriminant result;
  if (means.rows() >= means.cols()) {
    result.axes = cholesky.matrixL().solve(Eigen::MatrixXd::Identity(means.cols(), means.cols()));
    result.means.noalias() = means * result.axes.transpose();
    return result;
  }
  constexpr double kLeastShare = 1e-6;  // of the largest: below, a direction is that of rounding
  const Eigen::MatrixXd solved = cholesky.solve(means.transpose());  // C^-1 M'
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(means * solved);
  const Vector& all = solver.eigenvalues();  // rising
  const double least = kLeastShare * all(all.size() - 1);
  Eigen::Index first = 0;
  while (first + 1 < all.size() && !(all(first) > least)) ++first;
  const Eigen::Index rank = all.size() - first;
  const Vector roots = all.tail(rank).cwiseMax(kNegligible).cwiseSqrt();
  const Eigen::MatrixXd vectors = solver.eigenvectors().rightCols(rank);
  result.axes = roots.cwiseInverse().asDiagonal() * (vectors.transpose() * solved.transpose());
  result.means = vectors * roots.asDiagonal();
  return result;
}

}  // namespace

std::array<Matrix, kShrinkages.size()> score_others(const Teaching& teaching, const Matrix& others) {
  const Matrix means = class_means(teaching);
  const Matrix within = within_classes(teaching, means);
  const Basis basis = basis_of(within);
  const Projections points = project(basis, others, means);
  const double variance = mean_variance(within);
  std::array<Matrix, kShrinkages.size()> scores;
  for (std::size_t i = 0; i < kShrinkages.size(); ++i) {
    scores[i] = scores_of(points, basis.values, kShrinkages[i], variance);
  }
  return scores;
}

Matrix Discriminant::distances(const Matrix& others) const {
  const Matrix places = others * axes.transpose();
  Matrix squares = -2.0 * places * means.transpose();
  squares.colwise() += places.rowwise().squaredNorm();
  squares.rowwise() += means.rowwise().squaredNorm().transpose();
  return squares.cwiseMax(0.0).cwiseSqrt();
}

Discriminant train_discriminant(const Teaching& teaching, double shrinkage) {
  const Matrix means = class_means(teaching);
  const Matrix within = within_classes(teaching, means);
  Eigen::MatrixXd covariance(within.cols(), within.cols());
  covariance.noalias() = (1.0 - shrinkage) * within.transpose() * within;
  covariance.diagonal().array() += shrinkage * mean_variance(within);
  return spanned(Eigen::LLT<Eigen::MatrixXd>(covariance), means);
}

}  // namespace dermis::learn::recognition
