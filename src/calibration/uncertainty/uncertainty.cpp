// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/calibration/uncertainty.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "calibration/even_choice.hpp"
#include "dermis/calibration/parallel.hpp"
#include "dermis/compensation/crosstalk.hpp"
#include "dermis/core/quantile.hpp"
#include "dermis/fusion/force_fusion.hpp"

namespace dermis::calibration {
namespace {

constexpr double kOneSigmaShare = 0.682689;  // of a normal distribution within one standard deviation
constexpr double kTwoSigmaShare = 0.954500;  // within two
constexpr double kOutlierRatio = 9.0;        // of mean squares: three standard deviations
constexpr std::size_t kMostLoads = 4000;     // more do not make the estimates better
constexpr std::size_t kLoadsPerTask = 100;
constexpr double kLeastRelativeSigma = 1e-3;
constexpr double kStartRelativeSigma = 0.1;
constexpr std::size_t kLoadsPerKnot = 50;
constexpr double kUnlearnedExponent = 0.2;     // of force over conductance, relative: rubbers have 0.8 to 2
constexpr double kUnlearnedRepetition = 0.05;  // relative, where no load was repeated

/// Squares of the relative error at the knots of fusion::ForceNetworks::relative_sigma.
using Profile = std::array<double, fusion::kSigmaKnots>;

/// A tested load with the variances of the sum of its taxels' forces, by where they come from [N^2].
struct JudgedLoad {
  double square_noise = 0.0;
  double square_error = 0.0;
  double newtons = 0.0;
  double instruments = 0.0;  // ADC, temperature sensor, unloaded conductance
  double supply = 0.0;       // for a supply error of kUnitSupplyNoise, which all taxels share
  Profile material{};        // for a relative error of 1 at each knot

  [[nodiscard]] double variance(double supply_noise, const Profile& profile) const {
    const double known = instruments + std::pow(supply_noise / kUnitSupplyNoise, 2) * supply;
    return std::inner_product(profile.begin(), profile.end(), material.begin(), known);
  }

  static constexpr double kUnitSupplyNoise = 0.005;
};

/// Units 3 and 4 with a given error of the supply and networks that have hardly any of their own.
class ErrorBudget {
 public:
  static Result<ErrorBudget> create(pipeline::Model model, double supply_noise) {
    model.array.readout.supply_noise = supply_noise;
    Result<compensation::Compensator> compensator = compensation::Compensator::create(model.array);
    if (!compensator) return compensator.error();
    std::fill(model.networks.relative_sigma.begin(), model.networks.relative_sigma.end(), 1e-6F);
    std::fill(model.networks.heaviest_newtons.begin(), model.networks.heaviest_newtons.end(),
              std::numeric_limits<float>::infinity());  // noise beyond the heaviest load is no extrapolation
    return ErrorBudget(std::move(*compensator), std::move(model.networks));
  }

  /// Again the same where the sample is the last one.
  const ForceFrame& forces(const Sample& sample, double sigma_ratio) {
    if (&sample == last_) return force_;
    last_ = &sample;
    conditioned_.ratio.assign(sample.ratio.begin(), sample.ratio.end());
    conditioned_.sigma_ratio = sigma_ratio;
    conditioned_.temperature_celsius = sample.temperature_celsius;
    conditioned_.taxels = sample.taxels;
    compensator_.forget();
    compensator_.process(conditioned_, conductance_);
    conductance_.taxels.assign(sample.ratio.size(), TaxelStatus::ok);  // what is estimated was trained on, too
    fusion_.process(conductance_, force_);
    return force_;
  }

 private:
  ErrorBudget(compensation::Compensator compensator, fusion::ForceNetworks networks)
      : compensator_(std::move(compensator)), fusion_(std::move(networks)) {}

  compensation::Compensator compensator_;
  fusion::ForceFusion fusion_;
  const Sample* last_ = nullptr;
  ConditionedFrame conditioned_;
  ConductanceFrame conductance_;
  ForceFrame force_;
};

JudgedLoad judge(const TestedLoad& load, const fusion::ForceNetworks& networks, const ForceFrame& without_supply,
                 const ForceFrame& with_supply) {
  JudgedLoad judged;
  judged.square_noise = load.noise_n * load.noise_n;
  judged.square_error = load.error_n * load.error_n;
  judged.newtons = load.newtons;
  double supply_n = 0.0;
  for (const std::size_t taxel : load.taxels) {
    const auto newtons = static_cast<double>(without_supply.newtons[taxel]);
    const double square = std::pow(static_cast<double>(without_supply.sigma_newtons[taxel]), 2);
    const double square_with_supply = std::pow(static_cast<double>(with_supply.sigma_newtons[taxel]), 2);
    judged.instruments += square;
    const double place = networks.sigma_place(std::log(without_supply.newtons[taxel]));
    for (std::size_t k = 0; k < judged.material.size(); ++k) {
      const double weight = std::max(1.0 - std::abs(place - static_cast<double>(k)), 0.0);
      judged.material[k] += weight * newtons * newtons;
    }
    supply_n += std::sqrt(std::max(square_with_supply - square, 0.0));
  }
  judged.supply = supply_n * supply_n;
  return judged;
}

/// Those of one sample in a row.
std::vector<const TestedLoad*> some_of(const std::vector<TestedLoad>& loads) {
  std::vector<const TestedLoad*> chosen;
  for (const std::size_t k : even_choice(loads.size(), kMostLoads)) chosen.push_back(&loads[k]);
  std::stable_sort(chosen.begin(), chosen.end(),
                   [](const TestedLoad* a, const TestedLoad* b) { return a->sample < b->sample; });
  return chosen;
}

Result<std::vector<JudgedLoad>> judge_loads(const SampleDatabase& database, const std::vector<TestedLoad>& loads,
                                            const pipeline::Model& model) {
  const double noise_ratio = model.array.readout.adc_noise_counts / database.array.readout.adc_noise_counts;
  const Result<ErrorBudget> checked = ErrorBudget::create(model, 0.0);
  if (!checked) return checked.error();
  const std::vector<const TestedLoad*> chosen = some_of(loads);
  const std::size_t count = chosen.size();
  std::vector<JudgedLoad> judged(count);
  parallel_for((count + kLoadsPerTask - 1) / kLoadsPerTask, [&](std::size_t task) {
    Result<ErrorBudget> without_supply = ErrorBudget::create(model, 0.0);
    Result<ErrorBudget> with_supply = ErrorBudget::create(model, JudgedLoad::kUnitSupplyNoise);
    const std::size_t end = std::min(count, (task + 1) * kLoadsPerTask);
    for (std::size_t k = task * kLoadsPerTask; k < end; ++k) {
      const TestedLoad& load = *chosen[k];
      const Sample& sample = database.samples[load.sample];
      const double sigma_ratio = noise_ratio * sample.sigma_ratio;
      judged[k] = judge(load, model.networks, without_supply->forces(sample, sigma_ratio),
                        with_supply->forces(sample, sigma_ratio));
    }
  });
  Profile one;
  one.fill(1.0);
  std::erase_if(judged, [&](const JudgedLoad& load) {
    return !std::isfinite(load.variance(1.0, one)) || load.variance(0.0, one) <= load.instruments;
  });
  return judged;
}

using Square = double JudgedLoad::*;

/// Whether more loads are outside their intervals than a normal distribution has outside: of one and of two standard
/// deviations together, since the errors of a material with memory have longer tails.
bool is_too_sure(const std::vector<double>& square_scores) {
  const double one = quantile(square_scores, kOneSigmaShare);
  const double two = quantile(square_scores, kTwoSigmaShare) / 4.0;
  return one * two > 1.0;
}

/// The multiple of `profile` with which the standard deviations are right; bisection in its logarithm.
Profile scaled(const Profile& profile, const std::vector<JudgedLoad>& loads, Square square, double supply_noise) {
  double low = 1e-4;
  double high = 1e4;
  Profile result = profile;
  std::vector<double> scores(loads.size());
  constexpr int kSteps = 24;
  for (int step = 0; step < kSteps; ++step) {
    const double scale = std::sqrt(low * high);
    std::transform(profile.begin(), profile.end(), result.begin(), [&](double variance) {
      return std::max(scale * variance, kLeastRelativeSigma * kLeastRelativeSigma);
    });
    for (std::size_t k = 0; k < loads.size(); ++k)
      scores[k] = loads[k].*square / loads[k].variance(supply_noise, result);
    (is_too_sure(scores) ? low : high) = scale;
  }
  return result;
}

/// The same relative error at all forces.
Profile even_profile(const std::vector<JudgedLoad>& loads, Square square, double supply_noise) {
  Profile start;
  start.fill(kStartRelativeSigma * kStartRelativeSigma);
  return scaled(start, loads, square, supply_noise);
}

/// Minus the logarithm of the likelihood of the noise; a load beyond three standard deviations counts as three.
double surprise(const std::vector<JudgedLoad>& loads, double supply_noise) {
  if (loads.empty()) return 0.0;
  const Profile profile = even_profile(loads, &JudgedLoad::square_noise, supply_noise);
  double sum = 0.0;
  for (const JudgedLoad& load : loads) {
    const double variance = load.variance(supply_noise, profile);
    sum += 0.5 * (std::log(variance) + std::min(load.square_noise / variance, kOutlierRatio));
  }
  return sum;
}

/// What was tested, by what gives the forces.
struct JudgedLoads {
  std::vector<JudgedLoad> own;
  std::vector<JudgedLoad> shared;
  std::vector<JudgedLoad> unpressed;
  std::vector<JudgedLoad> tables;
};

Result<JudgedLoads> judge_all(const SampleDatabase& database, const ForceTraining& training,
                              const pipeline::Model& model) {
  JudgedLoads judged;
  for (const auto& [tested, result] :
       {std::pair(&training.tested_own, &judged.own), std::pair(&training.tested_shared, &judged.shared),
        std::pair(&training.tested_unpressed, &judged.unpressed), std::pair(&training.tested_tables, &judged.tables)}) {
    Result<std::vector<JudgedLoad>> loads = judge_loads(database, *tested, model);
    if (!loads) return loads.error();
    *result = *std::move(loads);
  }
  return judged;
}

/// The supply error that makes the noise of all loads likeliest.
double likeliest_supply_noise(const JudgedLoads& loads) {
  constexpr double kLowest = 1e-4;
  constexpr double kHighest = 0.05;
  constexpr double kStep = 1.1;
  double best = 0.0;
  const auto of_all = [&](double supply_noise) {
    return surprise(loads.own, supply_noise) + surprise(loads.shared, supply_noise) +
           surprise(loads.tables, supply_noise);
  };
  double least = of_all(best);
  for (double supply_noise = kLowest; supply_noise < kHighest; supply_noise *= kStep) {
    const double sum = of_all(supply_noise);
    if (sum >= least) continue;
    least = sum;
    best = supply_noise;
  }
  return best;
}

/// The relative errors at the knots that make the errors likeliest: the fixed point of the variance components of a
/// normal distribution (the multiplicative step of Lange's MM algorithm), outliers as above.
Profile likeliest_profile(const std::vector<JudgedLoad>& loads, double supply_noise) {
  Profile profile = even_profile(loads, &JudgedLoad::square_error, supply_noise);
  if (loads.size() < kLoadsPerKnot * profile.size()) return profile;
  constexpr int kSteps = 100;
  for (int step = 0; step < kSteps; ++step) {
    Profile found{};
    Profile expected{};
    for (const JudgedLoad& load : loads) {
      const double variance = load.variance(supply_noise, profile);
      const double score = std::min(load.square_error / variance, kOutlierRatio);
      for (std::size_t k = 0; k < profile.size(); ++k) {
        found[k] += load.material[k] / variance * score;
        expected[k] += load.material[k] / variance;
      }
    }
    for (std::size_t k = 0; k < profile.size(); ++k) {
      if (found[k] > 0.0) profile[k] *= std::sqrt(found[k] / expected[k]);
    }
  }
  return scaled(profile, loads, &JudgedLoad::square_error, supply_noise);
}

std::set<std::size_t> taxels_of(const std::vector<TestedLoad>& loads) {
  std::set<std::size_t> taxels;
  for (const TestedLoad& load : loads) taxels.insert(load.taxels.begin(), load.taxels.end());
  return taxels;
}

std::set<std::size_t> unpressed_taxels(const ForceTraining& training) {
  const std::set<std::size_t> own = taxels_of(training.tested_own);
  const std::set<std::size_t> shared = taxels_of(training.tested_shared);
  std::set<std::size_t> unpressed;
  const std::vector<std::size_t>& tables = training.report.table_taxels;
  for (std::size_t taxel = 0; taxel < training.networks.taxel_count(); ++taxel) {
    const bool has_table = std::binary_search(tables.begin(), tables.end(), taxel);
    if (!own.contains(taxel) && !shared.contains(taxel) && !has_table) unpressed.insert(taxel);
  }
  return unpressed;
}

/// What the noise of the samples has left in the networks stays where readings are less noisy: the least a profile is.
void add_uncertainty_of_networks(const std::vector<JudgedLoad>& loads, Profile& profile) {
  for (std::size_t k = 0; k < profile.size(); ++k) {
    double square = 0.0;
    double weight = 0.0;
    for (const JudgedLoad& load : loads) {
      const double share = load.material[k] / (load.newtons * load.newtons);
      square += share * (load.square_error - load.square_noise) / (load.newtons * load.newtons);
      weight += share;
    }
    if (weight > 0.0) profile[k] = std::max(profile[k], square / weight);
  }
}

/// What one load does not tell of the law: ln(load / newtons) times the uncertainty of its exponent.
void add_uncertainty_of_line(const fusion::ForceNetworks& networks, Profile& profile) {
  const double log_range =
      std::log(static_cast<double>(networks.sigma_knots_newtons[1] / networks.sigma_knots_newtons[0]));
  for (std::size_t k = 0; k < profile.size(); ++k) {
    const double share_of_range = 1.0 - static_cast<double>(k) / static_cast<double>(profile.size() - 1);
    profile[k] += std::pow(kUnlearnedExponent * log_range * share_of_range, 2);
  }
}

/// The profile of these taxels, in the networks and for the report.
RelativeSigma set_relative_sigma(const std::set<std::size_t>& taxels, const Profile& profile,
                                 fusion::ForceNetworks& networks) {
  RelativeSigma sigma{};
  for (std::size_t k = 0; k < profile.size(); ++k) {
    sigma[k] = std::sqrt(profile[k]);
    float* const of_taxel = networks.relative_sigma.data() + k * networks.taxel_count();
    for (const std::size_t taxel : taxels) of_taxel[taxel] = static_cast<float>(sigma[k]);
  }
  return sigma;
}

/// Knots over what single taxels carry; far below a load that many taxels share.
void place_knots(const ForceTraining& training, fusion::ForceNetworks& networks) {
  constexpr double kWidestRange = 1000.0;
  const double heaviest = training.report.heaviest_taxel_newtons;
  double lightest = std::max(training.report.lightest_newtons, heaviest / kWidestRange);
  if (!training.tested_shared.empty() || lightest > 0.5 * heaviest) lightest = heaviest / kWidestRange;
  networks.sigma_knots_newtons = {static_cast<float>(lightest), static_cast<float>(heaviest)};
}

/// What is left of the errors when the instruments' are known, taxels by what gives their forces.
void fit_material(const JudgedLoads& judged, const ForceTraining& training, fusion::ForceNetworks& networks,
                  UncertaintyReport& report) {
  const auto set_trained = [&](const std::vector<JudgedLoad>& loads, const std::vector<TestedLoad>& tested) {
    Profile profile = likeliest_profile(loads, report.supply_noise);
    add_uncertainty_of_networks(loads, profile);
    return set_relative_sigma(taxels_of(tested), profile, networks);
  };
  if (!judged.shared.empty()) report.relative_sigma_of_shared = set_trained(judged.shared, training.tested_shared);
  if (!judged.own.empty()) report.relative_sigma = set_trained(judged.own, training.tested_own);
  const std::set<std::size_t> unpressed = unpressed_taxels(training);
  if (!judged.unpressed.empty() && !unpressed.empty()) {
    Profile profile = likeliest_profile(judged.unpressed, report.supply_noise);
    if (training.report.is_one_load) add_uncertainty_of_line(networks, profile);
    report.relative_sigma_of_unpressed = set_relative_sigma(unpressed, profile, networks);
  }
  const std::vector<std::size_t>& tables = training.report.table_taxels;
  if (tables.empty()) return;
  Profile profile{};
  profile.fill(kUnlearnedRepetition * kUnlearnedRepetition);
  if (!judged.tables.empty()) profile = likeliest_profile(judged.tables, report.supply_noise);
  report.relative_sigma_of_tables = set_relative_sigma({tables.begin(), tables.end()}, profile, networks);
}

std::string range_text(const RelativeSigma& sigma) {
  const auto [least, most] = std::minmax_element(sigma.begin(), sigma.end());
  return fmt::format("+- {:.2f} to {:.2f} % beside that", 100.0 * *least, 100.0 * *most);
}

}  // namespace

std::string describe(const UncertaintyReport& report, const ArrayDescription& array) {
  std::string text = report.adc_noise_counts
                         ? fmt::format("readings +- {:.2f} counts", *report.adc_noise_counts)
                         : fmt::format("readings +- {:.2f} counts (from the array: unloaded readings do not tell)",
                                       array.readout.adc_noise_counts);
  if (report.supply_noise > 0.0) text += fmt::format(", supply +- {:.2f} %", 100.0 * report.supply_noise);
  if (report.temperature_sigma_celsius > 0.0) {
    text += fmt::format(", temperature +- {:.2f} C", report.temperature_sigma_celsius);
  }
  if (report.relative_sigma) text += ", forces " + range_text(*report.relative_sigma);
  if (report.relative_sigma_of_shared) {
    text += ", forces of the shared network " + range_text(*report.relative_sigma_of_shared);
  }
  if (report.relative_sigma_of_tables) text += ", forces of tables " + range_text(*report.relative_sigma_of_tables);
  if (report.relative_sigma_of_unpressed) {
    text += ", of taxels that were not pressed " + range_text(*report.relative_sigma_of_unpressed);
  }
  return text;
}

Result<UncertaintyReport> fit_uncertainty(const SampleDatabase& database, const ForceTraining& training,
                                          pipeline::Model& model) {
  UncertaintyReport report;
  report.adc_noise_counts = measure_adc_noise(database);
  if (report.adc_noise_counts) model.array.readout.adc_noise_counts = *report.adc_noise_counts;
  report.temperature_sigma_celsius = measure_temperature_noise(database);
  model.networks.temperature_sigma_celsius = report.temperature_sigma_celsius;

  place_knots(training, model.networks);
  const Result<JudgedLoads> judged = judge_all(database, training, model);
  if (!judged) return judged.error();
  report.supply_noise = likeliest_supply_noise(*judged);
  model.array.readout.supply_noise = report.supply_noise;
  fit_material(*judged, training, model.networks, report);
  return report;
}

}  // namespace dermis::calibration
