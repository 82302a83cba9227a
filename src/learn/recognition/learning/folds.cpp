// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/learning/folds.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace dermis::learn::recognition {
namespace {

constexpr std::size_t kMostFolds = 10;
constexpr std::size_t kRuns = 5;

/// The largest group first, each into the fold that has the fewest examples.
Folds folds_of_groups(const std::vector<Label>& labels) {
  std::map<std::string, std::size_t> sizes;
  for (const Label& label : labels) ++sizes[label.group];
  std::vector<std::pair<std::size_t, std::string>> groups;
  for (const auto& [name, size] : sizes) groups.emplace_back(size, name);
  std::stable_sort(groups.begin(), groups.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::size_t> filled(std::min(kMostFolds, groups.size()));
  std::map<std::string, std::size_t> fold_of;
  for (const auto& [size, name] : groups) {
    const auto emptiest = std::min_element(filled.begin(), filled.end());
    *emptiest += size;
    fold_of[name] = static_cast<std::size_t>(emptiest - filled.begin());
  }
  Folds folds{Folds::Kind::by_group, {}, filled.size()};
  for (const Label& label : labels) folds.fold_of.push_back(fold_of[label.group]);
  return folds;
}

Folds folds_of_time(const std::vector<Label>& labels, const std::vector<std::size_t>& classes, Deal deal) {
  const std::size_t most = deal == Deal::in_runs ? kRuns : kMostFolds;
  std::map<std::size_t, std::vector<std::size_t>> of_class;
  for (std::size_t i = 0; i < classes.size(); ++i) of_class[classes[i]].push_back(i);
  Folds folds{Folds::Kind::by_time, std::vector<std::size_t>(classes.size()), 0};
  std::size_t turn = 0;  // so that small classes do not all begin in the same fold
  for (auto& [name, members] : of_class) {
    std::stable_sort(members.begin(), members.end(),
                     [&](std::size_t a, std::size_t b) { return labels[a].order < labels[b].order; });
    const bool in_runs = deal == Deal::in_runs && members.size() >= most;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const std::size_t fold = in_runs ? i * most / members.size() : (i + turn) % most;
      folds.fold_of[members[i]] = fold;
      folds.count = std::max(folds.count, fold + 1);
    }
    turn += members.size();
  }
  return folds;
}

/// Examples of whose class the other folds have a quarter or more.
std::size_t carried_count(const Folds& folds, const std::vector<std::size_t>& classes) {
  std::map<std::size_t, std::size_t> of_class;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> of_both;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    ++of_class[classes[i]];
    ++of_both[{classes[i], folds.fold_of[i]}];
  }
  std::size_t carried = 0;
  for (const auto& [both, count] : of_both) {
    if (!is_lopsided(count, of_class[both.first])) carried += count;
  }
  return carried;
}

}  // namespace

Folds make_folds(const std::vector<Label>& labels, const std::vector<std::size_t>& classes, Deal deal) {
  const bool names_groups =
      std::none_of(labels.begin(), labels.end(), [](const Label& label) { return label.group.empty(); });
  if (names_groups) {
    Folds folds = folds_of_groups(labels);
    if (folds.count > 1 && 2 * carried_count(folds, classes) > classes.size()) return folds;
  }
  return folds_of_time(labels, classes, deal);
}

}  // namespace dermis::learn::recognition
