// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/uncertainty.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "dermis/touch/fusion/force_fusion.hpp"
#include "dermis/touch/preprocessing/temperature_field.hpp"
#include "learn/calibration/mean.hpp"
#include "learn/calibration/uncertainty/end_bends.hpp"
#include "learn/calibration/uncertainty/error_budget.hpp"
#include "learn/calibration/uncertainty/relative_sigma_fit.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kUnlearnedExponent = 0.2;     // of force over conductance, relative: rubbers have 0.8 to 2
constexpr double kUnlearnedRepetition = 0.05;  // relative, where no load was repeated

/// The tested loads, by the source of their forces.
struct JudgedLoads {
  std::vector<JudgedLoad> own;
  std::vector<JudgedLoad> shared;
  std::vector<JudgedLoad> unpressed;
  std::vector<JudgedLoad> tables;
};

Result<JudgedLoads> judge_all(const SampleDatabase& database, const ForceTraining& training,
                              const touch::pipeline::Model& model) {
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

/// No more than loads within touches scatter: what differs from touch to touch is the material's.
double highest_supply_noise(const JudgedLoads& loads) {
  double highest = 0.05;
  for (const std::vector<JudgedLoad>* of_kind : {&loads.own, &loads.shared, &loads.tables}) {
    highest = std::min(highest, most_supply_noise(*of_kind).value_or(highest));
  }
  return highest;
}

/// The supply error that makes the noise of all loads likeliest.
double likeliest_supply_noise(const JudgedLoads& loads) {
  constexpr double kLowest = 1e-4;
  const double highest = highest_supply_noise(loads);
  constexpr double kStep = 1.1;
  double best = 0.0;
  const auto of_all = [&](double supply_noise) {
    return surprise(loads.own, supply_noise) + surprise(loads.shared, supply_noise) +
           surprise(loads.tables, supply_noise);
  };
  double least = of_all(best);
  for (double supply_noise = kLowest; supply_noise < highest; supply_noise *= kStep) {
    const double sum = of_all(supply_noise);
    if (sum >= least) continue;
    least = sum;
    best = supply_noise;
  }
  return best;
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

/// The noise of the samples leaves an error in the networks, which stays where readings are less noisy: the least of a
/// profile.
void add_uncertainty_of_networks(const std::vector<JudgedLoad>& loads, VarianceProfile& profile) {
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

/// About their mean.
double sum_of_squares(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double sum = 0.0;
  for (const double value : values) sum += std::pow(value - mean, 2);
  return sum;
}

/// Relative. At least that of presses that nobody repeated.
double mean_square_error(const std::vector<TestedLoad>& loads) {
  double sum = 0.0;
  for (const TestedLoad& load : loads) sum += std::pow(load.error_n / load.newtons, 2);
  const double mean = sum / static_cast<double>(std::max<std::size_t>(loads.size(), 1));
  return std::max(mean, kUnlearnedRepetition * kUnlearnedRepetition);
}

/// How surely single presses determine the exponent of the law that taxels share.
struct ExponentEvidence {
  double mean_log_newtons = 0.0;  ///< Where the exponent has no part in forces.
  double variance = 0.0;          ///< Of the exponent, relative.
};

/// A line through ln(newtons): about the mean of each taxel by the scatter of its presses, of the means by that of
/// taxels. Loads that are about the same tell nothing. Taxels with tables have no loads of the shared network left.
ExponentEvidence exponent_evidence(const ForceTraining& training) {
  std::map<std::size_t, std::vector<double>> log_newtons;  // of each taxel
  for (const TestedLoad& load : training.tested_unpressed) {
    log_newtons[load.taxels.front()].push_back(std::log(load.newtons));
  }
  std::vector<double> means;
  double within = 0.0;
  for (const auto& [taxel, logs] : log_newtons) {
    means.push_back(mean_of(logs));
    within += sum_of_squares(logs);
  }
  const bool has_shared = !training.tested_shared.empty();
  const double of_presses = mean_square_error(has_shared ? training.tested_shared : training.tested_tables);
  const double of_taxels = mean_square_error(training.tested_unpressed);
  double evidence = 1.0 / (kUnlearnedExponent * kUnlearnedExponent);
  if (!training.report.is_one_load) evidence += within / of_presses + sum_of_squares(means) / of_taxels;
  return {mean_of(means), 1.0 / evidence};
}

/// Adds the uncertainty of a law that few loads leave open.
void add_uncertainty_of_exponent(const ForceTraining& training, const touch::fusion::ForceNetworks& networks,
                                 VarianceProfile& profile) {
  const ExponentEvidence evidence = exponent_evidence(training);
  const auto [lightest, heaviest] = networks.sigma_knots_newtons;
  const double log_lightest = std::log(static_cast<double>(lightest));
  const double log_heaviest = std::log(static_cast<double>(heaviest));
  for (std::size_t k = 0; k < profile.size(); ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(profile.size() - 1);
    const double log_newtons = std::lerp(log_lightest, log_heaviest, share);
    profile[k] += evidence.variance * std::pow(log_newtons - evidence.mean_log_newtons, 2);
  }
}

/// The profile of these taxels, in the networks and for the report.
RelativeSigma set_relative_sigma(const std::set<std::size_t>& taxels, const VarianceProfile& profile,
                                 touch::fusion::ForceNetworks& networks) {
  RelativeSigma sigma{};
  for (std::size_t k = 0; k < profile.size(); ++k) {
    sigma[k] = std::sqrt(profile[k]);
    float* const of_taxel = networks.relative_sigma.data() + k * networks.taxel_count();
    for (const std::size_t taxel : taxels) of_taxel[taxel] = static_cast<float>(sigma[k]);
  }
  return sigma;
}

/// Knots over what single taxels carry; far below a load that many taxels share.
void place_knots(const ForceTraining& training, touch::fusion::ForceNetworks& networks) {
  constexpr double kWidestRange = 1000.0;
  const double heaviest = training.report.heaviest_taxel_newtons;
  double lightest = std::max(training.report.lightest_newtons, heaviest / kWidestRange);
  if (!training.tested_shared.empty() || lightest > 0.5 * heaviest) lightest = heaviest / kWidestRange;
  networks.sigma_knots_newtons = {static_cast<float>(lightest), static_cast<float>(heaviest)};
}

/// Fits the rest of the errors beside those of the instruments, by the source of the taxels' forces.
void fit_material(const JudgedLoads& judged, const ForceTraining& training, touch::fusion::ForceNetworks& networks,
                  UncertaintyReport& report) {
  const auto set_trained = [&](const std::vector<JudgedLoad>& loads, const std::vector<TestedLoad>& tested) {
    VarianceProfile profile = likeliest_profile(loads, report.supply_noise);
    add_uncertainty_of_networks(loads, profile);
    return set_relative_sigma(taxels_of(tested), profile, networks);
  };
  if (!judged.shared.empty()) report.relative_sigma_of_shared = set_trained(judged.shared, training.tested_shared);
  if (!judged.own.empty()) report.relative_sigma = set_trained(judged.own, training.tested_own);
  const std::set<std::size_t> unpressed = unpressed_taxels(training);
  if (!judged.unpressed.empty() && !unpressed.empty()) {
    VarianceProfile profile = likeliest_profile(judged.unpressed, report.supply_noise);
    add_uncertainty_of_exponent(training, networks, profile);
    report.relative_sigma_of_unpressed = set_relative_sigma(unpressed, profile, networks);
    report.unpressed_taxels = unpressed.size();
  }
  const std::vector<std::size_t>& tables = training.report.table_taxels;
  if (tables.empty()) return;
  VarianceProfile profile{};
  profile.fill(kUnlearnedRepetition * kUnlearnedRepetition);
  if (!judged.tables.empty()) profile = likeliest_profile(judged.tables, report.supply_noise);
  report.relative_sigma_of_tables = set_relative_sigma({tables.begin(), tables.end()}, profile, networks);
}

/// A wrong description of circuit and ADC affects every force, by as much as presses on several taxels show.
void widen(double unexplained_share, touch::fusion::ForceNetworks& networks) {
  for (float& sigma : networks.relative_sigma) {
    sigma = static_cast<float>(std::hypot(static_cast<double>(sigma), unexplained_share));
  }
}

std::string range_text(const RelativeSigma& sigma) {
  const auto [least, most] = std::minmax_element(sigma.begin(), sigma.end());
  return fmt::format("\u00b1 {:.2f} to {:.2f} % beside that", 100.0 * *least, 100.0 * *most);
}

}  // namespace

std::string describe(const UncertaintyReport& report, const ArrayDescription& array) {
  std::string text = report.adc_noise_counts
                         ? fmt::format("readings \u00b1 {:.2f} counts", *report.adc_noise_counts)
                         : fmt::format("readings \u00b1 {:.2f} counts (from the array: unloaded readings do not tell)",
                                       array.readout.adc_noise_counts);
  if (report.supply_noise > 0.0) text += fmt::format(", supply \u00b1 {:.2f} %", 100.0 * report.supply_noise);
  if (report.temperature_sigma_celsius > 0.0) {
    text += fmt::format(", temperature \u00b1 {:.2f} C", report.temperature_sigma_celsius);
  }
  if (report.relative_sigma) text += ", forces " + range_text(*report.relative_sigma);
  if (report.relative_sigma_of_shared) {
    text += ", forces of the shared network " + range_text(*report.relative_sigma_of_shared);
  }
  if (report.relative_sigma_of_tables) text += ", forces of tables " + range_text(*report.relative_sigma_of_tables);
  if (report.relative_sigma_of_unpressed) {
    text += ", of taxels that were not pressed " + range_text(*report.relative_sigma_of_unpressed);
  }
  if (report.unexplained_share > 0.0) {
    text +=
        fmt::format(", and all \u00b1 {:.1f} % more, as circuit or ADC are in doubt", 100.0 * report.unexplained_share);
  }
  return text;
}

Result<UncertaintyReport> fit_uncertainty(const SampleDatabase& database, const ForceTraining& training,
                                          touch::pipeline::Model& model) {
  UncertaintyReport report;
  report.adc_noise_counts = measure_adc_noise(database);
  if (report.adc_noise_counts) model.array.readout.adc_noise_counts = *report.adc_noise_counts;
  report.temperature_sigma_celsius = std::hypot(measure_temperature_noise(database),
                                                touch::preprocessing::TemperatureField(model.array).sigma_celsius());
  model.networks.temperature_sigma_celsius = report.temperature_sigma_celsius;

  place_knots(training, model.networks);
  const Result<JudgedLoads> judged = judge_all(database, training, model);
  if (!judged) return judged.error();
  report.supply_noise = likeliest_supply_noise(*judged);
  model.array.readout.supply_noise = report.supply_noise;
  fit_material(*judged, training, model.networks, report);
  report.unexplained_share = database.unexplained_share;
  widen(report.unexplained_share, model.networks);
  if (database.cover_error > 0.0) {
    const auto error = static_cast<float>(database.cover_error);
    model.networks.gain_errors = {std::vector<float>(database.array.taxel_count(), error), database.array.cols, 1.0};
  }
  model.networks.end_bends = find_end_bends(database, model.networks);  // the errors above are of the loads themselves
  return report;
}

}  // namespace dermis::learn::calibration
