// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/simulation/weight_script.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <utility>

#include "dermis/touch/frames/random.hpp"

namespace dermis::learn::simulation {
namespace {

constexpr std::uint64_t kTaxelStream = std::numeric_limits<std::uint64_t>::max() - 5;  // No frame has this index.
constexpr std::size_t kRounds = 2;
constexpr double kUnloadedS = 10.0;   // Before the first weight.
constexpr double kHandS = 0.2;        // How long it takes to put a weight on or off.
constexpr double kDone = 1.0 - 1e-9;  // Rounding of times.

struct Step {
  double begin_s;
  double force_n;
};
constexpr std::array<Step, 4> kSteps = {{{0.0, 5.0}, {15.0, 15.0}, {30.0, 5.0}, {45.0, 0.0}}};
constexpr double kCycleS = 55.0;

}  // namespace

WeightScript::WeightScript(const ArrayDescription& array, std::size_t taxels, std::uint64_t seed) {
  for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
    if (!array.is_absent(taxel)) taxels_.push_back(taxel);
  }
  assert(taxels >= 1 && taxels <= taxels_.size());
  Random random = Random::stream(seed, kTaxelStream);
  for (std::size_t i = 0; i < taxels; ++i) std::swap(taxels_[i], taxels_[i + random.below(taxels_.size() - i)]);
  taxels_.resize(taxels);
}

double WeightScript::seconds(std::size_t taxels) {
  return kUnloadedS + kCycleS * static_cast<double>(kRounds * taxels);
}

WeightScript::Moment WeightScript::at(double time_s) const {
  if (time_s < kUnloadedS) return {taxels_.front(), 0.0, true};
  const auto cycle = static_cast<std::size_t>((time_s - kUnloadedS) / kCycleS);
  const double within_s = time_s - kUnloadedS - kCycleS * static_cast<double>(cycle);
  std::size_t step = kSteps.size() - 1;
  while (step > 0 && within_s < kSteps[step].begin_s) --step;
  const double before_n = step == 0 ? 0.0 : kSteps[step - 1].force_n;
  double done = std::clamp((within_s - kSteps[step].begin_s) / kHandS, 0.0, 1.0);
  if (done > kDone) done = 1.0;
  return {taxels_[cycle % taxels_.size()], before_n + done * (kSteps[step].force_n - before_n), done >= 1.0};
}

}  // namespace dermis::learn::simulation
