// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/solved_slopes.hpp"

#include <Eigen/LU>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

namespace dermis::learn::calibration {
namespace {

using Eigen::Index;

template <typename Dense>
std::span<double> view(Dense& dense) {
  return {dense.data(), static_cast<std::size_t>(dense.size())};
}

}  // namespace

SolvedSlopes::SolvedSlopes(const LineParameters& lines, const Eigen::VectorXd& parameters,
                           touch::compensation::CircuitModel model)
    : model_(std::move(model)), ohm_per_parameter_(parameters.size()) {
  const ArrayDescription& array = lines.array();
  const auto taxels = static_cast<Index>(array.taxel_count());
  by_taxel_.resize(taxels, taxels);
  by_drive_.resize(taxels, static_cast<Index>(array.driven_lines()));
  by_load_.resize(taxels, static_cast<Index>(array.sensed_lines()));
  for (const std::size_t line : lines.drives()) lines_.push_back(static_cast<Index>(line));
  for (const std::size_t line : lines.loads()) lines_.push_back(by_drive_.cols() + static_cast<Index>(line));
  ohm_per_parameter_.head(lines.drive_count()).setConstant(lines.reference_ohm());
  ohm_per_parameter_.tail(lines.load_count()) =
      lines.reference_ohm() * parameters.tail(lines.load_count()).array().exp();
}

Result<SolvedSlopes> SolvedSlopes::create(const LineParameters& lines, const Eigen::VectorXd& parameters) {
  Result<touch::compensation::CircuitModel> model =
      touch::compensation::CircuitModel::create(lines.array_at(parameters));
  if (!model) return model.error();
  return SolvedSlopes(lines, parameters, *std::move(model));
}

void SolvedSlopes::differentiate(const std::vector<double>& siemens, Eigen::MatrixXd& slopes) {
  model_.solve(siemens);
  model_.taxel_jacobian(view(by_taxel_));
  model_.drive_jacobian(view(by_drive_));
  model_.load_jacobian(view(by_load_));
  for (std::size_t p = 0; p < lines_.size(); ++p) {
    const Index line = lines_[p];
    const auto column = static_cast<Index>(p);
    if (line < by_drive_.cols()) {
      slopes.col(column) = -ohm_per_parameter_[column] * by_drive_.col(line);
    } else {
      slopes.col(column) = -ohm_per_parameter_[column] * by_load_.col(line - by_drive_.cols());
    }
  }
  slopes = by_taxel_.partialPivLu().solve(slopes).eval();
}

}  // namespace dermis::learn::calibration
