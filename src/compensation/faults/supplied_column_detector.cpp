// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/faults/supplied_column_detector.hpp"

namespace dermis::compensation {
namespace {

constexpr double kFullScale = 0.97;                  // of the supply
constexpr double kAgainst = -kEvidence * 1e3;        // of one frame: back to 0
constexpr int kFramesWhereLoadsReachFullScale = 20;  // an amplifier at its rail, rows that float
constexpr std::size_t kColumnsForEach = 4;           // that is at the supply; where more read full scale, loads do it

bool reads_full_scale(const Observation& seen, const ArrayDescription& array, std::size_t col,
                      const FaultList& faults) {
  for (std::size_t row = 0; row < array.rows; ++row) {
    const std::size_t taxel = array.index(row, col);
    if ((faults.causes(taxel) & (kRowCause | kStuckCause)) != 0) continue;
    const bool is_saturated = seen.conditioned.taxels[taxel] == TaxelStatus::saturated;
    if (!is_saturated && seen.conditioned.ratio[taxel] < kFullScale) return false;
  }
  return true;
}

}  // namespace

SuppliedColumnDetector::SuppliedColumnDetector(const ArrayDescription& array) : array_(array), columns_(array.cols) {}

void SuppliedColumnDetector::judge(const Observation& seen, FaultList& faults) noexcept {
  constexpr LineFaultKind kKind = LineFaultKind::supplied_column;
  const bool are_few = kColumnsForEach * find_full_scale(seen, faults) <= array_.cols;
  const bool loads_reach_full_scale =
      array_.readout.circuit != Circuit::divider || array_.readout.idle_rows != IdleRows::grounded;
  const int least_frames = loads_reach_full_scale ? kFramesWhereLoadsReachFullScale : kLineFrames;
  const Nanos time = seen.conditioned.time;
  for (std::size_t col = 0; col < array_.cols; ++col) {
    auto& [is_full_scale, supplied, released] = columns_[col];
    if (!faults.contains(kKind, col)) {
      supplied.add(is_full_scale && are_few ? kEvidence : kAgainst, seen.frame, time);
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

std::size_t SuppliedColumnDetector::find_full_scale(const Observation& seen, const FaultList& faults) noexcept {
  std::size_t count = 0;
  for (std::size_t col = 0; col < array_.cols; ++col) {
    columns_[col].is_full_scale = reads_full_scale(seen, array_, col, faults);
    count += columns_[col].is_full_scale ? 1 : 0;
  }
  return count;
}

}  // namespace dermis::compensation
