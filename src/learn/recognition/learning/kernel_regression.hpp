// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>

#include "learn/recognition/learning/discriminant.hpp"

/// Regression of the classes on kernels exp(-width |z - c|^2): docs/reasons/recognition.md, eq. (7).
namespace dermis::learn::recognition {

/// A kernel regression has no more centres.
inline constexpr std::size_t kMostCentres = 512;

struct KernelRegression {
  Matrix centres;     ///< [centres, columns]
  Matrix influences;  ///< [centres, classes]
};

/// All examples, or kMostCentres of them, which are as many of each class as its share.
[[nodiscard]] Matrix centres_of(const Teaching& teaching);

/// [others, centres] exp(-width |z - c|^2)
[[nodiscard]] Matrix likeness(const Matrix& others, const Matrix& centres, double width);

/// (square + penalty penalised) influences = right. Every class is as heavy as the others.
struct KernelEquations {
  Eigen::MatrixXd square;     ///< [centres, centres]
  Eigen::MatrixXd penalised;  ///< [centres, centres]
  Matrix right;               ///< [centres, classes]
};

/// `centres`: as centres_of() has them.
[[nodiscard]] KernelEquations equations_of(const Teaching& teaching, const Matrix& centres, double width);

/// [centres, classes]
[[nodiscard]] Matrix influences_of(const KernelEquations& equations, double penalty);

[[nodiscard]] KernelRegression train_kernels(const Teaching& teaching, double width, double penalty);

}  // namespace dermis::learn::recognition
