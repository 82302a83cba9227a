// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace dermis::touch::compensation {

/// Linear equations whose matrix is known by its products only: GMRES (Saad and Schultz, 1986), restarted.
class KrylovSolver {
 public:
  explicit KrylovSolver(std::size_t size)
      : size_(static_cast<Eigen::Index>(size)),
        steps_(std::min(kBasis, size_)),
        basis_(steps_ + 1, size_),
        triangle_(steps_ + 1, steps_),
        residual_(steps_ + 1),
        cosine_(steps_),
        sine_(steps_) {}

  /// product(x, y): y = matrix x. Starts from 0 and ends once |right - matrix solution| <= tolerance |right|, once a
  /// round no longer halves what is left.
  template <class Product>
  void solve(const Product& product, std::span<const double> right, std::span<double> solution,
             double tolerance) noexcept {
    const Vector b(right.data(), size_);
    Eigen::Map<Eigen::VectorXd> x(solution.data(), size_);
    x.setZero();
    const double goal = tolerance * b.norm();
    basis_.row(0) = b.transpose();
    double before = std::numeric_limits<double>::infinity();
    for (int round = 0; round < kRestarts; ++round) {
      if (round > 0) {
        product(solution, row(0));
        basis_.row(0) = b.transpose() - basis_.row(0);
      }
      const double length = basis_.row(0).norm();
      if (!(length > goal) || !(length < 0.5 * before)) return;
      before = length;
      basis_.row(0) /= length;
      residual_.setZero();
      residual_(0) = length;
      const Eigen::Index steps = extend_basis(product, goal);
      for (Eigen::Index k = steps; k-- > 0;) {
        double sum = residual_(k);
        for (Eigen::Index j = k + 1; j < steps; ++j) sum -= triangle_(k, j) * residual_(j);
        residual_(k) = sum / triangle_(k, k);
        x += residual_(k) * basis_.row(k).transpose();
      }
    }
  }

 private:
  using Vector = Eigen::Map<const Eigen::VectorXd>;
  static constexpr Eigen::Index kBasis = 100;
  static constexpr int kRestarts = 4;

  std::span<double> row(Eigen::Index k) noexcept {
    return {basis_.data() + k * size_, static_cast<std::size_t>(size_)};
  }

  /// Arnoldi's process with the least-squares problem kept triangular by Givens rotations. Returns the number of steps.
  template <class Product>
  Eigen::Index extend_basis(const Product& product, double goal) noexcept {
    for (Eigen::Index k = 0; k < steps_; ++k) {
      product(std::span<const double>(row(k)), row(k + 1));
      auto next = basis_.row(k + 1);
      for (Eigen::Index j = 0; j <= k; ++j) {
        triangle_(j, k) = next.dot(basis_.row(j));
        next -= triangle_(j, k) * basis_.row(j);
      }
      const double length = next.norm();
      for (Eigen::Index j = 0; j < k; ++j) rotate(j, triangle_(j, k), triangle_(j + 1, k));
      const double diagonal = std::hypot(triangle_(k, k), length);
      if (!(diagonal > 0.0)) return k;
      cosine_(k) = triangle_(k, k) / diagonal;
      sine_(k) = length / diagonal;
      triangle_(k, k) = diagonal;
      rotate(k, residual_(k), residual_(k + 1));
      if (!(std::abs(residual_(k + 1)) > goal) || !(length > 0.0)) return k + 1;
      next /= length;
    }
    return steps_;
  }

  void rotate(Eigen::Index k, double& upper, double& lower) const noexcept {
    const double kept = cosine_(k) * upper + sine_(k) * lower;
    lower = cosine_(k) * lower - sine_(k) * upper;
    upper = kept;
  }

  Eigen::Index size_;
  Eigen::Index steps_;  // of a round
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> basis_;
  Eigen::MatrixXd triangle_;
  Eigen::VectorXd residual_;
  Eigen::VectorXd cosine_;
  Eigen::VectorXd sine_;
};

}  // namespace dermis::touch::compensation
