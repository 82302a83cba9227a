// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/shared_training.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dermis/core/parallel.hpp"
#include "dermis/network/levenberg_marquardt.hpp"

namespace dermis::calibration {
namespace {

constexpr std::size_t kMostHiddenUnits = 3;
constexpr std::size_t kStarts = 6;
constexpr int kMaxIterations = 120;
constexpr std::size_t kMostSharesForStart = 15'000;  // taxels of all loads together, thinned out evenly beyond:
constexpr std::size_t kMostShares = 300'000;         // to choose among the starts, and for the final training
constexpr double kActive = 3.0;                      // in standard deviations of the unloaded reading
constexpr double kExpectedError = 0.05;              // relative error of a load, before the data say better
constexpr double kGainDeviation = 0.15;              // of ln(gain): literature.md B, taxel-to-taxel 10-20 %
constexpr std::uint64_t kSeed = 20;

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

/// All loads of the database with the excess conductances of their taxels, before normalisation.
struct RawLoad {
  std::vector<std::pair<std::size_t, double>> excess;  // taxel, siemens > 0
  double temperature = 0.0;
  double newtons = 0.0;
};

class LoadCollector {
 public:
  LoadCollector(const SampleDatabase& database, const TemperatureSpan& span, const UnloadedFit& unloaded,
                const std::vector<bool>& dead)
      : span_(span), unloaded_(unloaded), dead_(dead) {
    for (const Sample& sample : database.samples) {
      for (const TotalForce& total : sample.totals) add(sample, total.taxels, total.newtons);
      for (std::size_t taxel = 0; taxel < dead.size(); ++taxel) {
        const double newtons = sample.known_newtons[taxel];
        if (newtons > 0.0) add(sample, {taxel}, newtons);
      }
    }
  }

  /// All loads, or as many of them, evenly, as hold about `most_shares` taxels.
  [[nodiscard]] std::vector<RawLoad> loads(std::size_t most_shares) const {
    std::size_t shares = 0;
    for (const RawLoad& load : loads_) shares += load.excess.size();
    if (shares <= most_shares) return loads_;
    const std::size_t count = std::max<std::size_t>(loads_.size() * most_shares / shares, 1);
    std::vector<RawLoad> kept;
    for (std::size_t k = 0; k < count; ++k) kept.push_back(loads_[k * loads_.size() / count]);
    return kept;
  }

 private:
  void add(const Sample& sample, const std::vector<std::size_t>& taxels, double newtons) {
    RawLoad load;
    load.newtons = newtons;
    if (span_.is_input) load.temperature = temperature_offset(sample, span_) / span_.half_span_celsius;
    bool is_felt = false;
    for (const std::size_t taxel : taxels) {
      if (dead_[taxel]) continue;
      const double excess = excess_siemens(sample, taxel, unloaded_, span_);
      if (excess <= 0.0) continue;
      load.excess.emplace_back(taxel, excess);
      is_felt = is_felt || excess > kActive * unloaded_.noise_siemens[taxel];
    }
    if (is_felt) loads_.push_back(std::move(load));
  }

  const TemperatureSpan& span_;
  const UnloadedFit& unloaded_;
  const std::vector<bool>& dead_;
  std::vector<RawLoad> loads_;
};

/// The least-squares problem: parameters are those of the network (free values), then ln(gain) of every taxel that some
/// load presses, where there are gains.
class SharedProblem {
 public:
  SharedProblem(const std::vector<RawLoad>& raw, const UnloadedFit& unloaded) {
    double log_newtons = 0.0;
    double active = 0.0;
    double active_siemens = 0.0;
    for (const RawLoad& load : raw) {
      log_newtons += std::log(load.newtons) / static_cast<double>(raw.size());
      for (const auto& [taxel, siemens] : load.excess) {
        heaviest_siemens_ = std::max(heaviest_siemens_, siemens);
        if (siemens <= kActive * unloaded.noise_siemens[taxel]) continue;
        active += 1.0;
        active_siemens += siemens;
      }
    }
    typical_newtons_ = std::exp(log_newtons);
    reference_siemens_ = active_siemens / active;
    typical_share_newtons_ = typical_newtons_ * static_cast<double>(raw.size()) / active;
    ForceNetwork scale;
    scale.reference_siemens = reference_siemens_;
    gain_of_taxel_.assign(unloaded.noise_siemens.size(), 0);
    for (const RawLoad& load : raw) {
      SharedLoad& shared = loads_.emplace_back();
      shared.newtons = load.newtons;
      shared.weight = 1.0 / (load.newtons + typical_newtons_);
      for (const auto& [taxel, siemens] : load.excess) {
        shared.shares.push_back({taxel, scale.inputs(siemens, load.temperature)});
        if (gain_of_taxel_[taxel] == 0) gain_of_taxel_[taxel] = ++gain_count_;
      }
    }
  }

  [[nodiscard]] std::size_t load_count() const { return loads_.size(); }
  [[nodiscard]] std::size_t gain_count() const { return gain_count_; }

  [[nodiscard]] ForceNetwork empty_network(const network::PerceptronShape& shape) const {
    ForceNetwork network;
    network.shape = shape;
    network.reference_siemens = reference_siemens_;
    network.heaviest_siemens = heaviest_siemens_;
    network.heaviest_newtons = std::numeric_limits<double>::infinity();
    network.parameters.resize(shape.parameter_count());
    return network;
  }

  [[nodiscard]] std::vector<double> start(const network::PerceptronShape& shape, std::uint64_t seed) const {
    Random random(seed);
    return random_start(shape, typical_share_newtons_, random);
  }

  [[nodiscard]] std::size_t residual_count(std::size_t parameters) const { return loads_.size() + parameters; }

  /// Residuals of the loads, then of the prior. `error`: expected relative error of a load.
  [[nodiscard]] network::ResidualFunction residual_function(const network::PerceptronShape& shape, bool with_gains,
                                                            double error) const {
    return [this, shape, with_gains, error, network = empty_network(shape), gradient = std::vector<double>()](
               std::span<const double> free, std::span<double> residuals, std::span<double> jacobian) mutable {
      const std::size_t n = shape.parameter_count();
      const std::size_t columns = free.size();
      gradient.resize(n);
      network::monotone::parameters(shape, free.first(n), network.parameters);
      for (std::size_t k = 0; k < loads_.size(); ++k) {
        const SharedLoad& load = loads_[k];
        const std::span<double> row = jacobian.empty() ? jacobian : jacobian.subspan(k * columns, columns);
        std::fill(row.begin(), row.end(), 0.0);
        double sum = 0.0;
        for (const Share& share : load.shares) {
          const std::size_t gain_place = n + gain_of_taxel_[share.taxel] - 1;
          const double gain = with_gains ? std::exp(free[gain_place]) : 1.0;
          const double newtons =
              gain * std::exp(network.log_newtons(share.inputs, row.empty() ? row : std::span<double>(gradient)));
          sum += newtons;
          if (row.empty()) continue;
          for (std::size_t p = 0; p < n; ++p) row[p] += load.weight * newtons * gradient[p];
          if (with_gains) row[gain_place] += load.weight * newtons;
        }
        residuals[k] = load.weight * (sum - load.newtons);
      }
      // A load's residual is its error over newtons + typical: about half the relative error.
      const double scale = 0.5 * error;
      const std::span<double> prior = jacobian.empty() ? jacobian : jacobian.subspan(loads_.size() * columns);
      prior_residuals(network, scale, residuals.subspan(loads_.size(), n), prior, columns);
      for (std::size_t k = n; k < columns; ++k) {
        residuals[loads_.size() + k] = scale / kGainDeviation * free[k];
        if (jacobian.empty()) continue;
        const std::span<double> row = prior.subspan(k * columns, columns);
        std::fill(row.begin(), row.end(), 0.0);
        row[k] = scale / kGainDeviation;
      }
    };
  }

  [[nodiscard]] std::vector<double> gains(std::span<const double> log_gains) const {
    std::vector<double> gains(gain_of_taxel_.size(), 1.0);
    for (std::size_t taxel = 0; taxel < gains.size(); ++taxel) {
      if (gain_of_taxel_[taxel] > 0 && !log_gains.empty())
        gains[taxel] = std::exp(log_gains[gain_of_taxel_[taxel] - 1]);
    }
    return gains;
  }

 private:
  std::vector<SharedLoad> loads_;
  std::vector<std::size_t> gain_of_taxel_;  // 1 + place among the gains; 0: never pressed
  std::size_t gain_count_ = 0;
  double reference_siemens_ = 1.0;
  double heaviest_siemens_ = 0.0;
  double typical_newtons_ = 1.0;
  double typical_share_newtons_ = 1.0;
};

/// A trained set of free parameters.
struct Candidate {
  network::PerceptronShape shape;
  bool with_gains = false;
  std::vector<double> free;
  double error = std::numeric_limits<double>::infinity();          // of the training
  double leave_one_out = std::numeric_limits<double>::infinity();  // mean square
};

void train(const SharedProblem& problem, double expected_error, Candidate& candidate) {
  const auto function = problem.residual_function(candidate.shape, candidate.with_gains, expected_error);
  const std::size_t residuals = problem.residual_count(candidate.free.size());
  network::LevenbergMarquardtOptions options;
  options.relative_reduction = 1e-6;
  options.max_iterations = kMaxIterations;
  candidate.error = network::minimise(function, residuals, candidate.free, options).final_error;
  candidate.leave_one_out =
      network::leave_one_out_mean_square(function, problem.load_count(), residuals, candidate.free);
}

bool has_lower_error(const Candidate& a, const Candidate& b) {
  return a.error < b.error;
}
bool generalises_better(const Candidate& a, const Candidate& b) {
  return a.leave_one_out < b.leave_one_out;
}

/// The best of several starts for every number of hidden units.
std::vector<Candidate> best_starts(const SharedProblem& problem, bool uses_temperature) {
  std::vector<Candidate> candidates((kMostHiddenUnits + 1) * kStarts);
  parallel_for(candidates.size(), [&](std::size_t k) {
    candidates[k].shape = force_shape(uses_temperature, k / kStarts);
    candidates[k].free = problem.start(candidates[k].shape, kSeed + k % kStarts);
    train(problem, kExpectedError, candidates[k]);
  });
  std::vector<Candidate> best;
  for (auto first = candidates.begin(); first != candidates.end(); first += kStarts) {
    best.push_back(std::move(*std::min_element(first, first + kStarts, has_lower_error)));
  }
  return best;
}

/// Trains every candidate to the end, without gains and with them, and keeps what generalises best.
Candidate choose(const SharedProblem& problem, std::vector<Candidate> candidates) {
  parallel_for(candidates.size(), [&](std::size_t k) { train(problem, kExpectedError, candidates[k]); });
  const auto plain = std::min_element(candidates.begin(), candidates.end(), generalises_better);
  const double seen_error = 2.0 * std::sqrt(plain->leave_one_out);
  std::vector<Candidate> with_gains = candidates;
  parallel_for(with_gains.size(), [&](std::size_t k) {
    with_gains[k].with_gains = true;
    with_gains[k].free.resize(with_gains[k].free.size() + problem.gain_count(), 0.0);
    train(problem, seen_error, with_gains[k]);
  });
  const auto gained = std::min_element(with_gains.begin(), with_gains.end(), generalises_better);
  return generalises_better(*gained, *plain) ? *gained : *plain;
}

}  // namespace

SharedNetwork train_shared(const SampleDatabase& database, const TemperatureSpan& span, const UnloadedFit& unloaded,
                           const std::vector<bool>& dead) {
  const LoadCollector collector(database, span, unloaded, dead);
  const std::vector<RawLoad> loads = collector.loads(kMostShares);
  SharedNetwork shared;
  shared.gain.assign(dead.size(), 1.0);
  if (loads.empty()) return shared;
  const SharedProblem problem(loads, unloaded);

  const SharedProblem thinned(collector.loads(kMostSharesForStart), unloaded);
  const Candidate chosen = choose(problem, best_starts(thinned, span.is_input));

  const std::size_t n = chosen.shape.parameter_count();
  shared.network = problem.empty_network(chosen.shape);
  network::monotone::parameters(chosen.shape, std::span<const double>(chosen.free).first(n), shared.network.parameters);
  shared.gain = problem.gains(std::span<const double>(chosen.free).subspan(n));
  shared.has_gains = chosen.with_gains;
  shared.leave_one_out_error = 2.0 * std::sqrt(chosen.leave_one_out);
  return shared;
}

}  // namespace dermis::calibration
