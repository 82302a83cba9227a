// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/evaluation/coverage.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace dermis::learn::calibration {
namespace {

bool has_finite_sigma(const JudgedTaxel& taxel) {
  return std::isfinite(taxel.sigma_newtons);
}

}  // namespace

std::vector<double> covered_shares(std::span<const JudgedTaxel> taxels, std::span<const double> sigmas) {
  std::vector<double> shares(sigmas.size(), 0.0);
  double count = 0.0;
  for (const JudgedTaxel& taxel : taxels) {
    if (!has_finite_sigma(taxel)) continue;
    const double error = std::abs(static_cast<double>(taxel.newtons.front()) - taxel.true_newtons);
    for (std::size_t k = 0; k < sigmas.size(); ++k) {
      if (error <= sigmas[k] * static_cast<double>(taxel.sigma_newtons)) shares[k] += 1.0;
    }
    count += 1.0;
  }
  if (count == 0.0) return {};
  for (double& share : shares) share /= count;
  return shares;
}

Coverage coverage_of(std::span<const JudgedTaxel> taxels) {
  const std::vector<double> shares = covered_shares(taxels, std::array{kSigmas68, kSigmas95});
  Coverage coverage;
  if (shares.empty()) return coverage;
  coverage.count = static_cast<std::size_t>(std::count_if(taxels.begin(), taxels.end(), has_finite_sigma));
  coverage.share_68 = shares[0];
  coverage.share_95 = shares[1];
  return coverage;
}

}  // namespace dermis::learn::calibration
