// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/evaluation/noise_bound.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

namespace dermis::learn::calibration {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The networks without any error of their own.
touch::fusion::ForceNetworks exact(touch::fusion::ForceNetworks networks) {
  networks.temperature_sigma_celsius = 0.0;
  std::fill(networks.offset_sigma_siemens.begin(), networks.offset_sigma_siemens.end(), 0.0F);
  std::fill(networks.relative_sigma.begin(), networks.relative_sigma.end(), 1e-6F);
  return networks;
}

}  // namespace

std::optional<NoiseBound> NoiseBound::create(const touch::pipeline::Model& model) {
  if (model.array.taxel_count() > kMostTaxels) return std::nullopt;
  Result<touch::compensation::CircuitModel> circuit = touch::compensation::CircuitModel::create(model.array);
  if (!circuit) return std::nullopt;
  return NoiseBound(std::move(*circuit), model.networks);
}

NoiseBound::NoiseBound(touch::compensation::CircuitModel circuit, touch::fusion::ForceNetworks networks)
    : circuit_(std::move(circuit)), taxels_(networks.taxel_count()), fusion_(exact(std::move(networks))) {}

std::size_t NoiseBound::affordable_frames() const {
  constexpr double kFrames = 20.0;  // of 16 x 16
  constexpr double kTaxels = 256.0;
  return static_cast<std::size_t>(
      std::clamp(kFrames * std::pow(kTaxels / static_cast<double>(taxels_), 3), 1.0, 200.0));
}

std::vector<float> NoiseBound::newtons(const ConductanceFrame& conductance, double sigma_ratio) {
  const auto n = static_cast<Eigen::Index>(taxels_);
  Matrix jacobian(n, n);
  circuit_.solve(conductance.siemens);
  circuit_.taxel_jacobian({jacobian.data(), static_cast<std::size_t>(jacobian.size())});
  const Eigen::VectorXd sigma = sigma_ratio * jacobian.partialPivLu().inverse().rowwise().norm();
  ConductanceFrame bounded = conductance;
  bounded.sigma_siemens.assign(sigma.begin(), sigma.end());
  ForceFrame force;
  fusion_.process(bounded, force);
  return force.sigma_newtons;
}

}  // namespace dermis::learn::calibration
