// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/faults/supplied_column_detector.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace dermis::touch::compensation {
namespace {

constexpr double kFullScale = 0.97;            // of the supply
constexpr double kAgainst = -kEvidence * 1e3;  // of one frame: back to 0
constexpr int kLoadsWhereTheyReachFullScale = 20;
constexpr double kNewLoad = 0.2;            // relative change
constexpr std::size_t kColumnsForEach = 4;  // that is at the supply; where more read full scale, loads do it

bool reads_full_scale(const Observation& seen, const ArrayDescription& array, std::size_t col,
                      const FaultList& faults) {
  bool any = false;
  for (std::size_t row = 0; row < array.rows; ++row) {
    const std::size_t taxel = array.index(row, col);
    if ((faults.causes(taxel) & (kRowCause | kStuckCause)) != 0) continue;
    const bool is_saturated = seen.conditioned.taxels[taxel] == TaxelStatus::saturated;
    if (!is_saturated && seen.conditioned.ratio[taxel] < kFullScale) return false;
    any = true;
  }
  return any;
}

/// True with an amplifier at its rail, with rows that float, and without another row that holds the column down.
bool can_reach_full_scale(const ArrayDescription& array) {
  const Readout& readout = array.readout;
  return readout.circuit != Circuit::divider || readout.idle_rows != IdleRows::grounded || array.rows == 1;
}

}  // namespace

SuppliedColumnDetector::SuppliedColumnDetector(const ArrayDescription& array)
    : array_(array), loads_reach_full_scale_(can_reach_full_scale(array)), columns_(array.cols) {}

void SuppliedColumnDetector::judge(const Observation& seen, FaultList& faults) noexcept {
  if (array_.readout.circuit == Circuit::none) return;
  constexpr LineFaultKind kKind = LineFaultKind::supplied_column;
  const bool are_few = kColumnsForEach * find_full_scale(seen, faults) <= array_.cols;
  const int least_frames = loads_reach_full_scale_ ? kLoadsWhereTheyReachFullScale : kLineFrames;
  const Nanos time = seen.conditioned.time;
  for (std::size_t col = 0; col < array_.cols; ++col) {
    auto& [is_full_scale, elsewhere, supplied, released] = columns_[col];
    if (!faults.contains(kKind, col)) {
      const bool speaks_for = is_full_scale && are_few;
      if (speaks_for && loads_reach_full_scale_ && !loads_have_changed(seen, col)) continue;
      supplied.add(speaks_for ? kEvidence : kAgainst, seen.frame, time);
      if (!supplied.decides(least_frames)) continue;
      faults.add({.kind = kKind, .place = col, .frame = supplied.first_frame, .time = supplied.first_time});
      released.restart();
    } else {
      released.add(is_full_scale ? kAgainst : kEvidence, seen.frame, time);
      if (!released.decides(kHealFrames)) continue;
      faults.remove(kKind, col);
      supplied.restart();
    }
  }
}

bool SuppliedColumnDetector::loads_have_changed(const Observation& seen, std::size_t col) noexcept {
  const std::span<const double> sums = seen.sums.ratio(Axis::column);
  const double now = std::accumulate(sums.begin(), sums.end(), -sums[col]);
  double& last = columns_[col].elsewhere;
  const double noise = seen.conditioned.sigma_ratio * std::sqrt(static_cast<double>(array_.taxel_count()));
  if (std::abs(now - last) <= std::max(kNewLoad * std::max(now, last), kPressedSigmas * noise)) return false;
  last = now;
  return true;
}

std::size_t SuppliedColumnDetector::find_full_scale(const Observation& seen, const FaultList& faults) noexcept {
  std::size_t count = 0;
  for (std::size_t col = 0; col < array_.cols; ++col) {
    columns_[col].is_full_scale = reads_full_scale(seen, array_, col, faults);
    count += columns_[col].is_full_scale ? 1 : 0;
  }
  return count;
}

}  // namespace dermis::touch::compensation
