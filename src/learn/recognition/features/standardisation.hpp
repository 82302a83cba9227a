// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "learn/recognition/matrix.hpp"

namespace dermis::learn::recognition {

/// A standardised feature goes no further than this from 0.
inline constexpr double kMostDeviations = 4.0;

/// Which features an expert takes, and their mean and spread among the examples.
struct Standardisation {
  std::vector<std::size_t> columns;  ///< Those that are not the same in all examples.
  std::vector<double> mean;          ///< [columns]
  std::vector<double> scale;         ///< [columns] 1 / standard deviation
};

/// `features`: [segments, features]; `rows`: the examples.
[[nodiscard]] Standardisation standardisation_of(const Matrix& features, const std::vector<std::size_t>& rows,
                                                 const std::vector<std::size_t>& columns);

/// [rows, columns] clip((x - mean) / deviation, +- 4)
[[nodiscard]] Matrix standardised(const Matrix& features, const std::vector<std::size_t>& rows,
                                  const Standardisation& standardisation);

}  // namespace dermis::learn::recognition
