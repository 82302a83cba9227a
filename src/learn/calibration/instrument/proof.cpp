// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/instrument/proof.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "dermis/touch/fusion/force_fusion.hpp"
#include "dermis/touch/fusion/material_memory.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "dermis/touch/preprocessing/conditioner.hpp"
#include "learn/calibration/instrument/press_choice.hpp"
#include "learn/calibration/labels/press_numbers.hpp"
#include "learn/calibration/mean.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kHalves = 2;
constexpr std::size_t kLeastPlaces = 8;  // fewer are judged press by press
constexpr std::size_t kTenth = 10;
constexpr double kSure = 3.0;    // standard errors
constexpr double kMisfit = 2.0;  // times the square of single presses, or of what is said

/// A mean and its standard error.
struct Gain {
  double mean = 0.0;
  double error = std::numeric_limits<double>::infinity();
};

Gain gain_of(const std::vector<double>& values) {
  if (values.size() < 2) return {};
  const double mean = mean_of(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const auto count = static_cast<double>(values.size());
  return {mean, std::sqrt(squares / (count * (count - 1.0)))};
}

double median_size(const std::vector<UnseenPress>& presses) {
  std::vector<double> sizes;
  for (const UnseenPress& press : presses) {
    if (!std::isnan(press.log_error)) sizes.push_back(std::abs(press.log_error));
  }
  return sizes.empty() ? 0.0 : quantile(sizes, 0.5);
}

/// The square of errors over their sigma: the mean, or its estimate by the median where that is less. Single outliers
/// are no misfit.
double typical_square(const std::vector<UnseenPress>& presses) {
  constexpr double kMedianOfSquare = 0.4549;  // of a standard normal variable
  std::vector<double> squares;
  for (const UnseenPress& press : presses) {
    if (!std::isnan(press.log_error)) squares.push_back(std::pow(press.log_error / press.sigma, 2));
  }
  return squares.empty() ? 0.0 : std::min(mean_of(squares), quantile(squares, 0.5) / kMedianOfSquare);
}

/// Laws that are not well known, as those of a material that saturates, are no misfit of several taxels.
double square_of_single(const UnseenPresses& unseen) {
  return std::max(1.0, typical_square(unseen.single));
}

/// The least share beside so many squares of sigma that covers presses as often as one sigma does.
double share_beyond(const std::vector<UnseenPress>& presses, double squares) {
  constexpr double kOneSigma = 0.683;
  std::vector<double> excess;
  for (const UnseenPress& press : presses) {
    if (std::isnan(press.log_error)) continue;
    excess.push_back(std::sqrt(std::max(std::pow(press.log_error, 2) - squares * std::pow(press.sigma, 2), 0.0)));
  }
  return excess.empty() ? 0.0 : quantile(excess, kOneSigma);
}

/// By how much the candidate is nearer; squares would be those of a few presses. Not a number: one of both has no
/// force.
double gain_of(const UnseenPress& candidate, const UnseenPress& before) {
  return std::abs(before.log_error) - std::abs(candidate.log_error);
}

/// Presses on several taxels beside their middle error.
UnseenPresses without_middle(UnseenPresses unseen) {
  std::vector<double> errors;
  for (const UnseenPress& press : unseen.several) {
    if (!std::isnan(press.log_error)) errors.push_back(press.log_error);
  }
  if (errors.empty()) return unseen;
  const double middle = quantile(errors, 0.5);
  for (UnseenPress& press : unseen.several) press.log_error -= middle;
  return unseen;
}

/// By more than chance.
bool are_worse(const std::vector<UnseenPress>& candidate, const std::vector<UnseenPress>& before) {
  std::vector<double> gains;
  for (std::size_t k = 0; k < before.size(); ++k) {
    const double gained = gain_of(candidate[k], before[k]);
    if (!std::isnan(gained)) gains.push_back(gained);
  }
  const Gain gain = gain_of(gains);
  return gain.mean < -kSure * gain.error;
}

UnseenPress unseen_press(const std::vector<dermis::TotalForce>& totals, double newtons) {
  double sum = 0.0;
  double variance = 0.0;
  for (const dermis::TotalForce& total : totals) {
    sum += total.newtons;
    variance += total.sigma_newtons * total.sigma_newtons;
  }
  const auto count = static_cast<double>(totals.size());
  const double sigma = std::sqrt(variance / count) / newtons;
  if (!std::isfinite(sum) || !std::isfinite(sigma)) return {std::numeric_limits<double>::quiet_NaN(), 0.0};
  const double share = sum / count / newtons;
  return {share > 0.0 ? std::clamp(std::log(share), -1.0, 1.0) : -1.0, sigma};
}

}  // namespace

template <typename IsSame>
void Proof::number_places(std::vector<LeftOut>& presses, const IsSame& is_same) {
  for (std::size_t k = 1; k < presses.size(); ++k) {
    presses[k].place = presses[k - 1].place + (is_same(presses[k - 1], presses[k]) ? 0 : 1);
  }
}

Proof::Proof(const ArrayDescription& array, const CircuitFrames& frames, const Trainable& trainable)
    : trainable_(trainable), lines_(array.rows + array.cols) {
  const Presses presses = sort_presses(frames, std::numeric_limits<std::size_t>::max());
  const auto left_out = [](const Press& press) {
    return LeftOut{press.taxels, press.newtons, press.frame->first_frame, press.frame->last_frame, 0, kHalves};
  };
  std::transform(presses.several.begin(), presses.several.end(), std::back_inserter(several_), left_out);
  std::transform(presses.single.begin(), presses.single.end(), std::back_inserter(single_), left_out);
  number_places(several_, [](const LeftOut& one, const LeftOut& next) { return next.taxels == one.taxels; });
  const bool are_few_places = several_.empty() || several_.back().place < 2 * kHalves;
  for (std::size_t k = 0; k < several_.size(); ++k) {
    several_[k].half = (are_few_places ? k : several_[k].place) % kHalves;
  }
  number_places(single_, [](const LeftOut& one, const LeftOut& next) {
    return next.taxels == one.taxels && next.newtons <= PressNumbers::kSameForce * one.newtons;
  });
  for (LeftOut& press : single_) press.half = std::min(press.place % kTenth, kHalves);
}

std::vector<Load> Proof::loads_without(std::size_t half, bool all_several) const {
  std::vector<bool> is_left_out(trainable_.frames.size());
  for (const std::vector<LeftOut>* const presses : {&several_, &single_}) {
    for (const LeftOut& press : *presses) {
      if (press.half != half && !(all_several && presses == &several_)) continue;
      for (std::size_t frame = press.first_frame; frame <= press.last_frame; ++frame) is_left_out[frame] = true;
    }
  }
  std::vector<Load> kept;
  std::copy_if(trainable_.loads.begin(), trainable_.loads.end(), std::back_inserter(kept),
               [&](const Load& load) { return !is_left_out[load.frame]; });
  return kept;
}

/// false: the circuit cannot be inverted.
bool Proof::judge(const touch::pipeline::Model& model, std::size_t half, UnseenPresses& unseen) const {
  Result<touch::compensation::Compensator> compensator = touch::pipeline::make_compensator(model.array, model.networks);
  if (!compensator) return false;
  std::map<std::size_t, std::pair<const LeftOut*, UnseenPress*>> by_frame;
  const auto add = [&](const std::vector<LeftOut>& presses, std::vector<UnseenPress>& results) {
    results.resize(presses.size());
    for (std::size_t k = 0; k < presses.size(); ++k) {
      if (presses[k].half == half) by_frame[presses[k].first_frame] = {&presses[k], &results[k]};
    }
  };
  add(several_, unseen.several);
  add(single_, unseen.single);
  touch::preprocessing::Conditioner conditioner(model.array);
  touch::fusion::ForceFusion fusion(model.networks);
  std::optional<touch::fusion::MaterialMemory> memory;
  if (model.memory) memory.emplace(*model.memory, model.array.taxel_count());
  ConditionedFrame conditioned;
  ConductanceFrame conductance;
  ForceFrame force;
  std::vector<dermis::TotalForce> totals;
  auto press = by_frame.begin();
  for (std::size_t frame = 0; frame < trainable_.frames.size() && press != by_frame.end(); ++frame) {
    const auto& [left_out, result] = press->second;
    const bool is_of_press = frame >= left_out->first_frame;
    if (!is_of_press && !memory) continue;
    conditioner.process(trainable_.frames[frame], conditioned);
    compensator->forget();
    compensator->process(conditioned, conductance);
    fusion.process(conductance, force);
    if (memory) memory->process(force, fusion.noise_newtons());
    if (is_of_press) totals.push_back(force.total(left_out->taxels));
    if (frame < left_out->last_frame) continue;
    *result = unseen_press(totals, left_out->newtons);
    totals.clear();
    ++press;
  }
  return true;
}

std::optional<UnseenPresses> Proof::errors_of(const Fit& fit, bool without_several) const {
  UnseenPresses unseen;
  for (std::size_t half = 0; half < kHalves; ++half) {
    const std::vector<Load> kept = loads_without(half, without_several);
    const std::optional<ArrayDescription> array = fit(kept);
    const std::optional<touch::pipeline::Model> model = array ? trainable_.train(*array, kept) : std::nullopt;
    if (!model || !judge(*model, half, unseen)) return std::nullopt;
  }
  std::size_t next = 0;
  for (std::size_t k = 0; k < single_.size(); ++k) {
    if (single_[k].half < kHalves) unseen.single[next++] = unseen.single[k];
  }
  unseen.single.resize(next);
  return unseen;
}

std::optional<UnseenPresses> Proof::errors_by_singles(const ArrayDescription& array) const {
  return errors_of([&](std::span<const Load>) { return std::optional(array); }, true);
}

std::vector<double> Proof::gains_of_places(const UnseenPresses& candidate, const UnseenPresses& before) const {
  const bool is_by_place = several_.back().place + 1 >= kLeastPlaces;
  std::map<std::size_t, std::vector<double>> by_place;
  for (std::size_t k = 0; k < several_.size(); ++k) {
    const double gained = gain_of(candidate.several[k], before.several[k]);
    if (!std::isnan(gained)) by_place[is_by_place ? several_[k].place : k].push_back(gained);
  }
  std::vector<double> gains;
  for (const auto& [place, of_place] : by_place) gains.push_back(mean_of(of_place));
  return gains;
}

bool Proof::is_better(const UnseenPresses& candidate, const UnseenPresses& before) const {
  constexpr double kWorthwhile = 0.9;
  if (!(median_size(candidate.several) < kWorthwhile * median_size(before.several))) return false;
  const Gain several = gain_of(gains_of_places(candidate, before));
  const Gain beside_middle = gain_of(gains_of_places(without_middle(candidate), without_middle(before)));
  return several.mean > kSure * several.error && beside_middle.mean > beside_middle.error &&
         !are_worse(candidate.single, before.single);
}

bool Proof::is_no_worse(const UnseenPresses& candidate, const UnseenPresses& before) const {
  const Gain several = gain_of(gains_of_places(candidate, before));
  return several.mean > -several.error && !are_worse(candidate.single, before.single);
}

bool Proof::do_not_add_up(const UnseenPresses& unseen) {
  return typical_square(unseen.several) > kMisfit * square_of_single(unseen);
}

double Proof::unexplained_share(const UnseenPresses& unseen) const {
  double others = 0.0;
  for (const LeftOut& press : several_) others += static_cast<double>(press.taxels.size() - 1);
  const double others_of_press = others / static_cast<double>(several_.size());
  const double others_on_lines = static_cast<double>(lines_) - 2.0;
  const double of_circuit = share_beyond(unseen.several, kMisfit * square_of_single(unseen));
  return std::max(share_beyond(unseen.several, 1.0),
                  std::min(kOfWrongCircuit, of_circuit * others_on_lines / others_of_press));
}

}  // namespace dermis::learn::calibration
