// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/readout_circuit.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cassert>
#include <limits>
#include <vector>

#include "learn/simulation/grounded_divider_forward.hpp"
#include "learn/simulation/terminal_network.hpp"

namespace dermis::learn::simulation {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr double kNothing = std::numeric_limits<double>::infinity();  // the series resistor of a line that floats

Eigen::Map<const Table> as_table(std::span<const double> values, std::size_t rows, std::size_t cols) {
  return {values.data(), static_cast<Index>(rows), static_cast<Index>(cols)};
}

Eigen::Map<Table> as_table(std::span<double> values, std::size_t rows, std::size_t cols) {
  return {values.data(), static_cast<Index>(rows), static_cast<Index>(cols)};
}

ArrayXd as_array(const std::vector<double>& values) {
  return Eigen::Map<const ArrayXd>(values.data(), static_cast<Index>(values.size()));
}

ArrayXd array_or_zero(const std::vector<double>& values, Index size) {
  return values.empty() ? ArrayXd::Zero(size) : as_array(values);
}

/// The end of each sensed line: a resistor to a source, and the reading for the current through it. A divider's
/// resistor leads to 0 V; an amplifier's input is seen behind its switch and stands at offset gain/(1 + gain) + I
/// load/(1 + gain). Voltages are over the supply.
struct Sinks {
  ArrayXd ohm;
  ArrayXd source;
  ArrayXd load_ohm;
  ArrayXd offset;
  double gain = 1.0;  ///< of the reading

  /// [driven, sensed] from currents over the supply.
  [[nodiscard]] Table readings(const Table& current) const {
    const Table ideal = current * load_ohm.matrix().asDiagonal();
    return gain * (ideal.rowwise() - offset.matrix().transpose());
  }
};

Sinks sinks_of(const Readout& readout) {
  const ArrayXd load = as_array(readout.load_ohm);
  const ArrayXd none = ArrayXd::Zero(load.size());
  if (readout.circuit != Circuit::transimpedance) return {load, none, load, none};
  const double inverse_gain = readout.amplifier_gain ? 1.0 / *readout.amplifier_gain : 0.0;
  const double gain = 1.0 / (1.0 + inverse_gain);
  const ArrayXd offset = array_or_zero(readout.amplifier_offset_v, load.size()) / readout.supply_v.value_or(1.0);
  const ArrayXd input_ohm = array_or_zero(readout.column_switch_ohm, load.size()) + load * (inverse_gain * gain);
  return {input_ohm, offset * gain, load, offset, gain};
}

/// The driven lines, then the sensed lines, without sources.
Electronics electronics(const ArrayXd& driven_ohm, const ArrayXd& sensed_ohm, Index cases) {
  const Index terminals = driven_ohm.size() + sensed_ohm.size();
  ArrayXd series(terminals);
  series << driven_ohm, sensed_ohm;
  return {series, Table::Zero(terminals, cases), Table::Zero(terminals, cases)};
}

/// The rest of the supply behind its own resistance, where the driven line takes so much of an ideal one of 1 V [S].
template <typename Siemens>
auto left_of_supply(double supply_ohm, const Siemens& taken) {
  return 1.0 / (1.0 + supply_ohm * taken);
}

/// Case k: of line k.
ArrayXd taken_from_supply(const Solution& solution, Index driven) {
  return -solution.sunk_a.topLeftCorner(driven, driven).diagonal();
}

// Case k: line k is driven. Last case: the sources of the sensed lines alone, which act in every scan.
Table idle_driven_grounded(const TerminalNetwork& network, const ArrayXd& drive_ohm, const Sinks& sinks,
                           double supply_ohm) {
  const Index driven = drive_ohm.size();
  const Index sensed = sinks.ohm.size();
  Electronics scans = electronics(drive_ohm, sinks.ohm, driven + 1);
  scans.source_v.topLeftCorner(driven, driven).setIdentity();
  scans.source_v.col(driven).tail(sensed) = sinks.source;
  const Solution solution = solve(network, scans);
  const ArrayXd left = left_of_supply(supply_ohm, taken_from_supply(solution, driven));
  const Table sunk = solution.sunk_a.bottomRows(sensed).transpose();
  return sinks.readings((left.matrix().asDiagonal() * sunk.topRows(driven)).rowwise() + sunk.row(driven));
}

// Case k has unit current into line k, with all driven lines floating, so its resistance is V_kk. The driver sees the
// voltage of the sensed lines' sources against it, and drives (1 - V_k,last)/(drive_ohm_k + V_kk) into it.
Table idle_driven_floating(const TerminalNetwork& network, const ArrayXd& drive_ohm, const Sinks& sinks) {
  const Index driven = drive_ohm.size();
  const Index sensed = sinks.ohm.size();
  Electronics scans = electronics(ArrayXd::Constant(driven, kNothing), sinks.ohm, driven + 1);
  scans.current_a.topLeftCorner(driven, driven).setIdentity();
  scans.source_v.col(driven).tail(sensed) = sinks.source;
  const Solution solution = solve(network, scans);
  const ArrayXd resistance = drive_ohm + solution.voltage_v.topLeftCorner(driven, driven).diagonal().array();
  const ArrayXd drive = (1.0 - solution.voltage_v.col(driven).head(driven).array()) / resistance;
  const Table sunk = solution.sunk_a.bottomRows(sensed).transpose();
  return sinks.readings((drive.matrix().asDiagonal() * sunk.topRows(driven)).rowwise() + sunk.row(driven));
}

// Without any load: case k, line k driven, gives the open voltages V_jk; case driven + j, unit current into sensed line
// j, its resistance R_j. The load that is switched to it, behind the switch, takes I_jk = V_jk/(R_j + switch_ohm_j +
// load_ohm_j) and reads load_ohm_j I_jk. By reciprocity line k takes V_jk I_jk more of the supply for it.
Table one_load_grounded(const TerminalNetwork& network, const ArrayXd& drive_ohm, const ArrayXd& load_ohm,
                        const ArrayXd& switch_ohm, double supply_ohm) {
  const Index driven = drive_ohm.size();
  const Index sensed = load_ohm.size();
  Electronics scans = electronics(drive_ohm, ArrayXd::Constant(sensed, kNothing), driven + sensed);
  scans.source_v.topLeftCorner(driven, driven).setIdentity();
  scans.current_a.bottomRightCorner(sensed, sensed).setIdentity();
  const Solution solution = solve(network, scans);
  const ArrayXd own = solution.voltage_v.bottomRightCorner(sensed, sensed).diagonal();
  const Table open = solution.voltage_v.bottomLeftCorner(sensed, driven).transpose();
  const Table current = open * (load_ohm + switch_ohm + own).inverse().matrix().asDiagonal();
  const Table taken = open.cwiseProduct(current).colwise() + taken_from_supply(solution, driven).matrix();
  return (left_of_supply(supply_ohm, taken.array()) * current.array()).matrix() * load_ohm.matrix().asDiagonal();
}

// A series of driver, array and load. The array's resistance between line k and sensed line j is measured by a unit
// current into line k. It is the voltage there, with line j at 0 V and all others floating.
Table one_load_floating(const TerminalNetwork& network, const ArrayXd& drive_ohm, const ArrayXd& load_ohm,
                        const ArrayXd& switch_ohm) {
  const Index driven = drive_ohm.size();
  const Index sensed = load_ohm.size();
  Electronics scans = electronics(ArrayXd::Constant(driven, kNothing), ArrayXd::Constant(sensed, kNothing), driven);
  scans.current_a.topRows(driven).setIdentity();
  Table readings(driven, sensed);
  for (Index j = 0; j < sensed; ++j) {
    scans.series_ohm(driven + j) = 0.0;
    const ArrayXd array_ohm = solve(network, scans).voltage_v.topRows(driven).diagonal();
    readings.col(j) = load_ohm(j) / (drive_ohm + array_ohm + switch_ohm(j) + load_ohm(j));
    scans.series_ohm(driven + j) = kNothing;
  }
  return readings;
}

/// Readings [driven, sensed] over the supply.
Table readings(const Readout& readout, const TerminalNetwork& network) {
  const double supply_ohm = readout.supply_ohm.value_or(0.0);
  const ArrayXd load = as_array(readout.load_ohm);
  const ArrayXd switches = array_or_zero(readout.column_switch_ohm, load.size());
  ArrayXd drive = as_array(readout.drive_ohm);
  if (readout.circuit == Circuit::flexitac) return one_load_grounded(network, drive, load, switches, supply_ohm);
  const bool rows_float = readout.idle_rows == IdleRows::floating;
  if (rows_float) drive += supply_ohm;  // one driver at a time, nothing returns through the others
  if (readout.idle_columns == IdleColumns::floating) {
    return rows_float ? one_load_floating(network, drive, load, switches)
                      : one_load_grounded(network, drive, load, switches, supply_ohm);
  }
  const Sinks sinks = sinks_of(readout);
  return rows_float ? idle_driven_floating(network, drive, sinks)
                    : idle_driven_grounded(network, drive, sinks, supply_ohm);
}

TerminalNetwork network_of(const Table& taxels, const std::vector<double>& driven_segment_ohm,
                           const std::vector<double>& sensed_segment_ohm, const FilmTables& film) {
  const bool is_lumped = driven_segment_ohm.empty() && sensed_segment_ohm.empty();
  return is_lumped ? lumped_network(taxels, film)
                   : resistive_network(taxels, driven_segment_ohm, sensed_segment_ohm, film);
}

/// Readings [driven, sensed] over the supply of taxels under these forces.
Table readings(const Readout& readout, const Table& taxels, const Table& newtons,
               const std::vector<double>& driven_segment_ohm, const std::vector<double>& sensed_segment_ohm) {
  const FilmTables film = readout.film ? film_tables(*readout.film, newtons) : FilmTables{};
  return readings(readout, network_of(taxels, driven_segment_ohm, sensed_segment_ohm, film));
}

}  // namespace

Result<ReadoutCircuit> ReadoutCircuit::create(const ArrayDescription& array) {
  if (Status valid = array.validate(); !valid) return valid.error();
  if (array.has_unknown_circuit()) {
    return bad_input("readout: the circuit or some of its resistances are to be fitted; a simulation needs numbers");
  }
  return ReadoutCircuit(array);
}

ReadoutCircuit::ReadoutCircuit(const ArrayDescription& array)
    : readout_(array.readout),
      rows_(array.rows),
      cols_(array.cols),
      unloaded_n_(array.readout.film ? array.taxel_count() : 0),
      is_grounded_divider_(fits_grounded_divider(array)) {}

void ReadoutCircuit::ratios(std::span<const double> siemens, std::span<double> ratio) const {
  ratios(siemens, unloaded_n_, ratio);
}

void ReadoutCircuit::ratios(std::span<const double> siemens, std::span<const double> newtons,
                            std::span<double> ratio) const {
  assert(siemens.size() == rows_ * cols_ && ratio.size() == rows_ * cols_);
  assert(!readout_.film || newtons.size() == rows_ * cols_);
  const auto taxels = as_table(siemens, rows_, cols_);
  const auto forces = as_table(newtons, readout_.film ? rows_ : 0, readout_.film ? cols_ : 0);
  auto reading = as_table(ratio, rows_, cols_);
  if (is_grounded_divider_) {
    grounded_divider_ratios(readout_, siemens, ratio);
  } else if (readout_.circuit == Circuit::none) {
    reading = kUnknownCircuitOhm * taxels;
  } else if (readout_.circuit == Circuit::flexitac) {
    reading = readings(readout_, taxels.transpose(), forces.transpose(), readout_.column_segment_ohm,
                       readout_.row_segment_ohm)
                  .transpose();
  } else {
    reading = readings(readout_, taxels, forces, readout_.row_segment_ohm, readout_.column_segment_ohm);
  }
  if (!readout_.pressure_raises_reading) reading = 1.0 - reading.array();
}

void ReadoutCircuit::ratios(std::span<const float> siemens, std::span<float> ratio) const {
  assert(siemens.size() == rows_ * cols_ && ratio.size() == rows_ * cols_);
  if (!is_grounded_divider_) {
    const std::vector<double> exact(siemens.begin(), siemens.end());
    std::vector<double> reading(ratio.size());
    ratios(exact, reading);
    std::transform(reading.begin(), reading.end(), ratio.begin(),
                   [](double value) { return static_cast<float>(value); });
    return;
  }
  grounded_divider_ratios(readout_, siemens, ratio);
  if (readout_.pressure_raises_reading) return;
  for (float& reading : ratio) reading = 1.0F - reading;
}

}  // namespace dermis::learn::simulation
