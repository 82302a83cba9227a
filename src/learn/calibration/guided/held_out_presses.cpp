// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/guided/held_out_presses.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "dermis/touch/fusion/force_fusion.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "dermis/touch/preprocessing/conditioner.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kLeastTrained = 4;  // presses
constexpr std::size_t kTaxelsPerHeldOutPress = 2;
constexpr std::size_t kTaxelFolds = 4;

using PressesOfTaxel = std::map<std::size_t, GuidedPresses>;

/// Presses of single taxels, from the lightest.
PressesOfTaxel by_taxel(const GuidedPresses& presses) {
  PressesOfTaxel grouped;
  for (const auto& press : presses) {
    if (!press->together_with) grouped[press->taxel].push_back(press);
  }
  for (auto& [taxel, of_taxel] : grouped) {
    std::stable_sort(of_taxel.begin(), of_taxel.end(),
                     [](const auto& a, const auto& b) { return a->newtons < b->newtons; });
  }
  return grouped;
}

/// Chooses one press of every second taxel, in turn the lightest, the next, ...
GuidedPresses single_presses(const PressesOfTaxel& grouped) {
  GuidedPresses chosen;
  std::size_t number = 0;
  for (const auto& [taxel, presses] : grouped) {
    const auto lighter = static_cast<std::size_t>(std::count_if(
        presses.begin(), presses.end(), [&](const auto& press) { return press->newtons < presses.back()->newtons; }));
    if (number++ % kTaxelsPerHeldOutPress != 0 || lighter == 0) continue;
    chosen.push_back(presses[number / kTaxelsPerHeldOutPress % lighter]);
  }
  return chosen;
}

/// All presses of every fourth taxel, from the `first` on.
GuidedPresses whole_taxels(const PressesOfTaxel& grouped, std::size_t first) {
  GuidedPresses chosen;
  std::size_t number = 0;
  for (const auto& [taxel, presses] : grouped) {
    if (number++ % kTaxelFolds == first) chosen.insert(chosen.end(), presses.begin(), presses.end());
  }
  return chosen;
}

GuidedPresses without(const GuidedPresses& presses, const GuidedPresses& left_out) {
  const std::set<std::shared_ptr<const GuidedPress>> gone(left_out.begin(), left_out.end());
  GuidedPresses kept;
  std::copy_if(presses.begin(), presses.end(), std::back_inserter(kept),
               [&](const auto& press) { return !gone.contains(press); });
  return kept;
}

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  return upper_median(std::move(values));
}

/// Relative errors of a model on presses; 1 where it gives no force.
std::vector<double> errors_of(const touch::pipeline::Model& model, const GuidedPresses& presses) {
  Result<touch::compensation::Compensator> compensator = touch::pipeline::make_compensator(model.array, model.networks);
  if (!compensator) return {};
  touch::fusion::ForceFusion fusion(model.networks);
  ConditionedFrame conditioned;
  ConductanceFrame conductance;
  ForceFrame force;
  std::vector<double> errors;
  for (const auto& press : presses) {
    touch::preprocessing::Conditioner conditioner(model.array);
    conditioner.process(press->frames.back(), conditioned);
    compensator->process(conditioned, conductance);
    fusion.process(conductance, force);
    const auto newtons = static_cast<double>(force.newtons[press->taxel]);
    errors.push_back(std::isfinite(newtons) ? std::abs(newtons / press->newtons - 1.0) : 1.0);
  }
  return errors;
}

/// The errors of a fit without the left-out presses; none where too few presses are left.
std::vector<double> errors_on(const GuidedPresses& left_out, const ArrayDescription& array,
                              const std::vector<RawFrame>& unloaded, const GuidedPresses& presses) {
  const GuidedPresses kept = without(presses, left_out);
  if (left_out.empty() || kept.size() < kLeastTrained) return {};
  const GuidedData data = labelled_frames(array, unloaded, kept);
  const Result<Calibration> fit = calibrate(array, data.frames, data.loads);
  if (!fit) return {};
  return errors_of(fit->model, left_out);
}

Load force_on(const ArrayDescription& array, std::size_t frame, std::size_t taxel, double newtons) {
  const std::size_t row = taxel / array.cols;
  const std::size_t col = taxel % array.cols;
  return {frame, LoadKind::force, {row, col, row, col}, newtons};
}

}  // namespace

GuidedData labelled_frames(const ArrayDescription& array, const std::vector<RawFrame>& unloaded,
                           const GuidedPresses& presses) {
  GuidedData data;
  for (const RawFrame& frame : unloaded) {
    data.loads.push_back({data.frames.size(), LoadKind::force, all_taxels(array), 0.0});
    data.frames.push_back(frame);
  }
  for (const auto& press : presses) {
    for (const RawFrame& frame : press->frames) {
      data.loads.push_back(force_on(array, data.frames.size(), press->taxel, press->newtons));
      if (press->together_with) {
        data.loads.push_back(force_on(array, data.frames.size(), *press->together_with, press->newtons));
      }
      data.frames.push_back(frame);
    }
  }
  return data;
}

std::optional<double> error_on_left_out_presses(const ArrayDescription& array, const std::vector<RawFrame>& unloaded,
                                                const GuidedPresses& presses) {
  const PressesOfTaxel grouped = by_taxel(presses);
  GuidedPresses left_out = single_presses(grouped);
  if (left_out.empty()) left_out = whole_taxels(grouped, kTaxelFolds - 1);  // at first all taxels have one weight
  return median(errors_on(left_out, array, unloaded, presses));
}

std::optional<double> error_on_left_out_taxels(const ArrayDescription& array, const std::vector<RawFrame>& unloaded,
                                               const GuidedPresses& presses,
                                               const std::function<void(double)>& progress) {
  const PressesOfTaxel grouped = by_taxel(presses);
  if (grouped.size() == array.taxel_count()) return std::nullopt;
  std::vector<double> errors;
  const std::size_t folds = std::min(kTaxelFolds, grouped.size());
  for (std::size_t fold = 0; fold < folds; ++fold) {
    const std::vector<double> of_fold = errors_on(whole_taxels(grouped, fold), array, unloaded, presses);
    errors.insert(errors.end(), of_fold.begin(), of_fold.end());
    progress(static_cast<double>(fold + 1) / static_cast<double>(folds));
  }
  return median(std::move(errors));
}

}  // namespace dermis::learn::calibration
