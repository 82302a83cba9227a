// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::touch::preprocessing {

/// Supplies from the least to the most [V], 0 ... infinity.
struct SupplyRange {
  double least_v = 0.0;
  double most_v = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool contains(double supply_v) const noexcept { return supply_v >= least_v && supply_v <= most_v; }
  /// Finite, and the least is not more than the most.
  [[nodiscard]] bool is_consistent() const noexcept {
    return least_v >= 0.0 && least_v <= most_v && std::isfinite(most_v);
  }
  bool operator==(const SupplyRange&) const = default;
};

/// Decides which supplies of frames are believed. Nothing is bounded where the ADC's reference is the supply itself,
/// for then the supply has no part in the forces. Thread-safe.
///
///   trusted      used as it is: what was calibrated and nominal +- 10 %, 1 % more for the meter; or, where it is not
///                known what was calibrated, nominal +- 20 %
///   plausible    nominal +- 20 %: the nearest that is trusted is used
///   possible     from a third of nominal to three times it: the meter is probably wrong, so nominal is used; beyond it
///                no frame can be used
///
/// Without a nominal supply (readout.supply_v) the middle of the calibrated range takes its place. Where that is
/// unknown too, everything is trusted from a hundredth of the ADC's reference to a hundred times it.
class SupplyBounds {
 public:
  /// For a calibration: possible supplies are trusted.
  explicit SupplyBounds(const Readout& readout);
  /// For an array at work. `calibrated`: the supplies of its calibration; empty: not known.
  SupplyBounds(const Readout& readout, const std::optional<SupplyRange>& calibrated);

  [[nodiscard]] const SupplyRange& trusted() const noexcept { return trusted_; }
  [[nodiscard]] bool is_possible(double supply_v) const noexcept { return possible_.contains(supply_v); }
  /// Whether a trusted supply or one that is plausible.
  [[nodiscard]] bool is_plausible(double supply_v) const noexcept {
    return plausible_.contains(supply_v) || trusted_.contains(supply_v);
  }
  /// The divisor of readings.
  [[nodiscard]] double used(double supply_v) const noexcept {
    return is_plausible(supply_v) ? std::clamp(supply_v, trusted_.least_v, trusted_.most_v) : nominal_v_;
  }
  /// Standard deviation of what is used, relative, beside the noise of the meter: 0 where the supply is trusted. Where
  /// it is not, the meter may be right, or the supply as ever: the distance from nominal covers both.
  [[nodiscard]] double doubt(double supply_v) const noexcept {
    return trusted_.contains(supply_v) ? 0.0 : std::abs(nominal_v_ / supply_v - 1.0);
  }
  /// It is not possible, but a thousandth of it is.
  [[nodiscard]] bool is_in_millivolts(double supply_v) const noexcept;

  /// Why a supply is not possible, and what is: "a supply of 5000 V (1.67 to 15 V are possible): ...".
  [[nodiscard]] std::string describe_impossible(double supply_v) const;

 private:
  double nominal_v_ = 0.0;  // where not everything is trusted
  SupplyRange trusted_;
  SupplyRange plausible_;
  SupplyRange possible_;
};

}  // namespace dermis::touch::preprocessing
