// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/training/table_choice.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "learn/calibration/training/ghost_watch.hpp"
#include "learn/calibration/training/left_out_presses.hpp"
#include "learn/calibration/training/table_maker.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kMostGroups = 64;
constexpr std::size_t kPressesOfGroup = 24;
constexpr std::size_t kLeastPresses = 12;   // at different times, to judge by
constexpr double kClearlyBetter = 0.8;      // of the mean error
constexpr double kLeastSignificance = 4.0;  // in standard errors
constexpr double kGhostShare = 0.99;        // of the ghosts are below the one that counts
constexpr double kLeastGhost = 0.1;         // of the lightest load
constexpr double kFewerGhosts = 0.5;        // as heavy as those of the other method

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
  std::vector<TaxelTable> tables(asked.size());
  parallel_for(asked.size(), [&](std::size_t k) { tables[k] = maker.fit(by_force(points[asked[k]])); });
  std::vector<std::size_t> taxels;
  for (std::size_t k = 0; k < asked.size(); ++k) {
    if (!tables[k].knots.empty()) taxels.push_back(asked[k]);
  }
  std::erase_if(tables, [](const TaxelTable& table) { return table.knots.empty(); });
  touch::fusion::ForceNetworks& networks = training.networks;
  networks.tables = assemble_tables(tables, taxels);
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
      training.tested_tables.push_back(
          {sample.sample, {taxel}, sample.newtons, error_n, error_n, error_n, 0.0, sample.touch});
    }
  }
  const std::set<std::size_t> gone(taxels.begin(), taxels.end());
  for (std::vector<TestedLoad>* loads : {&training.tested_own, &training.tested_shared}) {
    std::erase_if(
        *loads, [&](const TestedLoad& load) { return load.taxels.size() == 1 && gone.contains(load.taxels.front()); });
  }
  training.report.table_taxels = taxels;
}

/// Tables may be worth nothing where all points of a taxel are taken together.
bool has_table(const std::vector<std::size_t>& group, const std::vector<std::size_t>& table_taxels) {
  return std::any_of(group.begin(), group.end(), [&](std::size_t taxel) {
    return std::binary_search(table_taxels.begin(), table_taxels.end(), taxel);
  });
}

}  // namespace

void prefer_tables(const SampleDatabase& database, std::span<const std::vector<TaxelPoint>> points,
                   const SampleTemperatures& temperatures, ForceTraining& training) {
  const TableMaker maker(temperatures);
  std::vector<ComparedTaxel> judged = judge_left_out_presses(points, maker, training);
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
  install(taxels, points, maker, judge_left_out_presses(points, maker, training), training);
}

}  // namespace dermis::learn::calibration
