// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace dermis::touch::compensation {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

inline Eigen::Index at(std::size_t index) noexcept {
  return static_cast<Eigen::Index>(index);
}

}  // namespace dermis::touch::compensation
