// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/circuit_frames.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "dermis/touch/frames/neighbours.hpp"
#include "dermis/touch/preprocessing/conditioner.hpp"
#include "dermis/touch/preprocessing/phase.hpp"
#include "learn/calibration/labels/labels.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kLeastSpanCelsius = 3.0;
constexpr double kSameCelsius = 1.0;  // frames this near in temperature are averaged

/// A frame before repetitions are averaged.
struct Labelled {
  CircuitFrame frame;
  std::optional<double> celsius;
  double squares = 0.0;  // of idle readings about their mean, over their described variances
  double freedom = 0.0;
};

/// Rubber spreads a load to the taxels around it: a taxel beside a pressed one may not be idle.
void forget_neighbours(const ArrayDescription& array, std::vector<float>& newtons) {
  const std::vector<float> labelled = newtons;
  for (std::size_t taxel = 0; taxel < labelled.size(); ++taxel) {
    if (labelled[taxel] == 0.0F) continue;
    for (const std::size_t near : Neighbours(array.rows, array.cols, taxel)) {
      if (newtons[near] == 0.0F) newtons[near] = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

/// A reading at the end of the ADC does not determine its conductance, on which all readings of both its lines depend.
void forget_lines_of(const ArrayDescription& array, std::size_t saturated, std::vector<float>& newtons) {
  for (std::size_t taxel = 0; taxel < newtons.size(); ++taxel) {
    const bool is_on_its_lines =
        taxel / array.cols == saturated / array.cols || taxel % array.cols == saturated % array.cols;
    if (is_on_its_lines) newtons[taxel] = std::numeric_limits<float>::quiet_NaN();
  }
}

void read_loads(const ArrayDescription& array, std::span<const Load> loads, const ConditionedFrame& conditioned,
                CircuitFrame& frame) {
  Sample sample;
  expand_loads(array, loads, sample);
  for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
    if (conditioned.taxels[taxel] != TaxelStatus::ok) {
      sample.known_newtons[taxel] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  forget_neighbours(array, sample.known_newtons);
  for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
    if (conditioned.taxels[taxel] == TaxelStatus::saturated) forget_lines_of(array, taxel, sample.known_newtons);
  }
  frame.newtons = std::move(sample.known_newtons);
  const auto is_bad = [&](std::size_t taxel) { return conditioned.taxels[taxel] != TaxelStatus::ok; };
  std::erase_if(sample.totals,
                [&](const TotalForce& total) { return std::any_of(total.taxels.begin(), total.taxels.end(), is_bad); });
  frame.totals = std::move(sample.totals);
}

bool is_same_load(const std::vector<float>& a, const std::vector<float>& b) {
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

bool is_repetition(const Labelled& first, const Labelled& next) {
  if (first.celsius.has_value() != next.celsius.has_value()) return false;
  if (first.celsius && std::abs(*first.celsius - *next.celsius) > kSameCelsius) return false;
  const auto is_same_total = [](const TotalForce& a, const TotalForce& b) {
    return a.newtons == b.newtons && a.taxels == b.taxels;
  };
  const std::vector<TotalForce>& totals = next.frame.totals;
  return is_same_load(first.frame.newtons, next.frame.newtons) &&
         std::equal(totals.begin(), totals.end(), first.frame.totals.begin(), first.frame.totals.end(), is_same_total);
}

/// The running mean of frames with equal loads.
void average_into(Labelled& mean, const Labelled& next) {
  const auto count = static_cast<double>(mean.frame.averaged);
  const double share = 1.0 / (count + 1.0);
  for (std::size_t k = 0; k < mean.frame.ratio.size(); ++k) {
    const double difference = next.frame.ratio[k] - mean.frame.ratio[k];
    mean.frame.ratio[k] += share * difference;
    if (mean.frame.newtons[k] != 0.0F) continue;
    mean.squares += (1.0 - share) * std::pow(difference / next.frame.sigma_ratio, 2);
    mean.freedom += 1.0;
  }
  if (mean.celsius) *mean.celsius += share * (*next.celsius - *mean.celsius);
  mean.frame.sigma_ratio *= std::sqrt(count / (count + 1.0));
  ++mean.frame.averaged;
  mean.frame.last_frame = next.frame.last_frame;
}

std::vector<Labelled> labelled_frames(const ArrayDescription& array, std::span<const RawFrame> frames,
                                      const LoadsOfFrames& loads_of, Nanos settle_time) {
  touch::preprocessing::PhaseSelector phase(settle_time, touch::preprocessing::Phase::calibrate);
  touch::preprocessing::Conditioner conditioner(array);
  ConditionedFrame conditioned;
  std::vector<Labelled> labelled;
  bool unlabelled_between = true;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const bool is_labelled = !loads_of[k].empty();
    if (phase.select(frames[k].time, is_labelled) != touch::preprocessing::Destination::sample_database) {
      unlabelled_between = true;
      continue;
    }
    conditioner.process(frames[k], conditioned);
    if (conditioner.rejection() != touch::preprocessing::Rejection::none) continue;
    Labelled next;
    next.celsius = conditioned.temperature_celsius;
    next.frame.first_frame = next.frame.last_frame = k;
    next.frame.ratio = conditioned.ratio;
    next.frame.sigma_ratio = next.frame.described_sigma = conditioned.sigma_ratio;
    read_loads(array, loads_of[k], conditioned, next.frame);
    if (!unlabelled_between && !labelled.empty() && is_repetition(labelled.back(), next)) {
      average_into(labelled.back(), next);
    } else {
      labelled.push_back(std::move(next));
    }
    unlabelled_between = false;
  }
  return labelled;
}

/// Frames may be means of many: their noise is the difference between repetitions of as many.
void measure_noise(std::vector<Labelled>& labelled) {
  constexpr double kLeastVariance = 1e-3;  // of the described one: rounding hides the noise of means
  std::map<std::size_t, std::pair<double, double>> sums;
  for (const Labelled& frame : labelled) {
    sums[frame.frame.averaged].first += frame.squares;
    sums[frame.frame.averaged].second += frame.freedom;
  }
  for (Labelled& frame : labelled) {
    const auto& [squares, freedom] = sums[frame.frame.averaged];
    if (freedom > 0.0) frame.frame.sigma_ratio *= std::sqrt(std::max(kLeastVariance, squares / freedom));
  }
}

}  // namespace

double highest_ratio(const CircuitFrames& frames) {
  double highest = 0.0;
  for (const CircuitFrame& frame : frames.frames) {
    highest = std::max(highest, *std::max_element(frame.ratio.begin(), frame.ratio.end()));
  }
  return highest;
}

bool presses_part(const CircuitFrame& frame) {
  const auto is_pressed = [](float newtons) { return newtons > 0.0F; };
  const auto is_idle = [](float newtons) { return newtons == 0.0F; };
  return std::any_of(frame.newtons.begin(), frame.newtons.end(), is_pressed) &&
         std::any_of(frame.newtons.begin(), frame.newtons.end(), is_idle);
}

Result<CircuitFrames> circuit_frames(const ArrayDescription& array, std::span<const RawFrame> frames,
                                     std::span<const Load> loads, Nanos settle_time) {
  if (Status checked = check_loads(array, frames.size(), loads); !checked) return checked.error();
  std::vector<Labelled> labelled = labelled_frames(array, frames, LoadsOfFrames(loads, frames.size()), settle_time);
  if (labelled.empty()) return bad_input("no labelled frame is left after settling");
  measure_noise(labelled);
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  bool all_have_it = true;
  for (const Labelled& frame : labelled) {
    all_have_it = all_have_it && frame.celsius.has_value();
    lowest = std::min(lowest, frame.celsius.value_or(lowest));
    highest = std::max(highest, frame.celsius.value_or(highest));
  }
  CircuitFrames result;
  result.has_temperature = all_have_it && highest - lowest >= kLeastSpanCelsius;
  for (Labelled& frame : labelled) {
    if (result.has_temperature) {
      frame.frame.temperature = (2.0 * *frame.celsius - lowest - highest) / (highest - lowest);
    }
    result.frames.push_back(std::move(frame.frame));
  }
  return result;
}

}  // namespace dermis::learn::calibration
