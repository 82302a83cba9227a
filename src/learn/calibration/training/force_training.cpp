// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/force_training.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "learn/calibration/even_choice.hpp"
#include "learn/calibration/labels/press_numbers.hpp"
#include "learn/calibration/samples/unloaded_fit.hpp"
#include "learn/calibration/training/force_levels.hpp"
#include "learn/calibration/training/shared_training.hpp"
#include "learn/calibration/training/table_choice.hpp"
#include "learn/calibration/training/taxel_training.hpp"
#include "learn/calibration/training/temperature_levels.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kMostHiddenUnits = 4;  // the design's size
constexpr std::size_t kPointsPerParameterOfUnit = 2;
constexpr std::size_t kLeastPoints = 8;  // for a network of its own
constexpr std::size_t kMostPoints =
    4000;  // more would lower the error of its two dozen numbers by less than 1 % of noise
constexpr std::size_t kFirstNetworks = 16;  // trained from random starts, and the others from these
constexpr double kLeastTemperatureShare = 0.5;
constexpr float kUnknownRelativeSigma = 0.01F;  // until fit_uncertainty()
constexpr double kDetectable = 3.0;             // in standard deviations of the unloaded reading

/// The evidence of the samples on each taxel.
struct Evidence {
  SampleTemperatures temperatures;
  UnloadedFit unloaded;
  std::vector<std::vector<TaxelPoint>> points;  ///< Known forces above zero [taxels].
  std::vector<bool> dead;                       ///< [taxels]
};

/// Mean of the unloaded samples; 0: not known. The effect of noise on a conductance depends on all presses.
double unloaded_sigma_siemens(const SampleDatabase& database, std::size_t taxel) {
  double sum = 0.0;
  double count = 0.0;
  for (const Sample& sample : database.samples) {
    if (sample.sigma_siemens.empty()) return 0.0;
    if (!sample.unloaded) continue;
    sum += static_cast<double>(sample.sigma_siemens[taxel]);
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

std::vector<TaxelPoint> pressed_points(const SampleDatabase& database, std::size_t taxel, const Evidence& evidence) {
  std::vector<TaxelPoint> points;
  const double unloaded_sigma = unloaded_sigma_siemens(database, taxel);
  PressNumbers numbers;
  for (std::size_t k = 0; k < database.samples.size(); ++k) {
    const Sample& sample = database.samples[k];
    const double load_newtons = sample.known_newtons[taxel];
    const double share = sample.material_share.empty() ? 1.0 : static_cast<double>(sample.material_share[taxel]);
    if (!(load_newtons > 0.0) || std::isnan(share)) continue;
    const auto& [press, touch] = numbers.next(sample, k, load_newtons);
    double noise = evidence.unloaded.noise_siemens[taxel];
    if (unloaded_sigma > 0.0) noise *= static_cast<double>(sample.sigma_siemens[taxel]) / unloaded_sigma;
    points.push_back({excess_siemens(sample, taxel, evidence.unloaded, evidence.temperatures), noise,
                      normalised_temperature(sample, taxel, evidence.temperatures), share * load_newtons, load_newtons,
                      k, press, touch});
  }
  return points;
}

/// A taxel is dead where not even its heaviest tenth of known loads is felt.
bool is_dead(const std::vector<TaxelPoint>& points, double noise_siemens) {
  if (points.empty()) return false;
  std::vector<TaxelPoint> by_force = points;
  std::sort(by_force.begin(), by_force.end(), [](const auto& a, const auto& b) { return a.newtons > b.newtons; });
  const std::size_t heaviest = (points.size() + 9) / 10;
  double mean = 0.0;
  for (std::size_t k = 0; k < heaviest; ++k) mean += by_force[k].excess_siemens / static_cast<double>(heaviest);
  return mean < kDetectable * noise_siemens;
}

/// Evenly over the forces.
std::vector<TaxelPoint> thinned(std::vector<TaxelPoint> points) {
  if (points.size() <= kMostPoints) return points;
  std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.newtons < b.newtons; });
  std::vector<TaxelPoint> kept;
  for (std::size_t k = 0; k < kMostPoints; ++k) kept.push_back(points[k * (points.size() - 1) / (kMostPoints - 1)]);
  std::sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.sample < b.sample; });
  return kept;
}

Evidence gather_evidence(const SampleDatabase& database) {
  const std::size_t taxels = database.array.taxel_count();
  Evidence evidence;
  evidence.temperatures = sample_temperatures(database);
  evidence.unloaded = fit_unloaded(database, evidence.temperatures);
  evidence.points.resize(taxels);
  std::vector<char> dead(taxels);
  parallel_for(taxels, [&](std::size_t taxel) {
    std::vector<TaxelPoint> points = pressed_points(database, taxel, evidence);
    const double noise = evidence.unloaded.noise_siemens[taxel];
    const bool answers = !evidence.unloaded.is_stuck[taxel] && !is_dead(points, noise);
    dead[taxel] = answers || database.array.is_absent(taxel) ? 0 : 1;
    std::erase_if(points, [&](const TaxelPoint& point) { return point.excess_siemens < kDetectable * noise; });
    evidence.points[taxel] = thinned(std::move(points));
  });
  evidence.dead.assign(dead.begin(), dead.end());
  return evidence;
}

/// The lightest and the heaviest of two loads were each put on more than once: one press may be an accident.
bool repeats_two_loads(const std::vector<TaxelPoint>& points, double lightest_newtons, double heaviest_newtons) {
  std::set<std::size_t> light;
  std::set<std::size_t> heavy;
  for (const TaxelPoint& point : points) {
    const bool is_light = point.load_newtons / lightest_newtons < heaviest_newtons / point.load_newtons;
    (is_light ? light : heavy).insert(point.press);
  }
  return std::min(light.size(), heavy.size()) > 1;
}

bool supports_own_network(const std::vector<TaxelPoint>& points, bool uses_temperature) {
  if (points.size() < kLeastPoints) return false;
  double coldest = 1.0;
  double hottest = -1.0;
  for (const TaxelPoint& point : points) {
    coldest = std::min(coldest, point.temperature);
    hottest = std::max(hottest, point.temperature);
  }
  const std::vector<double> newtons = rising_loads(points);
  const bool tells_a_law =
      count_levels(newtons) >= kLeastLevelsOfBend || repeats_two_loads(points, newtons.front(), newtons.back());
  return tells_a_law && newtons.back() >= kLeastForceRange * newtons.front() &&
         (!uses_temperature || hottest - coldest >= 2.0 * kLeastTemperatureShare);
}

/// Hidden units that the points can hold. Each bends the law between forces, about which many samples under few forces
/// say nothing. Where the material remembers, their scatter would make the law a stair.
std::size_t hidden_units(const std::vector<TaxelPoint>& points, bool uses_temperature) {
  const std::size_t parameters_of_unit = force_shape(uses_temperature, 1).inputs + 2;
  const std::size_t levels = count_levels(rising_loads(points));
  return std::min({points.size() / (kPointsPerParameterOfUnit * parameters_of_unit),
                   std::max(levels, kLeastLevelsOfBend) - kLeastLevelsOfBend, kMostHiddenUnits});
}

touch::fusion::ForceNetworks make_networks(const touch::network::PerceptronShape& shape, const Evidence& evidence) {
  const std::size_t taxels = evidence.points.size();
  touch::fusion::ForceNetworks networks;
  networks.shape = shape;
  networks.unloaded = evidence.unloaded.law;
  networks.reference_siemens.assign(taxels, 1.0F);
  networks.heaviest_siemens.assign(taxels, 1.0F);
  networks.heaviest_newtons.assign(taxels, std::numeric_limits<float>::infinity());
  networks.gain.assign(taxels, 1.0F);
  networks.offset_sigma_siemens.assign(evidence.unloaded.offset_sigma_siemens.begin(),
                                       evidence.unloaded.offset_sigma_siemens.end());
  networks.relative_sigma.assign(touch::fusion::kSigmaKnots * taxels, kUnknownRelativeSigma);
  networks.parameters.assign(shape.parameter_count() * taxels, 0.0F);
  for (const bool dead : evidence.dead) networks.dead.push_back(dead ? 1 : 0);
  return networks;
}

/// Hidden units that the network has less than the bank stay zero.
void put(touch::fusion::ForceNetworks& networks, std::size_t taxel, const ForceNetwork& network, double gain) {
  networks.reference_siemens[taxel] = static_cast<float>(network.reference_siemens);
  networks.heaviest_siemens[taxel] = static_cast<float>(network.heaviest_siemens);
  networks.heaviest_newtons[taxel] = static_cast<float>(network.heaviest_newtons);
  networks.gain[taxel] = static_cast<float>(gain);
  const touch::network::PerceptronShape& bank = networks.shape;
  const touch::network::PerceptronShape& own = network.shape;
  const auto copy = [&](std::size_t to, std::size_t from) {
    networks.parameters[to * networks.taxel_count() + taxel] = static_cast<float>(network.parameters[from]);
  };
  for (std::size_t unit = 0; unit < own.hidden; ++unit) {
    copy(bank.bias(unit), own.bias(unit));
    for (std::size_t input = 0; input < own.inputs; ++input) copy(bank.weight(unit, input), own.weight(unit, input));
    copy(bank.output_weight(unit), own.output_weight(unit));
  }
  copy(bank.output_bias(), own.output_bias());
  for (std::size_t input = 0; input < own.inputs; ++input) copy(bank.direct_weight(input), own.direct_weight(input));
}

/// The lightest and heaviest load of the calibration, and whether they are about the same.
void report_loads(const SampleDatabase& database, TrainingReport& report) {
  bool has_totals = false;
  report.lightest_newtons = std::numeric_limits<double>::infinity();
  const auto include = [&](double newtons) {
    if (!(newtons > 0.0)) return;
    report.lightest_newtons = std::min(report.lightest_newtons, newtons);
    report.heaviest_newtons = std::max(report.heaviest_newtons, newtons);
  };
  for (const Sample& sample : database.samples) {
    for (const float newtons : sample.known_newtons) {
      include(static_cast<double>(newtons));
      report.heaviest_taxel_newtons = std::max(report.heaviest_taxel_newtons, static_cast<double>(newtons));
    }
    for (const TotalForce& total : sample.totals) {
      include(total.newtons);
      has_totals = has_totals || total.newtons > 0.0;
    }
  }
  report.is_one_load = !has_totals && report.heaviest_newtons < kLeastForceRange * report.lightest_newtons;
}

void report_fit(const std::vector<std::size_t>& own, const std::vector<ForceNetwork>& networks,
                TrainingReport& report) {
  std::vector<double> errors;
  for (std::size_t k = 0; k < own.size(); ++k) {
    errors.push_back(networks[k].rms_error);
    if (errors.back() <= report.worst_fit_error) continue;
    report.worst_fit_error = errors.back();
    report.worst_taxel = own[k];
  }
  if (errors.empty()) return;
  report.median_fit_error = upper_median(std::move(errors));
}

std::vector<TestedLoad> tested_presses(const std::vector<std::size_t>& own, const std::vector<ForceNetwork>& networks,
                                       const Evidence& evidence) {
  std::vector<TestedLoad> presses;
  for (std::size_t k = 0; k < own.size(); ++k) {
    for (std::size_t at = 0; const touch::network::FittedResidual& fitted : networks[k].fitted) {
      const TaxelPoint& point = evidence.points[own[k]][at++];
      const double residual_n = point.newtons * std::expm1(fitted.residual);
      TestedLoad& load = presses.emplace_back(TestedLoad{point.sample, {own[k]}, point.newtons, residual_n});
      load.noise_n = point.newtons * std::expm1(fitted.as_noise());
      load.error_n = point.newtons * std::expm1(fitted.as_new_error());
      load.leverage = fitted.leverage;
      load.touch = point.touch;
    }
  }
  return presses;
}

/// Taxels of the sheet by what trains them.
struct Division {
  std::vector<std::size_t> own;
  std::vector<std::size_t> shared;
  std::vector<std::size_t> dead;
};

Division divide(const Evidence& evidence, const ArrayDescription& array) {
  Division division;
  for (std::size_t taxel = 0; taxel < evidence.points.size(); ++taxel) {
    if (array.is_absent(taxel)) continue;
    if (evidence.dead[taxel]) {
      division.dead.push_back(taxel);
    } else if (supports_own_network(evidence.points[taxel], evidence.temperatures.is_input)) {
      division.own.push_back(taxel);
    } else {
      division.shared.push_back(taxel);
    }
  }
  return division;
}

std::vector<ForceNetwork> train_own(const Evidence& evidence, const Division& division,
                                    const std::function<void(double)>& progress) {
  std::vector<ForceNetwork> networks(division.own.size());
  std::atomic<std::size_t> done = 0;
  const auto train = [&](std::size_t k, std::span<const ForceNetwork> others) {
    const std::vector<TaxelPoint>& points = evidence.points[division.own[k]];
    const bool uses_temperature = evidence.temperatures.is_input;
    const auto shape = force_shape(uses_temperature, hidden_units(points, uses_temperature));
    const TemperatureSpan& span = evidence.temperatures.span;
    std::optional<ForceNetwork> like = train_taxel_like(others, shape, points, span);
    networks[k] = like ? *std::move(like) : train_taxel(shape, points, span, division.own[k]);
    if (progress) progress(static_cast<double>(++done) / static_cast<double>(division.own.size()));
  };
  const std::vector<std::size_t> first = even_choice(division.own.size(), kFirstNetworks);
  parallel_for(first.size(), [&](std::size_t k) { train(first[k], {}); });
  std::vector<ForceNetwork> others;
  for (const std::size_t k : first) others.push_back(networks[k]);
  parallel_for(networks.size(), [&](std::size_t k) {
    if (networks[k].parameters.empty()) train(k, others);
  });
  return networks;
}

struct Trained {
  std::vector<ForceNetwork> own;
  SharedNetwork shared;
  [[nodiscard]] bool has_shared() const { return !shared.network.parameters.empty(); }
};

touch::fusion::ForceNetworks assemble(const Evidence& evidence, const Division& division, const Trained& trained,
                                      const TrainingReport& report) {
  const std::size_t hidden = std::max(report.hidden_units, report.shared_hidden_units);
  touch::fusion::ForceNetworks networks = make_networks(force_shape(evidence.temperatures.is_input, hidden), evidence);
  for (std::size_t k = 0; k < trained.own.size(); ++k) put(networks, division.own[k], trained.own[k], 1.0);
  for (const std::size_t taxel : division.shared) {
    put(networks, taxel, trained.shared.network, trained.shared.gain[taxel]);
  }
  return networks;
}

void report_division(const Evidence& evidence, const Division& division, TrainingReport& report) {
  report.uses_temperature = evidence.temperatures.is_input;
  const TemperatureSpan& span = evidence.temperatures.span;
  report.lowest_celsius = span.centre_celsius - span.half_span_celsius;
  report.highest_celsius = span.centre_celsius + span.half_span_celsius;
  report.own_networks = division.own.size();
  report.shared_networks = division.shared.size();
  report.dead_taxels = division.dead;
}

void report_networks(const Division& division, const Trained& trained, TrainingReport& report) {
  if (trained.has_shared()) report.shared_hidden_units = trained.shared.network.shape.hidden;
  for (const ForceNetwork& network : trained.own) {
    report.hidden_units = std::max(report.hidden_units, network.shape.hidden);
  }
  report.shared_leave_one_out_error = trained.shared.leave_one_out_error;
  report.heaviest_taxel_newtons = std::max(report.heaviest_taxel_newtons, trained.shared.heaviest_newtons);
  report_fit(division.own, trained.own, report);
}

std::string describe(const TrainingReport& report, bool has_gains) {
  std::string text;
  if (report.own_networks > 0) {
    text = fmt::format("{} taxels have a network of their own (their own force is known often enough)",
                       report.own_networks);
  }
  if (report.shared_networks > 0) {
    text += fmt::format("{}{} taxels share one network of {} hidden units, trained through the sum of the loads, {}",
                        text.empty() ? "" : "; ", report.shared_networks, report.shared_hidden_units,
                        has_gains ? "with a gain each" : "without gains (they did not lower the leave-one-out error)");
  }
  if (report.is_one_load) {
    text += fmt::format(
        "; {} taxels have a straight line from their unloaded reading through their load instead: one load tells no "
        "law",
        report.table_taxels.size());
  } else if (report.groups_on_tables > 0) {
    text += fmt::format(
        "; {} of {} groups of taxels ({} taxels): look-up table instead, clearly better on presses left "
        "out",
        report.groups_on_tables, report.groups, report.table_taxels.size());
  }
  return text;
}

}  // namespace

std::string describe_fit(const TrainingReport& report, const ArrayDescription& array) {
  std::string text;
  if (report.own_networks > 0) {
    text = fmt::format("median {:.2f} %, worst taxel {} {:.2f} % on their own samples", 100.0 * report.median_fit_error,
                       array.taxel_name(report.worst_taxel), 100.0 * report.worst_fit_error);
  }
  if (report.shared_networks > 0) {
    text += fmt::format("{}shared network {:.2f} % on loads left out", text.empty() ? "" : "; ",
                        100.0 * report.shared_leave_one_out_error);
  }
  return text;
}

Result<ForceTraining> train_force_networks(const SampleDatabase& database,
                                           const std::function<void(double)>& progress) {
  ForceTraining training;
  TrainingReport& report = training.report;
  report_loads(database, report);
  if (report.heaviest_newtons <= 0.0) {
    return bad_input("every load is zero: label frames with the force that presses on the array");
  }
  const Evidence evidence = gather_evidence(database);
  const Division division = divide(evidence, database.array);
  report_division(evidence, division, report);
  Trained trained;
  if (!division.own.empty()) trained.own = train_own(evidence, division, progress);
  if (!division.shared.empty()) {
    trained.shared = train_shared(database, evidence.temperatures, evidence.unloaded, evidence.dead);
  }
  if (trained.own.empty() && !trained.has_shared()) {
    return bad_input("no taxel answers to its loads: check that frames and loads belong together, and the circuit");
  }
  report_networks(division, trained, report);
  training.networks = assemble(evidence, division, trained, report);
  training.networks.temperature_gap_celsius = temperature_gap(database, evidence.temperatures);
  training.tested_own = tested_presses(division.own, trained.own, evidence);
  training.tested_shared = std::move(trained.shared.tested);
  training.tested_unpressed = std::move(trained.shared.tested_unpressed);
  if (report.is_one_load) {
    take_lines(evidence.points, evidence.temperatures, training);
  } else {
    prefer_tables(database, evidence.points, evidence.temperatures, training);
  }
  report.choice = describe(report, trained.shared.has_gains);
  return training;
}

}  // namespace dermis::learn::calibration
