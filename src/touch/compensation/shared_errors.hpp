// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/force_sums.hpp"

namespace dermis::touch::compensation {

/// How errors add up in sum_ij c_ij G_ij, driven lines i and sensed lines j (docs/reasons/derivations-forces.md, "Sums
/// of forces"). With the symbols of GroundedRows, u_i = Rd_i sum_j c_ij G_ij and v_j = RL_j sum_i c_ij G_ij, to first
/// order:
///
///   noise of a reading     (S D^-1)_ii / w_j (c_ij + u_i + v_j)      GroundedRows::propagate_noise, transposed
///   supply, relative       sum_ij c_ij G_ij a_i / w_j                SupplyError
///   a taxel in doubt       c_ij + u_i + v_j                          FaultInversion::add_doubt
///   a driver k [S/ohm]     sum_ij c_ij d G_ij / d s_k                DriverError, with y = diag(1/a) G diag(w)
///
/// Circuits with floating rows or resistive lines are taken as if they were ideal and grounded, but for noise and
/// drivers. There each taxel's own standard deviation counts (ConductanceErrors::noise_siemens), as if independent.
class SharedErrors final : public CircuitErrors {
 public:
  explicit SharedErrors(const ArrayDescription& array);

  /// Whether variances() contains the noise of readings; otherwise ConductanceErrors::noise_siemens must.
  [[nodiscard]] bool tells_noise() const noexcept { return tells_noise_; }

  /// Lets the standard deviations of conductances by noise count what readings have in common
  /// (ConductanceErrors::shared_noise). Allocates nothing after the first call of a thread.
  void share_noise(const ConductanceErrors& errors, std::span<double> sigma_siemens) const noexcept;

  void variances(const ConductanceErrors& errors, std::span<const WeightedConductances> sums,
                 std::span<double> variances) const noexcept override;

 private:
  struct Frame;
  struct Sum;
  struct Lines {
    std::size_t driven;
    std::size_t sensed;
  };

  [[nodiscard]] std::size_t at(std::size_t driven, std::size_t sensed) const noexcept {
    return driven * driven_step_ + sensed * sensed_step_;
  }
  void find_lines(const ConductanceErrors& errors, Frame& frame) const noexcept;
  void find_sensed_lines(Frame& frame) const noexcept;
  void sum_conductances(std::span<const float> of_taxels, Frame& frame) const noexcept;
  void find_own_gains(Frame& frame) const noexcept;
  void weigh(const Frame& frame, const WeightedConductances& of, Sum& sum) const noexcept;
  [[nodiscard]] double noise(const ConductanceErrors& errors, const Frame& frame, const Sum& sum) const noexcept;
  [[nodiscard]] double shared_noise(const ConductanceErrors& errors, const Frame& frame, Sum& sum) const noexcept;
  void shift_through_lines(const ConductanceErrors& errors, const Frame& frame, Sum& sum) const noexcept;
  [[nodiscard]] double supply(const ConductanceErrors& errors, const Frame& frame, const Sum& sum) const noexcept;
  [[nodiscard]] double estimated_taxels(const ConductanceErrors& errors, const Frame& frame,
                                        const Sum& sum) const noexcept;
  [[nodiscard]] double drivers(const Frame& frame, Sum& sum) const noexcept;
  [[nodiscard]] double driver_shift(std::size_t driver, const Frame& frame, Sum& sum) const noexcept;
  void find_lifts(std::size_t driver, const Frame& frame, Sum& sum) const noexcept;

  std::vector<Lines> lines_;  // [taxels]
  std::size_t driven_step_;
  std::size_t sensed_step_;
  bool tells_noise_;
  bool one_loaded_;
  double supply_noise_;
  std::vector<double> driven_ohm_;       // Rd [driven]
  std::vector<double> sensed_ohm_;       // RL [sensed]
  std::vector<double> reading_siemens_;  // y of a ratio of 1 [sensed]
  std::vector<double> drive_error_ohm_;  // [driven]; empty: none counts
  double correlation_;
};

}  // namespace dermis::touch::compensation
