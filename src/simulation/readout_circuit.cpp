// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/simulation/readout_circuit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cassert>

namespace dermis::simulation {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Eigen::ArrayXd;

Eigen::Map<const Matrix> as_matrix(std::span<const double> values, std::size_t rows, std::size_t cols) {
  return {values.data(), static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(cols)};
}

Eigen::Map<Matrix> as_matrix(std::span<double> values, std::size_t rows, std::size_t cols) {
  return {values.data(), static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(cols)};
}

Eigen::Map<const ArrayXd> as_array(const std::vector<double>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

// Voltage of each row line over the supply, while it is driven and all columns stand at 0 V.
ArrayXd driven_row_voltage(const Eigen::Map<const Matrix>& conductance, const std::vector<double>& drive_ohm) {
  return (1.0 + as_array(drive_ohm) * conductance.rowwise().sum().array()).inverse();
}

}  // namespace

Result<ReadoutCircuit> ReadoutCircuit::create(const ArrayDescription& array) {
  if (Status valid = array.validate(); !valid) return valid.error();
  const Readout& readout = array.readout;
  if (array.has_unknown_circuit()) {
    return bad_input("readout: the circuit or some of its resistances are to be fitted; a simulation needs numbers");
  }
  if (readout.circuit == Circuit::flexitac || readout.idle_columns == IdleColumns::floating ||
      !readout.row_segment_ohm.empty() || !readout.column_segment_ohm.empty() || !readout.column_switch_ohm.empty() ||
      !readout.amplifier_offset_v.empty() || readout.amplifier_gain) {
    return bad_input("readout: this circuit cannot be simulated yet");
  }
  return ReadoutCircuit(array);
}

void ReadoutCircuit::ratios(std::span<const double> siemens, std::span<double> ratio) const {
  assert(siemens.size() == rows_ * cols_ && ratio.size() == rows_ * cols_);
  switch (readout_.circuit) {
    case Circuit::divider: divide(siemens, ratio); break;
    case Circuit::transimpedance: amplify(siemens, ratio); break;
    case Circuit::flexitac: break;
    case Circuit::automatic: break;
    case Circuit::none: as_matrix(ratio, rows_, cols_) = kUnknownCircuitOhm * as_matrix(siemens, rows_, cols_); break;
  }
  if (readout_.pressure_raises_reading) return;
  for (double& reading : ratio) reading = 1.0 - reading;
}

// The row lines are eliminated by hand, A being diagonal, which also admits drivers of 0 ohm. It leaves a symmetric
// positive definite system for the column lines, (B - sum_i e_i g_i g_i^T) v = w_k g_k, where g_i is row i of G,
// w_k = 1/(1 + drive_ohm_k Y_k), Y_k = sum_j G_kj, and e_i = 1/A_i: drive_ohm_i w_i for a grounded row, 1/Y_i for a
// floating one. Grounded, it is the same system for all k. Floating, row k differs from the all-floating system by
// (w_k/Y_k) g_k g_k^T, since 1/Y_k - drive_ohm_k w_k = w_k/Y_k: the Sherman-Morrison formula.
void ReadoutCircuit::divide(std::span<const double> siemens, std::span<double> ratio) const {
  const auto conductance = as_matrix(siemens, rows_, cols_);
  const ArrayXd row_sum = conductance.rowwise().sum();
  const ArrayXd inverse_row_sum = (row_sum > 0.0).select(row_sum.inverse(), 0.0);
  const ArrayXd driven = driven_row_voltage(conductance, readout_.drive_ohm);
  const bool floating = readout_.idle_rows == IdleRows::floating;
  const ArrayXd eliminated = floating ? inverse_row_sum : as_array(readout_.drive_ohm) * driven;

  Eigen::MatrixXd columns = -(conductance.transpose() * eliminated.matrix().asDiagonal() * conductance);
  columns.diagonal().array() += as_array(readout_.load_ohm).inverse() + conductance.colwise().sum().transpose().array();
  const Eigen::MatrixXd response = columns.ldlt().solve(conductance.transpose());  // [cols, rows]

  ArrayXd scale = driven;
  if (floating) {
    const ArrayXd self = conductance.cwiseProduct(response.transpose()).rowwise().sum();
    scale = driven / (1.0 + driven * inverse_row_sum * self);
  }
  as_matrix(ratio, rows_, cols_) = scale.matrix().asDiagonal() * response.transpose();
}

// With all columns at 0 V, idle rows carry no current into them, grounded or floating.
void ReadoutCircuit::amplify(std::span<const double> siemens, std::span<double> ratio) const {
  const auto conductance = as_matrix(siemens, rows_, cols_);
  const ArrayXd driven = driven_row_voltage(conductance, readout_.drive_ohm);
  as_matrix(ratio, rows_, cols_) =
      driven.matrix().asDiagonal() * conductance * as_array(readout_.load_ohm).matrix().asDiagonal();
}

}  // namespace dermis::simulation
