// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/features/standardisation.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::learn::recognition {

Standardisation standardisation_of(const Matrix& features, const std::vector<std::size_t>& rows,
                                   const std::vector<std::size_t>& columns) {
  constexpr double kLeastSpread = 1e-6;  // of the mean, which is kept as a float: below, a column is constant
  const auto count = static_cast<double>(rows.size());
  Standardisation standardisation;
  for (const std::size_t column : columns) {
    const auto value = [&](std::size_t row) {
      return features(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
    };
    double mean = 0.0;
    for (const std::size_t row : rows) mean += value(row) / count;
    double variance = 0.0;
    for (const std::size_t row : rows) variance += (value(row) - mean) * (value(row) - mean) / count;
    const double deviation = std::sqrt(variance);
    if (!(deviation > kLeastSpread * (1.0 + std::abs(mean)))) continue;
    standardisation.columns.push_back(column);
    standardisation.mean.push_back(mean);
    standardisation.scale.push_back(1.0 / deviation);
  }
  return standardisation;
}

Matrix standardised(const Matrix& features, const std::vector<std::size_t>& rows,
                    const Standardisation& standardisation) {
  Matrix result(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(standardisation.columns.size()));
  for (Eigen::Index row = 0; row < result.rows(); ++row) {
    const auto from = features.row(static_cast<Eigen::Index>(rows[static_cast<std::size_t>(row)]));
    for (std::size_t i = 0; i < standardisation.columns.size(); ++i) {
      const double value = from(static_cast<Eigen::Index>(standardisation.columns[i]));
      const double deviations = (value - standardisation.mean[i]) * standardisation.scale[i];
      result(row, static_cast<Eigen::Index>(i)) = std::clamp(deviations, -kMostDeviations, kMostDeviations);
    }
  }
  return result;
}

}  // namespace dermis::learn::recognition
