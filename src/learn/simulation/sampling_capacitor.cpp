// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/sampling_capacitor.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace dermis::learn::simulation {

SamplingCapacitor::SamplingCapacitor(const ArrayDescription& array)
    : kept_(array.readout.adc_errors.settling.value_or(0.0)), scan_(array.taxel_count()) {
  const std::vector<std::size_t> places = array.order.sent_places(array.order.sent({array.rows, array.cols}));
  std::iota(scan_.begin(), scan_.end(), std::size_t{0});
  std::sort(scan_.begin(), scan_.end(), [&](std::size_t a, std::size_t b) { return places[a] < places[b]; });
}

void SamplingCapacitor::sample(std::span<double> ratio, double supply_v) {
  assert(ratio.size() == scan_.size());
  if (kept_ == 0.0) return;
  for (const std::size_t taxel : scan_) {
    const double input_v = ratio[taxel] * supply_v;
    held_v_ = input_v + kept_ * (held_v_.value_or(input_v) - input_v);
    ratio[taxel] = *held_v_ / supply_v;
  }
}

}  // namespace dermis::learn::simulation
