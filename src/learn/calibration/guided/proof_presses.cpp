// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/guided/proof_presses.hpp"

#include <algorithm>
#include <map>

#include "learn/calibration/even_choice.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kPairs = 8;
constexpr std::size_t kPressesPerPair = 3;

/// The heaviest weight that each taxel has had, in reading order.
std::map<std::size_t, double> heaviest_weights(const GuidedPresses& presses) {
  std::map<std::size_t, double> heaviest;
  for (const auto& press : presses) {
    if (!press->together_with) heaviest[press->taxel] = std::max(heaviest[press->taxel], press->newtons);
  }
  return heaviest;
}

/// Each taxel with the next one of its row.
std::vector<PressPair> pairs_in_rows(const std::map<std::size_t, double>& heaviest, std::size_t cols) {
  std::vector<PressPair> pairs;
  for (auto first = heaviest.begin(); first != heaviest.end(); ++first) {
    const auto second = std::next(first);
    if (second == heaviest.end() || second->first / cols != first->first / cols) continue;
    pairs.push_back({first->first, second->first, std::min(first->second, second->second)});
  }
  return pairs;
}

}  // namespace

std::vector<PressPair> proof_presses(const ArrayDescription& array, const GuidedPresses& presses) {
  if (array.readout.circuit == Circuit::none || presses.size() < kPressesPerPair * kPairs) return {};
  const std::vector<PressPair> pairs = pairs_in_rows(heaviest_weights(presses), array.cols);
  if (pairs.size() < kPairs) return {};
  std::vector<PressPair> chosen;
  for (const std::size_t k : even_choice(pairs.size(), kPairs)) chosen.push_back(pairs[k]);
  return chosen;
}

}  // namespace dermis::learn::calibration
