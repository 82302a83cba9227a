// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace dermis::learn::recognition {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

[[nodiscard]] inline Eigen::Index index(std::size_t value) noexcept {
  return static_cast<Eigen::Index>(value);
}

}  // namespace dermis::learn::recognition
