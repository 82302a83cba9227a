// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/standard_errors.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::learn::calibration {

using Eigen::Index;

namespace {

/// The mean correlation of two of them.
double common_share(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd sigma = covariance.diagonal().cwiseSqrt();
  const double variances = covariance.trace();
  const double others = sigma.sum() * sigma.sum() - variances;
  return others > 0.0 ? std::clamp((covariance.sum() - variances) / others, 0.0, 1.0) : 0.0;
}

}  // namespace

StandardErrors standard_errors(const LineParameters& lines, const Eigen::VectorXd& parameters,
                               const Eigen::MatrixXd& covariance) {
  StandardErrors errors;
  errors.drive.assign(lines.array().readout.drive_ohm.size(), 0.0);
  errors.load.assign(lines.array().readout.load_ohm.size(), 0.0);
  if (!lines.drives().empty()) errors.drive_ohm.assign(errors.drive.size(), 0.0);
  Index p = 0;
  for (const std::size_t line : lines.drives()) {
    const double sigma = std::sqrt(covariance(p, p));
    errors.drive[line] = std::min(1.0, sigma / parameters[p]);
    errors.drive_ohm[line] = sigma * lines.reference_ohm();
    ++p;
  }
  for (const std::size_t line : lines.loads()) {
    errors.load[line] = std::min(1.0, std::sqrt(covariance(p, p)));
    ++p;
  }
  const Index drives = lines.drive_count();
  if (drives > 0) {
    const double sigma = std::sqrt(covariance.topLeftCorner(drives, drives).sum()) / static_cast<double>(drives);
    errors.common_drive = std::min(1.0, sigma / parameters.head(drives).mean());
    errors.correlation = common_share(covariance.topLeftCorner(drives, drives));
  }
  return errors;
}

}  // namespace dermis::learn::calibration
