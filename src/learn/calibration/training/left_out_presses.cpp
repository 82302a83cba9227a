// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/training/left_out_presses.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/touch/frames/random.hpp"
#include "learn/calibration/labels/press_numbers.hpp"
#include "learn/calibration/training/force_levels.hpp"

namespace dermis::learn::calibration {
namespace {

using Points = std::span<const TaxelPoint>;

constexpr std::size_t kFolds = 10;
constexpr double kMostError = 1.0;  // counts as this: a single wild one decides nothing
constexpr double kMostLeverage = 0.95;

/// The errors of the networks on one taxel, by rising sample.
using NetworkErrors = std::vector<const TestedLoad*>;

std::vector<NetworkErrors> errors_by_taxel(const ForceTraining& training) {
  std::vector<NetworkErrors> errors(training.networks.taxel_count());
  for (const std::vector<TestedLoad>* loads : {&training.tested_own, &training.tested_shared}) {
    for (const TestedLoad& load : *loads) {
      if (load.taxels.size() == 1) errors[load.taxels.front()].push_back(&load);
    }
  }
  for (NetworkErrors& of_taxel : errors) {
    std::stable_sort(of_taxel.begin(), of_taxel.end(),
                     [](const auto* a, const auto* b) { return a->sample < b->sample; });
  }
  return errors;
}

std::vector<Points> split_presses(Points points) {
  std::vector<Points> presses;
  for (std::size_t first = 0; first < points.size();) {
    std::size_t last = first + 1;
    while (last < points.size() && points[last].press == points[first].press) ++last;
    presses.push_back(points.subspan(first, last - first));
    first = last;
  }
  return presses;
}

/// A fold for each of `count` presses, by chance: what repeats in the order of presses is in no fold alone.
std::vector<std::size_t> draw_folds(std::size_t count, std::size_t folds, std::uint64_t seed) {
  std::vector<std::size_t> fold_of(count);
  for (std::size_t k = 0; k < count; ++k) fold_of[k] = k % folds;
  Random random(seed);
  for (std::size_t k = count - 1; k > 0; --k) std::swap(fold_of[k], fold_of[random.below(k + 1)]);
  return fold_of;
}

/// The lighter of two loads and the heavier.
std::vector<std::size_t> folds_of_loads(const std::vector<Points>& presses, const std::vector<double>& rising_loads) {
  std::vector<std::size_t> fold_of;
  for (const Points press : presses) {
    const double newtons = press.front().load_newtons;
    fold_of.push_back(newtons / rising_loads.front() < rising_loads.back() / newtons ? 0 : 1);
  }
  return fold_of;
}

/// The error of a fit without the press on a sample of it. The samples of a press are alike, so each pulls at the fit
/// as all its samples in the fit do.
double left_out_error(const TestedLoad& load, std::size_t samples_of_press) {
  const double pull = std::min(load.leverage * static_cast<double>(samples_of_press), kMostLeverage);
  return load.residual_n / load.newtons / (1.0 - pull);
}

class TaxelComparison {
 public:
  TaxelComparison(std::size_t taxel, Points points, const NetworkErrors& errors, const TableMaker& maker)
      : taxel_(taxel), errors_(errors), maker_(maker), presses_(split_presses(points)), loads_(rising_loads(points)) {}

  [[nodiscard]] ComparedTaxel judge() const {
    ComparedTaxel judged;
    const std::size_t folds = std::min(kFolds, presses_.size());
    if (folds < 2) return judged;
    const bool are_two = count_levels(loads_) == 2 && loads_.back() >= kLeastForceRange * loads_.front();
    const std::vector<std::size_t> fold_of =
        are_two ? folds_of_loads(presses_, loads_) : draw_folds(presses_.size(), folds, taxel_);
    for (std::size_t fold = 0; fold < folds; ++fold) {
      std::vector<TaxelPoint> kept;
      for (std::size_t k = 0; k < presses_.size(); ++k) {
        if (fold_of[k] != fold) kept.insert(kept.end(), presses_[k].begin(), presses_[k].end());
      }
      kept = by_force(kept);
      const auto fitted = maker_.fit(kept);
      if (kept.empty() || fitted.knots.empty()) continue;
      const touch::fusion::ForceTables table = assemble_tables({fitted}, {taxel_});
      for (std::size_t k = 0; k < presses_.size(); ++k) {
        const bool is_within = presses_[k].front().newtons <= PressNumbers::kSameForce * kept.back().newtons;
        if (fold_of[k] == fold && is_within) judge_press(presses_[k], table, judged);
      }
    }
    return judged;
  }

 private:
  [[nodiscard]] const TestedLoad* tested(std::size_t sample) const {
    const auto found = std::lower_bound(errors_.begin(), errors_.end(), sample,
                                        [](const TestedLoad* load, std::size_t at) { return load->sample < at; });
    return found != errors_.end() && (*found)->sample == sample ? *found : nullptr;
  }

  void judge_press(Points press, const touch::fusion::ForceTables& table, ComparedTaxel& judged) const {
    JudgedPress result{press.front().press, 0.0, 0.0};
    const auto is_tested = [&](const TaxelPoint& point) { return tested(point.sample) != nullptr; };
    const auto samples = static_cast<std::size_t>(std::count_if(press.begin(), press.end(), is_tested));
    if (samples == 0) return;  // the shared network sees few of a taxel
    for (const TaxelPoint& point : press) {
      const TestedLoad* const of_network = tested(point.sample);
      if (of_network == nullptr) continue;
      const touch::fusion::ForceTables::Value value =
          table.at(0, static_cast<float>(point.excess_siemens), static_cast<float>(maker_.temperature_offset(point)));
      const double error = std::exp(static_cast<double>(value.log_newtons)) / point.newtons - 1.0;
      result.of_table += std::min(std::abs(error), kMostError);
      result.of_network += std::min(std::abs(left_out_error(*of_network, samples)), kMostError);
      judged.samples.push_back({point.sample, point.newtons, error, point.touch});
    }
    result.of_table /= static_cast<double>(samples);
    result.of_network /= static_cast<double>(samples);
    judged.presses.push_back(result);
  }

  std::size_t taxel_;
  const NetworkErrors& errors_;
  const TableMaker& maker_;
  std::vector<Points> presses_;
  std::vector<double> loads_;
};

}  // namespace

std::vector<ComparedTaxel> judge_left_out_presses(std::span<const std::vector<TaxelPoint>> points,
                                                  const TableMaker& maker, const ForceTraining& training) {
  const std::vector<NetworkErrors> errors = errors_by_taxel(training);
  std::vector<ComparedTaxel> judged(points.size());
  parallel_for(points.size(), [&](std::size_t taxel) {
    if (errors[taxel].empty()) return;
    judged[taxel] = TaxelComparison(taxel, points[taxel], errors[taxel], maker).judge();
  });
  return judged;
}

}  // namespace dermis::learn::calibration
