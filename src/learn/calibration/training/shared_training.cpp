// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/training/shared_training.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/touch/network/levenberg_marquardt.hpp"
#include "learn/calibration/training/force_levels.hpp"
#include "learn/calibration/training/force_problem.hpp"
#include "learn/calibration/training/shared_loads.hpp"
#include "learn/calibration/training/temperature_levels.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kMostHiddenUnits = 3;
constexpr std::size_t kLeastSharesOfBend = 8;  // fewer single taxels differ by more than the law bends
constexpr std::size_t kLevelsPerHiddenUnit = 7;
constexpr std::size_t kStarts = 6;
constexpr int kMaxIterations = 120;
constexpr std::size_t kMostSharesForStart = 15'000;  // taxels of all loads together, thinned out evenly beyond:
constexpr std::size_t kMostShares = 200'000;         // to choose among the starts, and for the final training
constexpr double kGainDeviation = 0.15;  // of a gain: docs/reasons/derivations-forces.md, "Spread of the taxels"
constexpr double kMostGain = 4.0;
constexpr double kTaxelsOfPrior = 4.0;  // that kGainDeviation is worth where taxels say how they differ
constexpr int kGainRounds = 3;
constexpr std::size_t kFolds = 5;
constexpr std::uint64_t kSeed = 20;
// A residual is the error over newtons + typical load: about half the relative error of a typical load.
constexpr double kRelativeErrorOfResidual = 2.0;
constexpr double kExpectedResidual = 0.05 / kRelativeErrorOfResidual;  // scale of the prior, before the data say better

/// The part of a load that one taxel carries.
struct Share {
  std::size_t taxel = 0;
  ForceNetwork::Inputs inputs;
};

/// A load as the training sees it: the sum over `shares` is to be `newtons`.
struct SharedLoad {
  std::vector<Share> shares;
  double newtons = 0.0;
  double weight = 0.0;  // 1 / (newtons + typical load)
};

/// Different forces; a load on several taxels is one of its own.
std::size_t levels_of(const std::vector<MeasuredLoad>& loads) {
  std::vector<double> single;
  for (const MeasuredLoad& load : loads) {
    if (load.excess.size() == 1) single.push_back(load.load_newtons);
  }
  std::sort(single.begin(), single.end());
  return loads.size() - single.size() + count_levels(single);
}

/// Single taxels under about the same force: that they differ is their scatter, and says nothing of their law.
bool are_one_load(const std::vector<MeasuredLoad>& loads) {
  const auto [lightest, heaviest] = std::minmax_element(
      loads.begin(), loads.end(), [](const auto& a, const auto& b) { return a.load_newtons < b.load_newtons; });
  return heaviest->load_newtons < kLeastForceRange * lightest->load_newtons &&
         std::all_of(loads.begin(), loads.end(), [](const MeasuredLoad& load) { return load.excess.size() == 1; });
}

/// The scatter of readings within a load says nothing of the law between loads: that of material with memory would
/// make the law a stair.
PowerPrior power_prior(const std::vector<MeasuredLoad>& loads) {
  if (are_one_load(loads)) return PowerPrior::held;
  std::size_t shares = 0;
  for (const MeasuredLoad& load : loads) shares += load.excess.size();
  const bool are_few = levels_of(loads) < kLeastLevelsOfBend || shares < kLeastSharesOfBend;
  return are_few ? PowerPrior::straight : PowerPrior::free;
}

NetworkPrior prior_of(const std::vector<MeasuredLoad>& loads, const SampleTemperatures& temperatures) {
  NetworkPrior prior{power_prior(loads), TemperaturePrior::free, temperatures.span.half_span_celsius};
  std::vector<WarmLoad> warm;
  for (const MeasuredLoad& load : loads) warm.push_back({load.load_newtons, load.temperature});
  if (temperatures.is_input) prior.temperature = temperature_prior(std::move(warm), temperatures.span);
  return prior;
}

std::vector<std::size_t> terms_of(const std::vector<MeasuredLoad>& loads) {
  std::vector<std::size_t> terms;
  for (const MeasuredLoad& load : loads) terms.push_back(load.excess.size());
  return terms;
}

/// The least-squares problem for given gains; its parameters are the free values of the network.
class SharedProblem {
 public:
  SharedProblem(const std::vector<MeasuredLoad>& raw, const SampleTemperatures& temperatures,
                const UnloadedFit& unloaded)
      : prior_(prior_of(raw, temperatures)),
        gain_(unloaded.noise_siemens.size(), 1.0),
        samples_(force_shape(temperatures.is_input, 0).inputs, touch::network::Estimate::sum_of_exponentials,
                 terms_of(raw)) {
    double log_newtons = 0.0;
    double active = 0.0;
    double active_siemens = 0.0;
    for (const MeasuredLoad& load : raw) {
      log_newtons += std::log(load.newtons) / static_cast<double>(raw.size());
      for (const auto& [taxel, siemens] : load.excess) {
        heaviest_siemens_ = std::max(heaviest_siemens_, siemens);
        if (siemens <= kMeasurableSigmas * unloaded.noise_siemens[taxel]) continue;
        active += 1.0;
        active_siemens += siemens;
      }
    }
    const double typical_newtons = std::exp(log_newtons);
    reference_siemens_ = active_siemens / active;
    typical_share_newtons_ = typical_newtons * static_cast<double>(raw.size()) / active;
    ForceNetwork scale;
    scale.reference_siemens = reference_siemens_;
    for (const MeasuredLoad& load : raw) {
      SharedLoad& shared = loads_.emplace_back();
      shared.newtons = load.newtons;
      shared.weight = 1.0 / (load.newtons + typical_newtons);
      for (const auto& [taxel, siemens] : load.excess) {
        shared.shares.push_back({taxel, scale.inputs(siemens, load.temperature)});
      }
    }
    set_samples(force_shape(temperatures.is_input, 0).inputs);
    set_factors();
  }

  [[nodiscard]] const std::vector<SharedLoad>& loads() const { return loads_; }
  [[nodiscard]] const std::vector<double>& gain() const { return gain_; }

  void set_gain(std::vector<double> gain) {
    gain_ = std::move(gain);
    set_factors();
  }

  [[nodiscard]] ForceNetwork network(const touch::network::PerceptronShape& shape, std::span<const double> free) const {
    ForceNetwork network;
    network.shape = shape;
    network.reference_siemens = reference_siemens_;
    network.heaviest_siemens = heaviest_siemens_;
    network.heaviest_newtons = std::numeric_limits<double>::infinity();
    network.parameters.resize(shape.parameter_count());
    touch::network::monotone::parameters(shape, free, network.parameters);
    return network;
  }

  [[nodiscard]] std::vector<double> start(const touch::network::PerceptronShape& shape, std::uint64_t seed) const {
    Random random(seed);
    return random_start(shape, typical_share_newtons_, random);
  }

  /// Not to outlive this.
  [[nodiscard]] ForceProblem least_squares(const touch::network::PerceptronShape& shape) const {
    return {shape, samples_, prior_, kExpectedResidual};
  }

 private:
  void set_samples(std::size_t inputs) {
    for (std::size_t k = 0; k < loads_.size(); ++k) {
      samples_.set_target(k, loads_[k].newtons, loads_[k].weight);
      for (std::size_t i = 0; i < loads_[k].shares.size(); ++i)
        samples_.set_input(k, i, std::span(loads_[k].shares[i].inputs).first(inputs));
    }
  }

  void set_factors() {
    for (std::size_t k = 0; k < loads_.size(); ++k) {
      for (std::size_t i = 0; i < loads_[k].shares.size(); ++i)
        samples_.set_factor(k, i, gain_[loads_[k].shares[i].taxel]);
    }
  }

  std::vector<SharedLoad> loads_;
  NetworkPrior prior_;
  std::vector<double> gain_;  // [taxels]
  touch::network::PerceptronSamples samples_;
  double reference_siemens_ = 1.0;
  double heaviest_siemens_ = 0.0;
  double typical_share_newtons_ = 1.0;
};

/// A trained set of free parameters.
struct Candidate {
  touch::network::PerceptronShape shape;
  std::vector<double> free;
  double error = std::numeric_limits<double>::infinity();          // of the training
  double leave_one_out = std::numeric_limits<double>::infinity();  // mean square
};

bool has_lower_error(const Candidate& a, const Candidate& b) {
  return a.error < b.error;
}
bool generalises_better(const Candidate& a, const Candidate& b) {
  return a.leave_one_out < b.leave_one_out;
}

void train(const SharedProblem& problem, Candidate& candidate) {
  ForceProblem least_squares = problem.least_squares(candidate.shape);
  touch::network::LevenbergMarquardtOptions options;
  options.relative_reduction = 1e-6;
  options.max_iterations = kMaxIterations;
  candidate.error = touch::network::minimise(least_squares, candidate.free, options).final_error;
}

void train_and_judge(const SharedProblem& problem, Candidate& candidate) {
  train(problem, candidate);
  candidate.leave_one_out = problem.least_squares(candidate.shape).leave_one_out_mean_square(candidate.free);
}

/// Hidden units that loads of so few different forces allow. With a handful of weights, each on many taxels, a network
/// that can bend learns a stair with the weights as its steps. It is right on every left-out load, because the other
/// taxels carried the same weight, and wrong between the weights.
std::size_t most_hidden_units(const std::vector<MeasuredLoad>& loads) {
  return std::min(kMostHiddenUnits, levels_of(loads) / kLevelsPerHiddenUnit);
}

/// The best of several starts for every number of hidden units.
std::vector<Candidate> best_starts(const SharedProblem& problem, bool uses_temperature, std::size_t most_hidden) {
  std::vector<Candidate> candidates((most_hidden + 1) * kStarts);
  parallel_for(candidates.size(), [&](std::size_t k) {
    candidates[k].shape = force_shape(uses_temperature, k / kStarts);
    candidates[k].free = problem.start(candidates[k].shape, kSeed + k % kStarts);
    train(problem, candidates[k]);
  });
  std::vector<Candidate> best;
  for (auto first = candidates.begin(); first != candidates.end(); first += kStarts) {
    best.push_back(std::move(*std::min_element(first, first + kStarts, has_lower_error)));
  }
  return best;
}

/// Trains every size on, and gives the one that generalises best.
Candidate choose_size(const SharedProblem& problem, std::vector<Candidate>& candidates) {
  parallel_for(candidates.size(), [&](std::size_t k) { train_and_judge(problem, candidates[k]); });
  return *std::min_element(candidates.begin(), candidates.end(), generalises_better);
}

/// Gains for a given network: ridge regression of the loads on the forces of their taxels.
class GainFit {
 public:
  GainFit(const SharedProblem& problem, const ForceNetwork& network, double residual)
      : problem_(problem), ridge_(std::pow(residual / kGainDeviation, 2)) {
    for (const SharedLoad& load : problem.loads()) {
      std::vector<double>& row = forces_.emplace_back();
      for (const Share& share : load.shares) row.push_back(load.weight * std::exp(network.log_newtons(share.inputs)));
    }
  }

  /// Fitted to the loads that are not in fold `held_out` of kFolds; kFolds holds out none.
  [[nodiscard]] std::vector<double> gains(std::size_t held_out) const {
    const std::size_t taxels = problem_.gain().size();
    Eigen::MatrixXd normal = ridge_ * Eigen::MatrixXd::Identity(index(taxels), index(taxels));
    Eigen::VectorXd right = Eigen::VectorXd::Constant(index(taxels), ridge_);
    for (std::size_t k = 0; k < forces_.size(); ++k) {
      if (k % kFolds == held_out) continue;
      const SharedLoad& load = problem_.loads()[k];
      for (std::size_t i = 0; i < load.shares.size(); ++i) {
        const Eigen::Index row = index(load.shares[i].taxel);
        right[row] += forces_[k][i] * load.weight * load.newtons;
        for (std::size_t j = 0; j <= i; ++j) {  // shares are in rising order: the lower triangle
          normal(row, index(load.shares[j].taxel)) += forces_[k][i] * forces_[k][j];
        }
      }
    }
    const Eigen::VectorXd solution = normal.selfadjointView<Eigen::Lower>().llt().solve(right);
    std::vector<double> gains(solution.begin(), solution.end());
    for (double& gain : gains) gain = std::clamp(gain, 1.0 / kMostGain, kMostGain);
    return gains;
  }

  /// Mean square residual of loads that the gains were not fitted to.
  [[nodiscard]] double held_out_mean_square() const {
    std::vector<double> squares(kFolds);
    parallel_for(kFolds, [&](std::size_t fold) { squares[fold] = mean_square(gains(fold), fold); });
    double sum = 0.0;
    for (const double square : squares) sum += square;
    return sum / static_cast<double>(forces_.size());
  }

 private:
  static Eigen::Index index(std::size_t value) { return static_cast<Eigen::Index>(value); }

  [[nodiscard]] double mean_square(const std::vector<double>& gains, std::size_t fold) const {
    double sum = 0.0;
    for (std::size_t k = fold; k < forces_.size(); k += kFolds) {
      const SharedLoad& load = problem_.loads()[k];
      double residual = -load.weight * load.newtons;
      for (std::size_t i = 0; i < load.shares.size(); ++i) residual += gains[load.shares[i].taxel] * forces_[k][i];
      sum += residual * residual;
    }
    return sum;
  }

  const SharedProblem& problem_;
  double ridge_;
  std::vector<std::vector<double>> forces_;  // weighted, of every share
};

/// The errors of the loads as if each were left out. The leverage covers the network's parameters but not the gains. So
/// the errors are scaled by the ratio at which held-out loads are worse, or not at all.
std::vector<TestedLoad> tested_loads(const std::vector<MeasuredLoad>& raw, const SharedProblem& problem,
                                     const Candidate& chosen, double scale) {
  std::vector<std::size_t> touches;
  for (const MeasuredLoad& load : raw) {
    touches.push_back(load.touch * problem.gain().size() + load.excess.front().first);
  }
  const std::vector<touch::network::FittedResidual> fitted =
      problem.least_squares(chosen.shape).fitted(chosen.free, touches);
  std::vector<TestedLoad> tested;
  for (std::size_t k = 0; k < raw.size(); ++k) {
    const double newtons_per_residual = scale / problem.loads()[k].weight;
    TestedLoad& load = tested.emplace_back(TestedLoad{raw[k].sample, {}, raw[k].newtons});
    for (const auto& [taxel, siemens] : raw[k].excess) load.taxels.push_back(taxel);
    load.residual_n = newtons_per_residual * fitted[k].residual;
    load.noise_n = newtons_per_residual * fitted[k].as_noise();
    load.error_n = newtons_per_residual * fitted[k].as_new_error();
    load.leverage = fitted[k].leverage;
    load.touch = raw[k].touch;
  }
  return tested;
}

/// The most that one taxel carried; never more than its load.
double heaviest_share(const SharedProblem& problem, const ForceNetwork& network) {
  double heaviest = 0.0;
  for (const SharedLoad& load : problem.loads()) {
    for (const Share& share : load.shares) {
      const double newtons = problem.gain()[share.taxel] * std::exp(network.log_newtons(share.inputs));
      heaviest = std::max(heaviest, std::min(newtons, load.newtons));
    }
  }
  return heaviest;
}

/// The errors of the loads on single taxels as those of taxels that were never pressed: the network alone, without the
/// gain. The p parameters that absorb the differences between taxels leave n - p of n taxels as evidence on it. Prior
/// knowledge of sheets counts as kTaxelsOfPrior more. A new taxel's variance is larger by 1 + p / n. The scatter is
/// itself uncertain, so the variance of Student's distribution of f degrees of freedom, f / (f - 2), is a factor, too.
std::vector<TestedLoad> tested_as_unpressed(const std::vector<MeasuredLoad>& raw, const SharedProblem& problem,
                                            const ForceNetwork& network, const Candidate& chosen) {
  std::vector<std::size_t> places;
  for (const MeasuredLoad& load : raw) places.push_back(load.excess.front().first);
  const std::vector<touch::network::FittedResidual> fitted =
      problem.least_squares(chosen.shape).fitted(chosen.free, places);
  std::vector<TestedLoad> tested;
  std::set<std::size_t> taxels;
  double leverages = 0.0;
  for (std::size_t k = 0; k < raw.size(); ++k) {
    const SharedLoad& load = problem.loads()[k];
    if (load.shares.size() != 1) continue;
    const Share& share = load.shares.front();
    taxels.insert(share.taxel);
    leverages += fitted[k].common_leverage;
    const double estimate = std::exp(network.log_newtons(share.inputs));
    const double error_n = load.newtons - load.newtons * load.newtons / estimate;  // sigma is a share of the estimate
    tested.push_back({raw[k].sample, {share.taxel}, load.newtons, error_n, 0.0, error_n});
  }
  const auto count = static_cast<double>(taxels.size());
  const double parameters = leverages * count / static_cast<double>(std::max<std::size_t>(tested.size(), 1));
  const double freedom = std::max(count - parameters, 0.0) + kTaxelsOfPrior;
  const double wider = (1.0 + std::max(parameters, 1.0) / count) * freedom / (freedom - 2.0);
  for (TestedLoad& load : tested) {
    const double prior_n = kGainDeviation * load.newtons;
    const double square = (count * load.error_n * load.error_n + kTaxelsOfPrior * prior_n * prior_n) / freedom;
    load.error_n = std::sqrt(wider * square);
  }
  return tested;
}

}  // namespace

SharedNetwork train_shared(const SampleDatabase& database, const SampleTemperatures& temperatures,
                           const UnloadedFit& unloaded, const std::vector<bool>& dead) {
  const SharedLoads all(database, temperatures, unloaded, dead);
  const std::vector<MeasuredLoad> loads = all.loads(kMostShares);
  SharedNetwork shared;
  shared.gain.assign(dead.size(), 1.0);
  if (loads.empty()) return shared;

  SharedProblem problem(loads, temperatures, unloaded);
  const SharedProblem thinned(all.loads(kMostSharesForStart), temperatures, unloaded);
  std::vector<Candidate> candidates = best_starts(thinned, temperatures.is_input, most_hidden_units(loads));
  Candidate chosen = choose_size(problem, candidates);
  double mean_square = chosen.leave_one_out;
  for (int round = 0; round < kGainRounds; ++round) {
    const GainFit fit(problem, problem.network(chosen.shape, chosen.free), std::sqrt(mean_square));
    const double with_gains = fit.held_out_mean_square();
    if (with_gains >= mean_square) break;
    mean_square = with_gains;
    shared.has_gains = true;
    problem.set_gain(fit.gains(kFolds));
    chosen = choose_size(problem, candidates);
  }
  shared.network = problem.network(chosen.shape, chosen.free);
  shared.gain = problem.gain();
  shared.heaviest_newtons = heaviest_share(problem, shared.network);
  shared.tested = tested_loads(loads, problem, chosen, std::max(std::sqrt(mean_square / chosen.leave_one_out), 1.0));
  shared.tested_unpressed = tested_as_unpressed(loads, problem, shared.network, chosen);
  shared.leave_one_out_error = kRelativeErrorOfResidual * std::sqrt(mean_square);
  return shared;
}

}  // namespace dermis::learn::calibration
