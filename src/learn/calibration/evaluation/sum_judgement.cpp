// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/evaluation/sum_judgement.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "learn/calibration/evaluation/coverage.hpp"

namespace dermis::learn::calibration {
namespace {

/// The load on the taxels that have a force; empty where some of it is not known.
std::optional<double> true_sum(const Sample& truth, const ForceFrame& force) {
  std::vector<bool> is_known(truth.known_newtons.size());
  double sum = 0.0;
  for (const TotalForce& total : truth.totals) {
    sum += total.newtons;
    for (const std::size_t taxel : total.taxels) {
      if (is_known[taxel] || std::isnan(force.newtons[taxel])) return std::nullopt;
      is_known[taxel] = true;
    }
  }
  for (std::size_t taxel = 0; taxel < is_known.size(); ++taxel) {
    if (is_known[taxel] || std::isnan(force.newtons[taxel])) continue;
    const double newtons = truth.known_newtons[taxel];
    if (std::isnan(newtons)) return std::nullopt;
    sum += newtons;
  }
  return sum;
}

template <typename Judged>
double share_within(const std::vector<Judged>& sums, double sigmas) {
  const auto within = std::count_if(sums.begin(), sums.end(), [&](const Judged& sum) {
    return std::abs(sum.newtons - sum.true_newtons) <= sigmas * sum.sigma_newtons;
  });
  return static_cast<double>(within) / static_cast<double>(sums.size());
}

}  // namespace

void SumJudgement::add(const Sample& truth, const ForceFrame& force) {
  const std::optional<double> newtons = true_sum(truth, force);
  const auto total = force.total();
  if (!newtons || !std::isfinite(total.sigma_newtons)) return;
  (*newtons > 0.0 ? touched_ : untouched_).push_back({*newtons, total.newtons, total.sigma_newtons});
}

SumErrors SumJudgement::errors() const {
  SumErrors errors;
  errors.touched = touched_.size();
  errors.untouched = untouched_.size();
  if (!untouched_.empty()) {
    double sum = 0.0;
    for (const Judged& judged : untouched_) sum += judged.newtons;
    errors.untouched_mean_n = sum / static_cast<double>(untouched_.size());
    errors.untouched_within_2_sigma = share_within(untouched_, 2.0);
  }
  if (!touched_.empty()) {
    double error = 0.0;
    double load = 0.0;
    for (const Judged& judged : touched_) {
      error += judged.newtons - judged.true_newtons;
      load += judged.true_newtons;
    }
    errors.relative_bias = error / load;
    errors.share_68 = share_within(touched_, kSigmas68);
    errors.share_95 = share_within(touched_, kSigmas95);
  }
  return errors;
}

}  // namespace dermis::learn::calibration
