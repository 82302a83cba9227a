// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "dermis/touch/compensation/circuit_model.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "touch/compensation/film_follower.hpp"

namespace dermis::touch::compensation {

/// A circuit whose supply has a resistance of its own that idle lines do not share. All currents of a scan are in
/// proportion to what is left of the supply in it, so
///
///   reading = left(G) reading of an ideal supply(G),     left = 1/(1 + supply_ohm Y(G))
///
/// A fixed point: the readings of an ideal supply are found with what was left, inverted, and give what is left. Each
/// pass shrinks the error to about the share that the supply loses.
class SaggingSupply final : public CrosstalkInversion {
 public:
  /// `ideal`: of the same circuit with an ideal supply. `model`: of the circuit. `film`: of the array.
  SaggingSupply(std::unique_ptr<CrosstalkInversion> ideal, CircuitModel model, FilmFollower film,
                double tolerance_ratio);

  [[nodiscard]] InversionResult invert(std::span<const double> ratio, std::span<double> siemens) noexcept override;
  void hold_film(const FilmConductances& film) noexcept override;
  bool start_frame(Nanos time) noexcept override { return ideal_->start_frame(time); }
  void start_attempt(double share) noexcept override { ideal_->start_attempt(share); }
  void forget() noexcept override;
  void propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept override;
  [[nodiscard]] double siemens_per_ratio() const noexcept override { return ideal_->siemens_per_ratio(); }

 private:
  [[nodiscard]] double follow_supply(std::span<const double> ratio) noexcept;

  std::unique_ptr<CrosstalkInversion> ideal_;
  CircuitModel model_;
  FilmFollower film_;
  double tolerance_;
  std::vector<double> left_;        // of the supply in each reading
  std::vector<double> full_ratio_;  // of an ideal supply
};

}  // namespace dermis::touch::compensation
