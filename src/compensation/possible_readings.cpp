// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/possible_readings.hpp"

#include <limits>

#include "compensation/sensed_line.hpp"
#include "dermis/core/axis.hpp"

namespace dermis::compensation {
namespace {

constexpr double kAllowedRatio = 1.02;  // by how much the resistances of the readout may be wrong
constexpr double kAllowedSigmas = 6.0;

double most_ratio(const Readout& readout, std::size_t driven, std::size_t sensed) {
  const SensedLine line = sensed_line(readout, sensed);
  const double series = readout.drive_ohm[driven] + line.rho;
  if (!(series > 0.0)) return std::numeric_limits<double>::infinity();
  return line.gain * (1.0 - line.emf) / series + line.offset;
}

}  // namespace

PossibleReadings::PossibleReadings(const ArrayDescription& array)
    : most_ratio_(array.taxel_count(), std::numeric_limits<double>::infinity()) {
  if (array.readout.circuit == Circuit::none) return;
  const bool rows_are_driven = driven_axis(array) == Axis::row;
  for (std::size_t taxel = 0; taxel < most_ratio_.size(); ++taxel) {
    const std::size_t row = taxel / array.cols;
    const std::size_t col = taxel % array.cols;
    most_ratio_[taxel] = most_ratio(array.readout, rows_are_driven ? row : col, rows_are_driven ? col : row);
  }
}

void PossibleReadings::check(std::span<const double> ratio, double sigma_ratio,
                             std::span<TaxelStatus> taxels) const noexcept {
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
    const bool is_possible = ratio[taxel] <= kAllowedRatio * most_ratio_[taxel] + kAllowedSigmas * sigma_ratio;
    if (!is_possible) taxels[taxel] = TaxelStatus::invalid;
  }
}

std::size_t PossibleReadings::largest(std::span<const double> ratio,
                                      std::span<const TaxelStatus> taxels) const noexcept {
  std::size_t found = 0;
  double most = 0.0;
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
    const double share = ratio[taxel] / most_ratio_[taxel];
    if (taxels[taxel] == TaxelStatus::invalid || !(share > most)) continue;
    most = share;
    found = taxel;
  }
  return found;
}

}  // namespace dermis::compensation
