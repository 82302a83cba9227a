// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/learning/unknown_learning.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "learn/recognition/answer/rank_table.hpp"

namespace dermis::learn::recognition {
namespace {

constexpr double kKnownShare = 0.95;  // of new touches of known classes shall not be called unknown
constexpr double kConfidence = 0.95;

/// The data for the unknown score, of several examples.
struct Observations {
  std::vector<std::vector<double>> distances;  ///< [experts][examples] to the class that was answered
  std::vector<double> doubts;                  ///< [examples] 1 - largest probability
};

/// `without_their_class`: as if the right class of each example had not been learned; of those that leaves no answer
/// for there is none.
Observations observe(Judged judged, const Matrix& scores, const std::vector<Matrix>& distances,
                     bool without_their_class) {
  // So many examples allow no greater certainty: after n right ones the next may be wrong by 1 / (n + 2).
  const double least_doubt = 1.0 / static_cast<double>(judged.classes.size() + 2);
  Observations result{std::vector<std::vector<double>>(distances.size()), {}};
  for (std::size_t i = 0; i < judged.classes.size(); ++i) {
    if (!judged.counts(i)) continue;
    const auto row = static_cast<Eigen::Index>(i);
    std::uint8_t& is_known = judged.is_known[judged.fold_of[i]][judged.classes[i]];
    if (without_their_class) is_known = 0;
    const std::vector<std::uint8_t>& answers = judged.is_known[judged.fold_of[i]];
    if (std::find(answers.begin(), answers.end(), 1) == answers.end()) {
      is_known = 1;
      continue;
    }
    Matrix probabilities = scores.row(row);
    softmax({{0}, {0}, {answers}}, probabilities);
    is_known = 1;
    Eigen::Index answer = 0;
    result.doubts.push_back(std::max(1.0 - probabilities.row(0).maxCoeff(&answer), least_doubt));
    for (std::size_t expert = 0; expert < distances.size(); ++expert) {
      result.distances[expert].push_back(distances[expert](row, answer));
    }
  }
  return result;
}

/// Ranks of the distances by each expert, then of the doubts: [experts + 1][examples]. Each is among the others, as a
/// new touch is among them.
std::vector<std::vector<double>> ranks_of_known(const Observations& known) {
  std::vector<std::vector<double>> ranks;
  for (const std::vector<double>& distances : known.distances) ranks.push_back(ranks_among_others(distances));
  ranks.push_back(ranks_among_others(known.doubts));
  return ranks;
}

/// The same, of what is not in the tables of the classes.
std::vector<std::vector<double>> ranks_of_unknown(const Classes& classes, const Observations& observations) {
  std::vector<std::vector<double>> ranks;
  const auto add = [&](const std::vector<float>& table, const std::vector<double>& values) {
    ranks.emplace_back();
    for (const double value : values) ranks.back().push_back(rank_in(table, value));
  };
  for (std::size_t expert = 0; expert < classes.experts.size(); ++expert) {
    add(classes.experts[expert].distances, observations.distances[expert]);
  }
  add(classes.doubts, observations.doubts);
  return ranks;
}

/// Weights >= 0, of sum 1, of the logistic regression that distinguishes the two.
std::vector<double> discriminating_weights(const std::vector<std::vector<double>>& known,
                                           const std::vector<std::vector<double>>& unknown) {
  const std::size_t count = known.front().size();
  const std::size_t both = count + unknown.front().size();
  Judged judged;
  judged.classes.assign(count, 0);
  judged.classes.resize(both, 1);
  judged.fold_of.assign(both, 0);
  judged.is_known = {{1, 1}};
  std::vector<Matrix> scores(known.size() + 1, Matrix::Zero(static_cast<Eigen::Index>(both), 2));
  for (std::size_t rank = 0; rank < known.size(); ++rank) {
    for (std::size_t i = 0; i < both; ++i) {
      scores[rank](static_cast<Eigen::Index>(i), 1) = i < count ? known[rank][i] : unknown[rank][i - count];
    }
  }
  scores.back().col(0).setOnes();  // the threshold between both
  std::vector<double> weights = fuse(judged, scores);
  weights.pop_back();
  double sum = 0.0;
  for (const double weight : weights) sum += weight;
  for (double& weight : weights) weight = sum > 0.0 ? weight / sum : 1.0 / static_cast<double>(weights.size());
  return weights;
}

/// Half for the doubt, half for the distances: where nothing is left to learn from when a class is taken away.
std::vector<double> even_weights(std::size_t experts) {
  std::vector<double> weights(experts, 0.5 / static_cast<double>(experts));
  weights.push_back(0.5);
  return weights;
}

std::vector<double> weights_of(const Classes& classes, const std::vector<std::vector<double>>& known,
                               const Observations& unknown) {
  const bool can_be_learned = classes.names.size() > 2 && !unknown.doubts.empty();
  return can_be_learned ? discriminating_weights(known, ranks_of_unknown(classes, unknown))
                        : even_weights(classes.experts.size());
}

/// How many of n scores may lie above a limit that, as sure as kConfidence, has the share of all below it (S. S. Wilks,
/// "Determination of sample sizes for setting tolerance limits", 1941), and one: 0 where n scores are too few.
std::size_t place_from_above(std::size_t scores) {
  const auto count = static_cast<double>(scores);
  double log_chance = count * std::log(kKnownShare);  // that `above` scores lie above the quantile of all
  double chance_of_fewer = 0.0;
  std::size_t above = 0;
  while (above < scores && chance_of_fewer + std::exp(log_chance) <= 1.0 - kConfidence) {
    chance_of_fewer += std::exp(log_chance);
    ++above;
    const auto number = static_cast<double>(above);
    log_chance += std::log((count - number + 1.0) / number * (1.0 - kKnownShare) / kKnownShare);
  }
  return above;
}

/// The tolerance limit of the scores (at least one): the share of new ones lies below it. Where they are too few the
/// largest goes on as an exponential tail would, whose mean is that of the upper quarter.
double unknown_from(std::vector<double> known_scores) {
  std::sort(known_scores.begin(), known_scores.end());
  const std::size_t count = known_scores.size();
  const std::size_t place = place_from_above(count);
  if (place > 0) return known_scores[count - place];
  const std::size_t upper = (count + 3) / 4;
  const double below = known_scores[count > upper ? count - upper - 1 : 0];
  double mean_excess = 0.0;
  for (std::size_t i = count - upper; i < count; ++i)
    mean_excess += (known_scores[i] - below) / static_cast<double>(upper);
  const double exceeded = 1.0 - std::pow(1.0 - kConfidence, 1.0 / static_cast<double>(count));  // the largest, at most
  return known_scores.back() + mean_excess * std::log(exceeded / (1.0 - kKnownShare));
}

}  // namespace

void learn_unknown(Classes& classes, const Judged& judged, const Matrix& scores, const std::vector<Matrix>& distances) {
  const Observations known = observe(judged, scores, distances, false);
  classes.doubts = rank_table(known.doubts);
  for (std::size_t expert = 0; expert < distances.size(); ++expert) {
    classes.experts[expert].distances = rank_table(known.distances[expert]);
  }
  const std::vector<std::vector<double>> ranks = ranks_of_known(known);
  const std::vector<double> weights = weights_of(classes, ranks, observe(judged, scores, distances, true));
  for (std::size_t expert = 0; expert < distances.size(); ++expert) {
    classes.experts[expert].unknown_weight = weights[expert];
  }
  classes.doubt_weight = weights.back();
  std::vector<double> unknown_scores(known.doubts.size(), 0.0);
  for (std::size_t rank = 0; rank < ranks.size(); ++rank) {
    for (std::size_t i = 0; i < unknown_scores.size(); ++i) unknown_scores[i] += weights[rank] * ranks[rank][i];
  }
  classes.unknown_from = unknown_from(std::move(unknown_scores));
}

}  // namespace dermis::learn::recognition
