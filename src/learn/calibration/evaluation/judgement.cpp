// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/evaluation/judgement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "dermis/touch/frames/mean_celsius.hpp"
#include "learn/calibration/evaluation/contact_count.hpp"
#include "learn/calibration/evaluation/error_summary.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::array kReleaseSeconds{0.0, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 1e6};

bool is_unloaded(const Sample& truth) {
  return truth.totals.empty() && std::all_of(truth.known_newtons.begin(), truth.known_newtons.end(),
                                             [](float newtons) { return newtons == 0.0F; });
}

void add_taxels(std::size_t frame, const RawFrame& raw, const Sample& truth, const EstimatorRow& row,
                Judgement& judgement) {
  const ArrayDescription& array = row.array();
  const std::size_t contacts = count_contacts(truth.known_newtons, array.rows, array.cols);
  for (std::size_t taxel = 0; taxel < truth.known_newtons.size(); ++taxel) {
    const double newtons = truth.known_newtons[taxel];
    if (!std::isnan(newtons)) judgement.clocks[taxel].add(raw.time, newtons);
    if (newtons == 0.0) {
      const std::optional<double> seconds = judgement.clocks[taxel].seconds_since_release();
      if (seconds) judgement.after_release.add(*seconds, row.newtons(), taxel);
      for (std::size_t k = 0; k < row.newtons().size(); ++k) {
        const float ghost = row.newtons()[k][taxel];
        if (!std::isnan(ghost)) judgement.ghost_n[k].push_back(ghost);  // no force is no ghost
      }
    } else if (newtons >= row.judged_from_n()) {
      JudgedTaxel judged{frame, taxel, newtons, mean_celsius(raw), raw.supply_v, contacts, {}, 0.0F};
      for (const std::vector<float>& forces : row.newtons()) judged.newtons.push_back(forces[taxel]);
      judged.sigma_newtons = row.force().sigma_newtons[taxel];
      judged.touch = judgement.clocks[taxel].touch();
      judgement.taxels.push_back(std::move(judged));
    }
  }
}

void add_totals(std::size_t frame, const RawFrame& raw, const Sample& truth, const EstimatorRow& row,
                Judgement& judgement) {
  const bool is_only_one = truth.totals.size() == 1;
  if (is_only_one) judgement.total_clock.add(raw.time, truth.totals.front().newtons);
  if (is_unloaded(truth)) judgement.total_clock.add(raw.time, 0.0);
  for (const TotalForce& total : truth.totals) {
    JudgedTotal judged{frame, total.newtons, mean_celsius(raw), {}};
    if (is_only_one) judged.touch = judgement.total_clock.touch();
    const auto of_dermis = row.force().total(total.taxels);
    judged.newtons.push_back(of_dermis.left_out < total.taxels.size() ? of_dermis.newtons : 0.0);
    for (std::size_t k = 1; k < row.newtons().size(); ++k) {
      const std::vector<float>& forces = row.newtons()[k];
      double sum = 0.0;
      for (const std::size_t taxel : total.taxels) {
        const auto newtons = static_cast<double>(forces[taxel]);
        if (!std::isnan(newtons)) sum += newtons;  // a dead taxel carries what it carries: the total is short of it
      }
      judged.newtons.push_back(sum);
    }
    judgement.totals.push_back(std::move(judged));
  }
}

}  // namespace

void ReleaseGhosts::add(double seconds, const std::vector<std::vector<float>>& newtons, std::size_t taxel) {
  const auto above = std::upper_bound(kReleaseSeconds.begin(), kReleaseSeconds.end() - 1, seconds);
  std::vector<std::vector<double>>& bin = newtons_[static_cast<std::size_t>(above - kReleaseSeconds.begin() - 1)];
  bin.resize(newtons.size());
  for (std::size_t k = 0; k < newtons.size(); ++k) {
    if (!std::isnan(newtons[k][taxel])) bin[k].push_back(newtons[k][taxel]);
  }
}

std::vector<ReleaseBin> ReleaseGhosts::bins() const {
  std::vector<ReleaseBin> bins;
  for (const auto& [bin, newtons] : newtons_) {
    bins.push_back({kReleaseSeconds[bin], kReleaseSeconds[bin + 1], {}});
    for (const std::vector<double>& of_estimator : newtons) bins.back().ghost_n.push_back(summarise(of_estimator));
  }
  return bins;
}

void Judgement::add(std::size_t frame, const RawFrame& raw, const Sample& truth, const EstimatorRow& row) {
  add_taxels(frame, raw, truth, row, *this);
  add_totals(frame, raw, truth, row, *this);
}

EstimatorResult Judgement::result(std::size_t estimator, std::string name) const {
  std::vector<double> of_taxels;
  for (const JudgedTaxel& taxel : taxels) {
    of_taxels.push_back(relative_error(static_cast<double>(taxel.newtons[estimator]), taxel.true_newtons));
  }
  std::vector<double> of_totals_n;
  std::vector<double> of_totals;
  for (const JudgedTotal& total : totals) {
    of_totals_n.push_back(total.newtons[estimator] - total.true_newtons);
    of_totals.push_back(relative_error(total.newtons[estimator], total.true_newtons));
  }
  EstimatorResult result;
  result.name = std::move(name);
  result.relative_error = summarise(std::move(of_taxels));
  result.ghost_n = summarise(ghost_n[estimator]);
  result.totals_judged = totals.size();
  result.total_rmse_n = root_mean_square(of_totals_n);
  result.total_relative_error = summarise(std::move(of_totals));
  return result;
}

}  // namespace dermis::learn::calibration
