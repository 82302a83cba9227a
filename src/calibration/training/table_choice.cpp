// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/training/table_choice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "calibration/even_choice.hpp"
#include "calibration/samples/unloaded_fit.hpp"
#include "calibration/tables/level_table.hpp"
#include "calibration/training/force_levels.hpp"
#include "dermis/calibration/parallel.hpp"
#include "dermis/core/quantile.hpp"
#include "dermis/core/random.hpp"
#include "dermis/fusion/force_fusion.hpp"

namespace dermis::calibration {
namespace {

using Points = std::span<const TaxelPoint>;

constexpr double kSameForce = 1.03;  // of the samples of one press
constexpr std::size_t kFolds = 10;
constexpr std::size_t kMostGroups = 64;
constexpr std::size_t kPressesOfGroup = 24;
constexpr std::size_t kLeastPresses = 12;   // at different times, to judge by
constexpr double kClearlyBetter = 0.8;      // of the mean error
constexpr double kLeastSignificance = 4.0;  // in standard errors
constexpr double kMostError = 1.0;          // counts as this: a single wild one decides nothing
constexpr double kMostLeverage = 0.95;
constexpr std::size_t kMostUnloaded = 2000;  // samples to see ghosts in
constexpr double kGhostShare = 0.99;         // of the ghosts are below the one that counts
constexpr double kLeastGhost = 0.1;          // of the lightest load
constexpr double kFewerGhosts = 0.5;         // as heavy as those of the other method
constexpr double kLeastOfKnot = 1e-30;       // N and S: floats hold it and its shares

/// A press that was left out, and what either method makes of it.
struct JudgedPress {
  std::size_t moment = 0;  // TaxelPoint::press
  double of_network = 0.0;
  double of_table = 0.0;  // mean relative errors, without sign
};

/// A sample of it.
struct JudgedSample {
  std::size_t sample = 0;  // in the database
  double newtons = 0.0;
  double error_of_table = 0.0;  // relative
};

/// Forces of a method where nothing presses [N].
struct Ghosts {
  std::vector<float> of_network;
  std::vector<float> of_table;
};

struct ComparedTaxel {
  std::vector<JudgedPress> presses;
  std::vector<JudgedSample> samples;
  Ghosts ghosts;
};

/// The errors of the networks on one taxel, by rising sample.
using NetworkErrors = std::vector<const TestedLoad*>;

std::vector<NetworkErrors> errors_by_taxel(const ForceTraining& training) {
  std::vector<NetworkErrors> errors(training.networks.taxel_count());
  for (const std::vector<TestedLoad>* loads : {&training.tested_own, &training.tested_shared}) {
    for (const TestedLoad& load : *loads) {
      if (load.taxels.size() == 1) errors[load.taxels.front()].push_back(&load);
    }
  }
  for (NetworkErrors& of_taxel : errors) {
    std::stable_sort(of_taxel.begin(), of_taxel.end(),
                     [](const auto* a, const auto* b) { return a->sample < b->sample; });
  }
  return errors;
}

std::vector<Points> split_presses(Points points) {
  std::vector<Points> presses;
  for (std::size_t first = 0; first < points.size();) {
    std::size_t last = first + 1;
    while (last < points.size() && points[last].press == points[first].press) ++last;
    presses.push_back(points.subspan(first, last - first));
    first = last;
  }
  return presses;
}

/// The tables of a taxel or of many.
class TableMaker {
 public:
  explicit TableMaker(const SampleTemperatures& temperatures)
      : half_span_celsius_(temperatures.is_input ? temperatures.span.half_span_celsius : 0.0) {}

  [[nodiscard]] double temperature_offset(const TaxelPoint& point) const {
    return point.temperature * half_span_celsius_;
  }

  /// Knots of the points, which are by rising force, and the linear temperature term; no knot: there is no table.
  [[nodiscard]] std::pair<std::vector<Knot>, double> fit(const std::vector<TaxelPoint>& points) const {
    std::vector<LevelPoint> known;
    for (const TaxelPoint& point : points) {
      known.push_back({point.newtons, point.excess_siemens, temperature_offset(point)});
    }
    const double coefficient = temperature_coefficient(known);
    std::vector<Knot> knots = level_table(std::move(known), coefficient);
    pool_equal_floats(knots);
    std::erase_if(knots, [](const Knot& knot) { return !(std::min(knot.x, knot.y) >= kLeastOfKnot); });
    return {std::move(knots), coefficient};
  }

  /// Tables with fewer knots than others begin with some on the line from zero to their first.
  static fusion::ForceTables assemble(const std::vector<std::pair<std::vector<Knot>, double>>& tables,
                                      const std::vector<std::size_t>& taxels) {
    fusion::ForceTables assembled;
    for (const auto& [knots, coefficient] : tables) assembled.knots = std::max(assembled.knots, knots.size());
    for (std::size_t k = 0; k < tables.size(); ++k) {
      const auto& [knots, coefficient] = tables[k];
      assembled.taxels.push_back(static_cast<std::uint32_t>(taxels[k]));
      assembled.per_celsius.push_back(static_cast<float>(coefficient));
      const std::size_t missing = assembled.knots - knots.size();
      for (std::size_t knot = 0; knot < assembled.knots; ++knot) {
        const Knot& given = knots[knot < missing ? 0 : knot - missing];
        const double share = knot < missing ? static_cast<double>(knot + 1) / static_cast<double>(missing + 1) : 1.0;
        assembled.siemens.push_back(static_cast<float>(share * given.y));
        assembled.newtons.push_back(static_cast<float>(share * given.x));
      }
    }
    return assembled;
  }

 private:
  double half_span_celsius_;
};

std::vector<TaxelPoint> by_force(Points points) {
  std::vector<TaxelPoint> sorted(points.begin(), points.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.newtons < b.newtons; });
  return sorted;
}

/// A fold for each of `count` presses, by chance: what repeats in the order of presses is in no fold alone.
std::vector<std::size_t> draw_folds(std::size_t count, std::size_t folds, std::uint64_t seed) {
  std::vector<std::size_t> fold_of(count);
  for (std::size_t k = 0; k < count; ++k) fold_of[k] = k % folds;
  Random random(seed);
  for (std::size_t k = count - 1; k > 0; --k) std::swap(fold_of[k], fold_of[random.below(k + 1)]);
  return fold_of;
}

/// The lighter of two loads and the heavier.
std::vector<std::size_t> folds_of_loads(const std::vector<Points>& presses, const std::vector<double>& rising_loads) {
  std::vector<std::size_t> fold_of;
  for (const Points press : presses) {
    const double newtons = press.front().load_newtons;
    fold_of.push_back(newtons / rising_loads.front() < rising_loads.back() / newtons ? 0 : 1);
  }
  return fold_of;
}

/// What a fit without the press would make of a sample of it: the samples of a press are alike, so that each pulls at
/// the fit as all of them do that the fit has seen.
double left_out_error(const TestedLoad& load, std::size_t samples_of_press) {
  const double pull = std::min(load.leverage * static_cast<double>(samples_of_press), kMostLeverage);
  return load.noise_n / load.newtons * std::sqrt(1.0 - load.leverage) / (1.0 - pull);
}

class TaxelComparison {
 public:
  TaxelComparison(std::size_t taxel, Points points, const NetworkErrors& errors, const TableMaker& maker)
      : taxel_(taxel), errors_(errors), maker_(maker), presses_(split_presses(points)), loads_(rising_loads(points)) {}

  [[nodiscard]] ComparedTaxel judge() const {
    ComparedTaxel judged;
    const std::size_t folds = std::min(kFolds, presses_.size());
    if (folds < 2) return judged;
    const bool are_two = count_levels(loads_) == 2 && loads_.back() >= kLeastForceRange * loads_.front();
    const std::vector<std::size_t> fold_of =
        are_two ? folds_of_loads(presses_, loads_) : draw_folds(presses_.size(), folds, taxel_);
    for (std::size_t fold = 0; fold < folds; ++fold) {
      std::vector<TaxelPoint> kept;
      for (std::size_t k = 0; k < presses_.size(); ++k) {
        if (fold_of[k] != fold) kept.insert(kept.end(), presses_[k].begin(), presses_[k].end());
      }
      kept = by_force(kept);
      const auto fitted = maker_.fit(kept);
      if (kept.empty() || fitted.first.empty()) continue;
      const fusion::ForceTables table = TableMaker::assemble({fitted}, {taxel_});
      for (std::size_t k = 0; k < presses_.size(); ++k) {
        const bool is_within = presses_[k].front().newtons <= kSameForce * kept.back().newtons;
        if (fold_of[k] == fold && is_within) judge_press(presses_[k], table, judged);
      }
    }
    return judged;
  }

 private:
  [[nodiscard]] const TestedLoad* tested(std::size_t sample) const {
    const auto found = std::lower_bound(errors_.begin(), errors_.end(), sample,
                                        [](const TestedLoad* load, std::size_t at) { return load->sample < at; });
    return found != errors_.end() && (*found)->sample == sample ? *found : nullptr;
  }

  void judge_press(Points press, const fusion::ForceTables& table, ComparedTaxel& judged) const {
    JudgedPress result{press.front().press, 0.0, 0.0};
    const auto is_tested = [&](const TaxelPoint& point) { return tested(point.sample) != nullptr; };
    const auto samples = static_cast<std::size_t>(std::count_if(press.begin(), press.end(), is_tested));
    if (samples == 0) return;  // the shared network sees few of a taxel
    for (const TaxelPoint& point : press) {
      const TestedLoad* const of_network = tested(point.sample);
      if (of_network == nullptr) continue;
      const fusion::ForceTables::Value value =
          table.at(0, static_cast<float>(point.excess_siemens), static_cast<float>(maker_.temperature_offset(point)));
      const double error = std::exp(static_cast<double>(value.log_newtons)) / point.newtons - 1.0;
      result.of_table += std::min(std::abs(error), kMostError);
      result.of_network += std::min(std::abs(left_out_error(*of_network, samples)), kMostError);
      judged.samples.push_back({point.sample, point.newtons, error});
    }
    result.of_table /= static_cast<double>(samples);
    result.of_network /= static_cast<double>(samples);
    judged.presses.push_back(result);
  }

  std::size_t taxel_;
  const NetworkErrors& errors_;
  const TableMaker& maker_;
  std::vector<Points> presses_;
  std::vector<double> loads_;
};

/// The means over the presses of each moment.
std::vector<JudgedPress> by_moment(const std::vector<std::size_t>& group, const std::vector<ComparedTaxel>& judged) {
  std::map<std::size_t, std::pair<JudgedPress, double>> moments;
  for (const std::size_t taxel : group) {
    for (const JudgedPress& press : judged[taxel].presses) {
      auto& [sum, count] = moments[press.moment];
      sum.of_network += press.of_network;
      sum.of_table += press.of_table;
      count += 1.0;
    }
  }
  std::vector<JudgedPress> means;
  for (const auto& [moment, of_moment] : moments) {
    const auto& [sum, count] = of_moment;
    means.push_back({moment, sum.of_network / count, sum.of_table / count});
  }
  return means;
}

Ghosts all_ghosts(const std::vector<std::size_t>& group, const std::vector<ComparedTaxel>& judged) {
  Ghosts all;
  for (const std::size_t taxel : group) {
    const auto& [of_network, of_table] = judged[taxel].ghosts;
    all.of_network.insert(all.of_network.end(), of_network.begin(), of_network.end());
    all.of_table.insert(all.of_table.end(), of_table.begin(), of_table.end());
  }
  return all;
}

/// One of two methods sees ghosts of the weight of loads where the other does not.
bool sees_ghosts(const std::vector<float>& newtons, const std::vector<float>& of_other, double lightest_newtons) {
  if (newtons.empty()) return false;
  const auto ghost = static_cast<double>(quantile(newtons, kGhostShare));
  const auto other = static_cast<double>(quantile(of_other, kGhostShare));
  return ghost > kLeastGhost * lightest_newtons && other < kFewerGhosts * ghost;
}

/// The errors of a method on presses are clearly smaller than those of another.
bool is_clearly_better(const std::vector<JudgedPress>& presses, double JudgedPress::*one, double JudgedPress::*other) {
  const auto count = static_cast<double>(presses.size());
  double of_one = 0.0;
  double of_other = 0.0;
  for (const JudgedPress& press : presses) {
    of_one += press.*one / count;
    of_other += press.*other / count;
  }
  double square = 0.0;
  for (const JudgedPress& press : presses) {
    square += std::pow(press.*other - press.*one - (of_other - of_one), 2);
  }
  const double standard_error = std::sqrt(square / (count - 1.0) / count);
  return of_one < kClearlyBetter * of_other && of_other - of_one > kLeastSignificance * standard_error;
}

bool are_tables_better(const std::vector<JudgedPress>& presses, const Ghosts& ghosts, double lightest_newtons) {
  if (presses.size() < kLeastPresses || sees_ghosts(ghosts.of_table, ghosts.of_network, lightest_newtons)) return false;
  if (is_clearly_better(presses, &JudgedPress::of_table, &JudgedPress::of_network)) return true;
  return sees_ghosts(ghosts.of_network, ghosts.of_table, lightest_newtons) &&
         !is_clearly_better(presses, &JudgedPress::of_network, &JudgedPress::of_table);
}

/// Neighbours in reading order, each group with presses enough to be judged by.
std::vector<std::vector<std::size_t>> make_groups(const std::vector<std::size_t>& taxels,
                                                  const std::vector<ComparedTaxel>& judged) {
  std::size_t presses = 0;
  for (const std::size_t taxel : taxels) presses += judged[taxel].presses.size();
  const std::size_t most = std::min(kMostGroups, taxels.size());
  const std::size_t count = std::clamp<std::size_t>(presses / kPressesOfGroup, std::min<std::size_t>(1, most), most);
  std::vector<std::vector<std::size_t>> groups(count);
  for (std::size_t k = 0; k < taxels.size(); ++k) groups[k * count / taxels.size()].push_back(taxels[k]);
  return groups;
}

/// Puts the tables of those `asked`, which are rising, that have one into the networks.
void install(const std::vector<std::size_t>& asked, std::span<const std::vector<TaxelPoint>> points,
             const TableMaker& maker, const std::vector<ComparedTaxel>& judged, ForceTraining& training) {
  std::vector<std::pair<std::vector<Knot>, double>> tables(asked.size());
  parallel_for(asked.size(), [&](std::size_t k) { tables[k] = maker.fit(by_force(points[asked[k]])); });
  std::vector<std::size_t> taxels;
  for (std::size_t k = 0; k < asked.size(); ++k) {
    if (!tables[k].first.empty()) taxels.push_back(asked[k]);
  }
  std::erase_if(tables, [](const auto& table) { return table.first.empty(); });
  fusion::ForceNetworks& networks = training.networks;
  networks.tables = TableMaker::assemble(tables, taxels);
  for (const std::size_t taxel : taxels) {
    double siemens = 0.0;
    double newtons = 0.0;
    for (const TaxelPoint& point : points[taxel]) {
      siemens = std::max(siemens, point.excess_siemens);
      newtons = std::max(newtons, point.newtons);
    }
    networks.heaviest_siemens[taxel] = static_cast<float>(siemens);
    networks.heaviest_newtons[taxel] = static_cast<float>(newtons);
    for (const JudgedSample& sample : judged[taxel].samples) {
      const double error_n = sample.error_of_table * sample.newtons;
      training.tested_tables.push_back({sample.sample, {taxel}, sample.newtons, error_n, error_n, 0.0});
    }
  }
  const std::set<std::size_t> gone(taxels.begin(), taxels.end());
  for (std::vector<TestedLoad>* loads : {&training.tested_own, &training.tested_shared}) {
    std::erase_if(
        *loads, [&](const TestedLoad& load) { return load.taxels.size() == 1 && gone.contains(load.taxels.front()); });
  }
  training.report.table_taxels = taxels;
}

/// Both methods on some of the samples in which nothing presses, each taxel after its first press.
class GhostWatch {
 public:
  GhostWatch(const SampleDatabase& database, const SampleTemperatures& temperatures,
             std::span<const std::vector<TaxelPoint>> points, const TableMaker& maker)
      : database_(database), temperatures_(temperatures), points_(points), tables_(points.size()) {
    parallel_for(points.size(), [&](std::size_t taxel) {
      auto table = maker.fit(by_force(points[taxel]));
      if (!table.first.empty()) tables_[taxel] = TableMaker::assemble({std::move(table)}, {taxel});
    });
  }

  void watch(const fusion::ForceNetworks& networks, std::vector<ComparedTaxel>& judged) const {
    std::vector<const Sample*> unloaded;
    for (const Sample& sample : database_.samples) {
      if (sample.unloaded) unloaded.push_back(&sample);
    }
    fusion::ForceFusion fusion(networks);
    ConductanceFrame conductance;
    ForceFrame force;
    for (const std::size_t k : even_choice(unloaded.size(), kMostUnloaded)) {
      const Sample& sample = *unloaded[k];
      conductance.temperature_celsius = sample.temperature_celsius;
      conductance.siemens.assign(sample.siemens.begin(), sample.siemens.end());
      conductance.sigma_siemens.assign(sample.siemens.size(), 0.0);
      conductance.taxels.assign(sample.siemens.size(), TaxelStatus::ok);
      fusion.process(conductance, force);
      for (std::size_t taxel = 0; taxel < judged.size(); ++taxel) {
        if (!follows_a_press(taxel, sample) || std::isnan(force.newtons[taxel])) continue;
        judged[taxel].ghosts.of_network.push_back(force.newtons[taxel]);
        judged[taxel].ghosts.of_table.push_back(of_table(networks, taxel, sample));
      }
    }
  }

 private:
  [[nodiscard]] bool follows_a_press(std::size_t taxel, const Sample& sample) const {
    return !tables_[taxel].taxels.empty() && sample.known_newtons[taxel] == 0.0F &&
           sample.frame > database_.samples[points_[taxel].front().sample].frame;
  }

  [[nodiscard]] float of_table(const fusion::ForceNetworks& networks, std::size_t taxel, const Sample& sample) const {
    const double offset = temperature_offset(sample, temperatures_);
    const auto excess = static_cast<float>(networks.unloaded.excess(taxel, sample.siemens[taxel], offset));
    if (excess <= 0.0F) return 0.0F;
    return std::exp(tables_[taxel].at(0, excess, static_cast<float>(offset)).log_newtons);
  }

  const SampleDatabase& database_;
  const SampleTemperatures& temperatures_;
  std::span<const std::vector<TaxelPoint>> points_;
  std::vector<fusion::ForceTables> tables_;  // [taxels], of one taxel each or of none
};

std::vector<ComparedTaxel> judge_all(std::span<const std::vector<TaxelPoint>> points, const TableMaker& maker,
                                     const ForceTraining& training) {
  const std::vector<NetworkErrors> errors = errors_by_taxel(training);
  std::vector<ComparedTaxel> judged(points.size());
  parallel_for(points.size(), [&](std::size_t taxel) {
    if (errors[taxel].empty()) return;
    judged[taxel] = TaxelComparison(taxel, points[taxel], errors[taxel], maker).judge();
  });
  return judged;
}

/// Tables may be worth nothing where all points of a taxel are taken together.
bool has_table(const std::vector<std::size_t>& group, const std::vector<std::size_t>& table_taxels) {
  return std::any_of(group.begin(), group.end(), [&](std::size_t taxel) {
    return std::binary_search(table_taxels.begin(), table_taxels.end(), taxel);
  });
}

}  // namespace

void number_presses(std::vector<TaxelPoint>& points) {
  const TaxelPoint* first = nullptr;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto goes_on = [&] {
      const auto [least, most] = std::minmax(points[k].load_newtons, first->load_newtons);
      return points[k].sample == points[k - 1].sample + 1 && most <= kSameForce * least;
    };
    if (first == nullptr || !goes_on()) first = &points[k];
    points[k].press = first->sample;
  }
}

void prefer_tables(const SampleDatabase& database, std::span<const std::vector<TaxelPoint>> points,
                   const SampleTemperatures& temperatures, ForceTraining& training) {
  const TableMaker maker(temperatures);
  std::vector<ComparedTaxel> judged = judge_all(points, maker, training);
  GhostWatch(database, temperatures, points, maker).watch(training.networks, judged);
  std::set<std::size_t> own;
  for (const TestedLoad& load : training.tested_own) own.insert(load.taxels.front());
  std::vector<std::vector<std::size_t>> better;  // groups
  std::vector<std::size_t> chosen;
  for (const bool is_own : {true, false}) {
    std::vector<std::size_t> taxels;
    for (std::size_t taxel = 0; taxel < judged.size(); ++taxel) {
      if (!judged[taxel].presses.empty() && own.contains(taxel) == is_own) taxels.push_back(taxel);
    }
    std::vector<std::vector<std::size_t>> groups = make_groups(taxels, judged);
    for (std::vector<std::size_t>& group : groups) {
      ++training.report.groups;
      const std::vector<JudgedPress> presses = by_moment(group, judged);
      if (!are_tables_better(presses, all_ghosts(group, judged), training.report.lightest_newtons)) continue;
      chosen.insert(chosen.end(), group.begin(), group.end());
      better.push_back(std::move(group));
    }
  }
  if (chosen.empty()) return;
  std::sort(chosen.begin(), chosen.end());
  install(chosen, points, maker, judged, training);
  const auto on_tables = std::count_if(better.begin(), better.end(), [&](const std::vector<std::size_t>& group) {
    return has_table(group, training.report.table_taxels);
  });
  training.report.groups_on_tables = static_cast<std::size_t>(on_tables);
}

void take_lines(std::span<const std::vector<TaxelPoint>> points, const SampleTemperatures& temperatures,
                ForceTraining& training) {
  std::vector<std::size_t> taxels;
  for (std::size_t taxel = 0; taxel < points.size(); ++taxel) {
    if (!points[taxel].empty() && training.networks.dead[taxel] == 0) taxels.push_back(taxel);
  }
  if (taxels.empty()) return;
  const TableMaker maker(temperatures);
  install(taxels, points, maker, judge_all(points, maker, training), training);
}

}  // namespace dermis::calibration
