// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/discriminating_presses.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "dermis/touch/compensation/circuit_model.hpp"
#include "dermis/touch/frames/random.hpp"
#include "learn/calibration/circuit_fit/press_prediction.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kPresses = 5;
constexpr std::size_t kMostPairs = 150;  // that are looked at
constexpr std::uint64_t kPairSeed = 3;

/// The readings that a fitted circuit predicts.
class Prediction {
 public:
  explicit Prediction(const CommonRatio& fit) : rubber_(fit.rubber) {
    if (fit.array.readout.circuit == Circuit::none) return;
    Result<touch::compensation::CircuitModel> model = touch::compensation::CircuitModel::create(fit.array);
    if (model) model_.emplace(std::move(*model));
  }

  /// Readings over the supply [taxels].
  [[nodiscard]] std::vector<double> readings(const PressPair& pair) {
    std::vector<double> siemens = siemens_under(rubber_, pair);
    if (!model_) return siemens;
    model_->solve(siemens);
    return {model_->ratio().begin(), model_->ratio().end()};
  }

  /// The reading of a taxel that is the only one pressed.
  [[nodiscard]] double alone(std::size_t taxel, double newtons) { return readings({taxel, taxel, newtons})[taxel]; }

 private:
  const Rubber& rubber_;
  std::optional<touch::compensation::CircuitModel> model_;  // empty: readings are conductances
};

/// For taxels that all circuits have a law for; 0: none.
std::vector<double> heaviest_loads(const std::vector<const CommonRatio*>& circuits, const CircuitFrames& frames) {
  std::vector<double> heaviest = heaviest_loads(circuits.front()->rubber, frames);
  for (const CommonRatio* const circuit : circuits) {
    for (std::size_t taxel = 0; taxel < heaviest.size(); ++taxel) {
      if (circuit->rubber.laws[taxel].pressed.size() == 0) heaviest[taxel] = 0.0;
    }
  }
  return heaviest;
}

/// Pairs that are no neighbours, at most kMostPairs of them.
std::vector<PressPair> possible_pairs(const ArrayDescription& array, const std::vector<double>& heaviest) {
  std::vector<PressPair> pairs;
  for (std::size_t a = 0; a < heaviest.size(); ++a) {
    if (heaviest[a] == 0.0) continue;
    for (std::size_t b = a + 1; b < heaviest.size(); ++b) {
      if (heaviest[b] > 0.0 && are_apart(array.cols, a, b)) pairs.push_back({a, b, std::min(heaviest[a], heaviest[b])});
    }
  }
  Random random(kPairSeed);
  for (std::size_t k = 0; k < std::min(kMostPairs, pairs.size()); ++k) {
    std::swap(pairs[k], pairs[k + random.below(pairs.size() - k)]);
  }
  pairs.resize(std::min(kMostPairs, pairs.size()));
  return pairs;
}

/// How far the readings of a pair under the first circuit are from those under each other one [variances of a reading].
struct Distances {
  PressPair pair = {};
  std::vector<double> squares;  // [circuits - 1]
};

/// The pressed taxels count only by the change that the other press makes: laws explain their readings alone in all
/// circuits.
Distances distances_of(std::vector<Prediction>& predictions, const PressPair& pair, double variance) {
  const std::vector<double> first = predictions.front().readings(pair);
  Distances distances{pair, {}};
  for (std::size_t k = 1; k < predictions.size(); ++k) {
    const std::vector<double> other = predictions[k].readings(pair);
    double square = 0.0;
    for (std::size_t taxel = 0; taxel < first.size(); ++taxel) {
      const bool is_pressed = taxel == pair.first || taxel == pair.second;
      const double alone =
          is_pressed ? predictions.front().alone(taxel, pair.newtons) - predictions[k].alone(taxel, pair.newtons) : 0.0;
      const double rubber = is_pressed ? kRubberScatter * first[taxel] : 0.0;
      square += std::pow(first[taxel] - other[taxel] - alone, 2) / (variance + rubber * rubber);
    }
    distances.squares.push_back(square);
  }
  return distances;
}

/// The sum of the kPresses pairs for which `square` is largest; these come first then.
template <class Square>
double sum_of_best(std::vector<Distances>& pairs, const Square& square) {
  const std::size_t count = std::min(kPresses, pairs.size());
  std::partial_sort(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(count), pairs.end(),
                    [&](const Distances& a, const Distances& b) { return square(a) > square(b); });
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) sum += square(pairs[k]);
  return sum;
}

}  // namespace

std::vector<PressPair> discriminating_presses(const std::vector<const CommonRatio*>& circuits,
                                              const CircuitFrames& frames, double sure_square) {
  std::vector<Prediction> predictions;
  for (const CommonRatio* const circuit : circuits) predictions.emplace_back(*circuit);
  const double variance = std::pow(noise_of_presses(frames), 2) * circuits.front()->scatter.noise_variance;
  std::vector<Distances> pairs;
  for (const PressPair& pair : possible_pairs(circuits.front()->array, heaviest_loads(circuits, frames))) {
    pairs.push_back(distances_of(predictions, pair, variance));
  }
  // A circuit that no pair would distinguish from the first does not hide the others.
  std::vector<std::size_t> distinguishable;
  for (std::size_t k = 0; k + 1 < predictions.size(); ++k) {
    if (sum_of_best(pairs, [k](const Distances& pair) { return pair.squares[k]; }) >= sure_square)
      distinguishable.push_back(k);
  }
  if (distinguishable.empty()) return {};
  sum_of_best(pairs, [&](const Distances& pair) {
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t k : distinguishable) least = std::min(least, pair.squares[k]);
    return least;
  });
  std::vector<PressPair> presses;
  for (std::size_t k = 0; k < std::min(kPresses, pairs.size()); ++k) presses.push_back(pairs[k].pair);
  return presses;
}

std::string describe(const std::vector<PressPair>& presses, const ArrayDescription& array) {
  std::string text;
  for (const PressPair& press : presses) {
    text += fmt::format("{} {} and {} {}with {:g} N each", text.empty() ? "press" : ",", array.taxel_name(press.first),
                        array.taxel_name(press.second), text.empty() ? "together " : "", press.newtons);
  }
  return text;
}

}  // namespace dermis::learn::calibration
