// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dermis/touch/compensation/circuit_model.hpp"
#include "dermis/touch/frames/result.hpp"
#include "learn/calibration/circuit_fit/line_parameters.hpp"

namespace dermis::learn::calibration {

/// How the conductances that give the same readings move with the parameters, from the derivatives of the readings. One
/// factorisation replaces an inversion beside each parameter, which takes long where rows float.
class SolvedSlopes {
 public:
  static Result<SolvedSlopes> create(const LineParameters& lines, const Eigen::VectorXd& parameters);

  /// d siemens / d parameter [taxels, parameters].
  void differentiate(const std::vector<double>& siemens, Eigen::MatrixXd& slopes);

 private:
  SolvedSlopes(const LineParameters& lines, const Eigen::VectorXd& parameters, touch::compensation::CircuitModel model);

  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  touch::compensation::CircuitModel model_;
  std::vector<Eigen::Index> lines_;  // of the parameters, driven ones before sensed ones
  Eigen::VectorXd ohm_per_parameter_;
  Matrix by_taxel_;  // d reading / d siemens
  Matrix by_drive_;  // d reading / d ohm
  Matrix by_load_;
};

}  // namespace dermis::learn::calibration
