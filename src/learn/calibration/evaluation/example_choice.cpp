// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/evaluation/example_choice.hpp"

#include <algorithm>

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kMostExamples = 3;
constexpr std::ptrdiff_t kSeveral = 4;  // taxels

}  // namespace

void ExampleChoice::offer(std::size_t frame, const Sample& truth, const EstimatorRow& row) {
  if (!truth.totals.empty()) return;
  const std::vector<float>& newtons = truth.known_newtons;
  const auto loaded =
      std::count_if(newtons.begin(), newtons.end(), [&](float known) { return known >= row.judged_from_n(); });
  std::vector<TactileExample>& examples = loaded >= kSeveral ? rich_ : plain_;
  if (loaded == 0 || examples.size() >= kMostExamples) return;
  examples.push_back({frame, row.reading(), row.pipeline().conductance().siemens, row.newtons()[0],
                      std::vector<double>(newtons.begin(), newtons.end())});
}

}  // namespace dermis::learn::calibration
