// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/evaluation/error_summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::calibration {

double relative_error(double estimate, double truth) {
  return std::abs(estimate / truth - 1.0);
}

std::optional<double> root_mean_square(const std::vector<double>& errors) {
  if (errors.empty()) return std::nullopt;
  double square = 0.0;
  for (const double error : errors) square += error * error;
  return std::sqrt(square / static_cast<double>(errors.size()));
}

ErrorSummary summarise(std::vector<double> errors) {
  ErrorSummary summary;
  summary.count = errors.size();
  if (errors.empty()) return summary;
  for (double& error : errors) {
    if (std::isnan(error)) error = std::numeric_limits<double>::infinity();
  }
  std::sort(errors.begin(), errors.end());
  const auto percentile = [&](double share) { return errors[nearest_rank(errors.size(), share)]; };
  summary.median = percentile(0.50);
  summary.p95 = percentile(0.95);
  summary.p99 = percentile(0.99);
  summary.max = errors.back();
  return summary;
}

}  // namespace dermis::learn::calibration
