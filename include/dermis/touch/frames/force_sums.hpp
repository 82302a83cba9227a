// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace dermis {

/// A sum of forces over taxels.
struct TotalForce {
  double newtons = 0.0;        ///< [N]; noise takes it below 0 where nothing presses. NaN: all are left out.
  double sigma_newtons = 0.0;  ///< Standard deviation [N]; infinite where that of a taxel is, NaN where newtons is.
  std::size_t left_out = 0;    ///< Taxels without a force (NaN), which the sum leaves out.

  bool operator==(const TotalForce&) const = default;
};

class CircuitErrors;

/// The conductances of a frame and how wrong they may be, for errors that several taxels share.
struct ConductanceErrors {
  std::vector<float> siemens;        ///< [taxels] [S]
  std::vector<float> noise_siemens;  ///< Standard deviation of each by noise; empty where `circuit` has it [S].
  std::vector<float> doubt_siemens;  ///< Standard deviation of taxels in doubt, 0 of the others [S].
  double sigma_ratio = 0.0;          ///< Standard deviation of every reading over the supply.
  std::vector<float> shared_noise;   ///< As in ConditionedFrame.
  double supply_doubt = 0.0;         ///< Relative standard deviation of a supply that is not trusted.
  std::shared_ptr<const CircuitErrors> circuit;  ///< Null: noise_siemens are independent.
};

/// sum_k weight_k G_k over some taxels of a frame, each of them once.
struct WeightedConductances {
  std::span<const std::size_t> taxels;
  std::span<const double> weight;  ///< [taxels]
};

/// How errors of readings, supply and drivers spread over the taxels of a circuit. Immutable, so thread-safe.
class CircuitErrors {
 public:
  CircuitErrors() = default;
  CircuitErrors(const CircuitErrors&) = delete;
  CircuitErrors& operator=(const CircuitErrors&) = delete;
  virtual ~CircuitErrors() = default;

  /// Variance of each of `sums` of one frame, to first order. Allocates nothing after the first call of a thread.
  virtual void variances(const ConductanceErrors& errors, std::span<const WeightedConductances> sums,
                         std::span<double> variances) const noexcept = 0;
};

/// Relative errors of gains that stay as they are from frame to frame.
struct GainErrors {
  std::vector<float> sigma;   ///< Standard deviation of each gain [taxels]; empty: none is known.
  std::size_t cols = 0;       ///< A taxel is row * cols + col.
  double sheet_share = 0.0;   ///< Share of the variance that all gains have in common,
  double row_share = 0.0;     ///< those of a row,
  double column_share = 0.0;  ///< and those of a column; the rest is each taxel's own.

  bool operator==(const GainErrors&) const = default;

  /// That of the sum of `newtons` over `taxels` [N^2]. Allocates nothing after the first call of a thread.
  [[nodiscard]] double variance(std::span<const float> newtons, std::span<const std::size_t> taxels) const noexcept;

  /// Empty, or of `taxels` finite numbers of at least 0, with shares of a whole.
  [[nodiscard]] bool is_consistent(std::size_t taxels) const noexcept;
};

/// The data that sums of forces need beside the forces. Each vector has the size taxels, or all are empty.
///
/// Forces are cut at zero, so the noise of unloaded taxels adds up in their sum. Here the law continues below zero,
/// F(-e) = -F(e), and noise of either sign cancels.
struct ForceSums {
  std::vector<float> newtons;               ///< Signed force [N]; NaN where there is none.
  std::vector<float> own_variance;          ///< Variance that taxels do not share: material, zero [N^2].
  std::vector<float> newtons_per_siemens;   ///< d newtons / d conductance [N/S].
  std::vector<float> newtons_per_celsius;   ///< d newtons / d temperature at a fixed conductance [N/C].
  double temperature_sigma = 0.0;           ///< Standard deviation of the temperature [C].
  double gain_sigma = 0.0;                  ///< Relative standard deviation that all forces share.
  std::shared_ptr<const GainErrors> gains;  ///< Null: none are known.
  ConductanceErrors conductances;
};

}  // namespace dermis
