// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/circuit_fit/telling_presses.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "dermis/compensation/circuit_model.hpp"
#include "dermis/core/quantile.hpp"
#include "dermis/core/random.hpp"

namespace dermis::calibration {
namespace {

constexpr std::size_t kPresses = 5;
constexpr std::size_t kMostPairs = 150;  // that are looked at
constexpr std::uint64_t kPairSeed = 3;

/// What a fitted circuit would read.
class Prediction {
 public:
  explicit Prediction(const CommonRatio& fit) : fit_(fit), siemens_(fit.rubber.laws.size()) {
    if (fit.array.readout.circuit == Circuit::none) return;
    Result<compensation::CircuitModel> model = compensation::CircuitModel::create(fit.array);
    if (model) model_.emplace(std::move(*model));
  }

  /// Readings over the supply [taxels].
  [[nodiscard]] std::vector<double> readings(const PressPair& pair) {
    for (std::size_t taxel = 0; taxel < siemens_.size(); ++taxel) {
      const bool is_pressed = taxel == pair.first || taxel == pair.second;
      siemens_[taxel] = fit_.rubber.reference_siemens * conductance(taxel, is_pressed ? pair.newtons : 0.0);
    }
    if (!model_) return siemens_;
    model_->solve(siemens_);
    return {model_->ratio().begin(), model_->ratio().end()};
  }

 private:
  /// At the middle of the temperatures, over the reference.
  [[nodiscard]] double conductance(std::size_t taxel, double newtons) const {
    const Rubber& rubber = fit_.rubber;
    const TaxelLaw& law = rubber.laws[taxel];
    const double unloaded = law.unloaded.size() > 0 ? std::max(0.0, law.unloaded[0]) : 0.0;
    if (newtons == 0.0) return unloaded;
    const double log_force = rubber.force_scale.log_force(newtons);
    const double open = law.pressed.dot(pressed_basis(log_force, 0.0)) +
                        rubber.sheet.tail(kCommonTerms).dot(common_basis(log_force, 0.0, 0.0));
    // What all have in series: ln g = open - r g.
    double excess = std::exp(open);
    const double series = rubber.sheet[kSheetTerms - 1];
    constexpr int kSteps = 20;
    for (int k = 0; k < kSteps; ++k) excess = std::sqrt(excess * std::exp(open - series * excess));
    return unloaded + excess;
  }

  const CommonRatio& fit_;
  std::vector<double> siemens_;
  std::optional<compensation::CircuitModel> model_;  // empty: readings are conductances
};

/// Taxels that all circuits have a law of, with the heaviest known load of each; 0: none.
std::vector<double> heaviest_loads(const std::vector<const CommonRatio*>& circuits, const CircuitFrames& frames) {
  std::vector<double> heaviest(circuits.front()->rubber.laws.size());
  for (const CircuitFrame& frame : frames.frames) {
    for (std::size_t taxel = 0; taxel < heaviest.size(); ++taxel) {
      heaviest[taxel] = std::fmax(heaviest[taxel], static_cast<double>(frame.newtons[taxel]));
    }
  }
  for (const CommonRatio* const circuit : circuits) {
    for (std::size_t taxel = 0; taxel < heaviest.size(); ++taxel) {
      if (circuit->rubber.laws[taxel].pressed.size() == 0) heaviest[taxel] = 0.0;
    }
  }
  return heaviest;
}

/// Pairs that are no neighbours, all of them or as many as are looked at.
std::vector<PressPair> possible_pairs(const ArrayDescription& array, const std::vector<double>& heaviest) {
  const auto apart = [&](std::size_t a, std::size_t b) {
    const auto between = [](std::size_t x, std::size_t y) { return x > y ? x - y : y - x; };
    return std::max(between(a / array.cols, b / array.cols), between(a % array.cols, b % array.cols)) > 1;
  };
  std::vector<PressPair> pairs;
  for (std::size_t a = 0; a < heaviest.size(); ++a) {
    if (heaviest[a] == 0.0) continue;
    for (std::size_t b = a + 1; b < heaviest.size(); ++b) {
      if (heaviest[b] > 0.0 && apart(a, b)) pairs.push_back({a, b, std::min(heaviest[a], heaviest[b])});
    }
  }
  Random random(kPairSeed);
  for (std::size_t k = 0; k < std::min(kMostPairs, pairs.size()); ++k) {
    std::swap(pairs[k], pairs[k + random.below(pairs.size() - k)]);
  }
  pairs.resize(std::min(kMostPairs, pairs.size()));
  return pairs;
}

/// Presses that are asked for are kept like those that are there; unloaded frames are means of more.
double noise_of_presses(const CircuitFrames& frames) {
  std::vector<double> sigmas;
  for (const CircuitFrame& frame : frames.frames) {
    const bool is_pressed =
        std::any_of(frame.newtons.begin(), frame.newtons.end(), [](float newtons) { return newtons > 0.0F; });
    if (is_pressed) sigmas.push_back(frame.sigma_ratio);
  }
  return upper_median(std::move(sigmas));
}

struct Distance {
  PressPair pair = {};
  double square = 0.0;  // in variances of a reading
};

}  // namespace

std::vector<PressPair> telling_presses(const std::vector<const CommonRatio*>& circuits, const CircuitFrames& frames,
                                       double sure_square) {
  std::vector<Prediction> predictions;
  for (const CommonRatio* const circuit : circuits) predictions.emplace_back(*circuit);
  const double variance = std::pow(noise_of_presses(frames), 2) * circuits.front()->scatter.noise_variance;
  std::vector<Distance> distances;
  for (const PressPair& pair : possible_pairs(circuits.front()->array, heaviest_loads(circuits, frames))) {
    const std::vector<double> first = predictions.front().readings(pair);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 1; k < predictions.size(); ++k) {
      const std::vector<double> other = predictions[k].readings(pair);
      double square = 0.0;
      for (std::size_t taxel = 0; taxel < first.size(); ++taxel) square += std::pow(first[taxel] - other[taxel], 2);
      least = std::min(least, square / variance);
    }
    distances.push_back({pair, least});
  }
  std::sort(distances.begin(), distances.end(),
            [](const Distance& a, const Distance& b) { return a.square > b.square; });
  distances.resize(std::min(distances.size(), kPresses));
  double sum = 0.0;
  std::vector<PressPair> pairs;
  for (const Distance& distance : distances) {
    sum += distance.square;
    pairs.push_back(distance.pair);
  }
  if (sum < sure_square) pairs.clear();
  return pairs;
}

std::string describe(const std::vector<PressPair>& presses, const ArrayDescription& array) {
  std::string text;
  for (const PressPair& press : presses) {
    text += fmt::format("{} {} and {} {}with {:g} N each", text.empty() ? "press" : ",", array.taxel_name(press.first),
                        array.taxel_name(press.second), text.empty() ? "together " : "", press.newtons);
  }
  return text;
}

}  // namespace dermis::calibration
