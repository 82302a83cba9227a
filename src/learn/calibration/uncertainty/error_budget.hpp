// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "dermis/learn/calibration/force_training.hpp"
#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/fusion/force_fusion.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::learn::calibration {

/// Squares of the relative error at the knots of touch::fusion::ForceNetworks::relative_sigma.
using VarianceProfile = std::array<double, touch::fusion::kSigmaKnots>;

/// A tested load with the variances of the sum of its taxels' forces, by where they come from [N^2].
struct JudgedLoad {
  const TestedLoad* tested = nullptr;
  double square_noise = 0.0;
  double square_error = 0.0;
  double newtons = 0.0;
  double instruments = 0.0;    // ADC, temperature sensor, unloaded conductance
  double supply = 0.0;         // for a supply error of kUnitSupplyNoise, which all taxels share
  VarianceProfile material{};  // for a relative error of 1 at each knot

  [[nodiscard]] double variance(double supply_noise, const VarianceProfile& profile) const;

  static constexpr double kUnitSupplyNoise = 0.005;
};

/// The error of the supply that explains all of the scatter from load to load within touches, of which there must be 20
/// pairs. A supply is measured anew for each of them.
[[nodiscard]] std::optional<double> most_supply_noise(const std::vector<JudgedLoad>& loads);

/// The budget of some of the tested loads, at most 4,000, by what `model` says of its instruments. Left out are loads
/// to which the material adds nothing. `loads` must outlive it. Errors: those of Compensator::create().
[[nodiscard]] Result<std::vector<JudgedLoad>> judge_loads(const SampleDatabase& database,
                                                          const std::vector<TestedLoad>& loads,
                                                          const touch::pipeline::Model& model);

}  // namespace dermis::learn::calibration
