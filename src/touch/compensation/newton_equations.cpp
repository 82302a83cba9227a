// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/newton_equations.hpp"

#include <algorithm>
#include <cstddef>

namespace dermis::touch::compensation {
namespace {

constexpr double kLeastOwnShare = 1e-3;  // of a taxel in its reading that the scaling of the equations counts on

}  // namespace

NewtonEquations::NewtonEquations(ScaledCircuit& circuit)
    : circuit_(circuit), solver_(circuit.x().size()), held_(circuit.x().size()) {
  for (auto* values : {&own_slope_, &row_scale_, &column_scale_, &wanted_, &right_, &solution_, &scaled_}) {
    values->resize(circuit.x().size());
  }
}

void NewtonEquations::set_up() noexcept {
  CircuitModel& model = circuit_.model();
  const std::vector<double>& x = circuit_.x();
  model.own_derivatives(own_slope_);
  for (std::size_t k = 0; k < x.size(); ++k) {
    const ReadingScale& reading = circuit_.readings()[k];
    const double slope = reading.slope(model.ratio()[k]);
    const double least_own_slope = kLeastOwnShare * reading.open_slope(model.ratio()[k]);
    row_scale_[k] = slope;
    column_scale_[k] = 1.0 / (slope * std::max(own_slope_[k], least_own_slope));
    wanted_[k] = circuit_.is_kept(k) ? circuit_.measured()[k] : 0.0;
    held_[k] = circuit_.is_kept(k) || x[k] + circuit_.misfit()[k] <= 0.0;
    const double lacking = reading.siemens(wanted_[k]) - circuit_.siemens()[k];
    right_[k] = held_[k] ? lacking / column_scale_[k] : circuit_.misfit()[k];
  }
}

void NewtonEquations::release_taxels() noexcept {
  std::fill(held_.begin(), held_.end(), false);
}

void NewtonEquations::solve(double damping, double accuracy) noexcept {
  const std::size_t taxels = right_.size();
  const auto product = [&](std::span<const double> in, std::span<double> out) {
    for (std::size_t k = 0; k < taxels; ++k) scaled_[k] = in[k] * column_scale_[k];
    circuit_.model().multiply_taxel_jacobian(scaled_, out);
    for (std::size_t k = 0; k < taxels; ++k) out[k] = held_[k] ? in[k] : out[k] * row_scale_[k] + damping * in[k];
  };
  solver_.solve(product, right_, solution_, accuracy);
}

double NewtonEquations::change(std::size_t taxel) const noexcept {
  const double x = circuit_.x()[taxel];
  return held_[taxel] ? wanted_[taxel] - x
                      : solution_[taxel] * column_scale_[taxel] / circuit_.readings()[taxel].siemens_slope(x);
}

}  // namespace dermis::touch::compensation
