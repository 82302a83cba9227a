// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/lumped_circuit.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "dermis/touch/frames/processor_clones.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kIdealSiemens = 1e5;       // a driver of 0 ohm: far above every taxel, driver and load
constexpr double kShortSiemens = 1e7;       // stiffer than the drivers that work against it
constexpr double kVirtualGroundGain = 1e6;  // conductance of a column at virtual ground over that of its resistor
constexpr double kLeakSiemens = 1e-15;      // holds a line that is connected to nothing at 0 V

}  // namespace

LumpedCircuit::LumpedCircuit(const ArrayDescription& array)
    : array_(array),
      driven_(driven_axis(array)),
      nodes_(array.rows + array.cols),
      film_siemens_(nodes_),
      right_columns_(array.driven_lines() + (one_loaded() ? array.sensed_lines() : 0)),
      matrix_(nodes_ * nodes_),
      assembled_(nodes_ * nodes_),
      right_(nodes_ * right_columns_) {
  assert(!array.has_unknown_circuit() && array.readout.circuit != Circuit::none);
  crossings_.reserve(array.taxel_count());
  restore();
  if (!array.readout.film) return;
  FilmConductances film(array.rows, array.cols);
  film.set(*array.readout.film, std::vector<double>(array.taxel_count()));
  set_film(film);
}

void LumpedCircuit::set_film(const FilmConductances& film) noexcept {
  std::copy(film.between_rows.begin(), film.between_rows.end(), film_siemens_.begin());
  std::copy(film.between_cols.begin(), film.between_cols.end(),
            film_siemens_.begin() + static_cast<std::ptrdiff_t>(array_.rows));
}

void LumpedCircuit::restore() {
  drive_siemens_.resize(array_.driven_lines());
  for (std::size_t line = 0; line < drive_siemens_.size(); ++line) set_drive_ohm(line, array_.readout.drive_ohm[line]);
  load_siemens_.resize(array_.sensed_lines());
  for (std::size_t line = 0; line < load_siemens_.size(); ++line) {
    load_siemens_[line] = ground_gain() / array_.readout.load_ohm[line];
  }
  supply_siemens_.assign(nodes_, 0.0);
  joint_siemens_.assign(nodes_, 0.0);
  crossings_.clear();
  ground_siemens_.assign(nodes_, 0.0);
  is_open_.assign(nodes_, false);
}

void LumpedCircuit::open_line(Axis axis, std::size_t line) {
  is_open_[node_of(axis, line)] = true;
  (axis == driven_ ? drive_siemens_ : load_siemens_)[line] = 0.0;
}

void LumpedCircuit::ground_line(Axis axis, std::size_t line) {
  open_line(axis, line);
  ground_siemens_[node_of(axis, line)] = kShortSiemens;
}

void LumpedCircuit::join_lines(Axis axis, std::size_t line) {
  joint_siemens_[node_of(axis, line)] = axis == Axis::row ? kShortSiemens : kShortSiemens * ground_gain();
}

void LumpedCircuit::join_crossing(std::size_t taxel) {
  crossings_.push_back(taxel);
}

void LumpedCircuit::tie_column_to_supply(std::size_t col) {
  supply_siemens_[node_of(Axis::column, col)] = kShortSiemens * ground_gain();
}

void LumpedCircuit::set_drive_ohm(std::size_t driven_line, double ohm) {
  drive_siemens_[driven_line] = 1.0 / std::max(ohm, 1.0 / kIdealSiemens);
}

double LumpedCircuit::ground_gain() const noexcept {
  return array_.readout.circuit == Circuit::transimpedance ? kVirtualGroundGain : 1.0;
}

bool LumpedCircuit::rows_float() const noexcept {
  return driven_ == Axis::row && array_.readout.idle_rows == IdleRows::floating;
}

bool LumpedCircuit::one_loaded() const noexcept {
  return driven_ == Axis::column ||
         (array_.readout.circuit == Circuit::divider && array_.readout.idle_columns == IdleColumns::floating);
}

// Where idle rows are tied all scans share one matrix; where they float, each scan has its own driver in it. Where one
// column at a time is loaded, the matrix is that of no load. A probe is the response of a column's own voltage to a
// current into it. It puts the column's load back: v_j / (1 + gL_j K_jj), formula (3) of
// docs/reasons/derivations-circuits.md.
void LumpedCircuit::solve(std::span<const double> siemens, std::span<double> ratio) noexcept {
  const std::size_t scans = array_.driven_lines();
  const std::size_t probes = one_loaded() ? array_.sensed_lines() : 0;
  assemble(siemens);
  if (!rows_float()) {
    matrix_ = assembled_;
    for (std::size_t line = 0; line < scans; ++line) add_drivers(line);
    factorise();
    std::fill(right_.begin(), right_.end(), 0.0);
    for (std::size_t scan = 0; scan < scans; ++scan) add_sources(scan, scan);
    add_probes(scans);
    substitute(scans + probes);
    for (std::size_t scan = 0; scan < scans; ++scan) read(scan, scan, scans, ratio);
    return;
  }
  for (std::size_t scan = 0; scan < scans; ++scan) {
    matrix_ = assembled_;
    add_drivers(scan);
    factorise();
    std::fill(right_.begin(), right_.end(), 0.0);
    add_sources(0, scan);
    add_probes(1);
    substitute(1 + probes);
    read(0, scan, 1, ratio);
  }
}

void LumpedCircuit::assemble(std::span<const double> siemens) noexcept {
  std::fill(assembled_.begin(), assembled_.end(), 0.0);
  std::swap(matrix_, assembled_);  // connect() writes into matrix_
  for (std::size_t node = 0; node < nodes_; ++node) {
    matrix_[node * nodes_ + node] += kLeakSiemens + supply_siemens_[node] + ground_siemens_[node];
    const double beside = joint_siemens_[node] + film_siemens_[node];
    if (beside > 0.0) connect(node, node + 1, beside);
  }
  for (std::size_t taxel = 0; taxel < siemens.size(); ++taxel) {
    connect(taxel / array_.cols, array_.rows + taxel % array_.cols, siemens[taxel]);
  }
  for (const std::size_t taxel : crossings_) {
    connect(taxel / array_.cols, array_.rows + taxel % array_.cols, kShortSiemens * ground_gain());
  }
  for (std::size_t line = 0; line < load_siemens_.size() && !one_loaded(); ++line) {
    const std::size_t node = sensed_node(line);
    matrix_[node * nodes_ + node] += load_siemens_[line];
  }
  std::swap(matrix_, assembled_);
}

void LumpedCircuit::connect(std::size_t a, std::size_t b, double siemens) noexcept {
  matrix_[a * nodes_ + a] += siemens;
  matrix_[b * nodes_ + b] += siemens;
  matrix_[std::max(a, b) * nodes_ + std::min(a, b)] -= siemens;
}

void LumpedCircuit::add_drivers(std::size_t driven) noexcept {
  const std::size_t node = driven_node(driven);
  matrix_[node * nodes_ + node] += drive_siemens_[driven];
}

void LumpedCircuit::add_sources(std::size_t scan, std::size_t driven) noexcept {
  for (std::size_t node = 0; node < nodes_; ++node) right_[node * right_columns_ + scan] = supply_siemens_[node];
  right_[driven_node(driven) * right_columns_ + scan] += drive_siemens_[driven];
}

void LumpedCircuit::add_probes(std::size_t first) noexcept {
  if (!one_loaded()) return;
  for (std::size_t line = 0; line < array_.sensed_lines(); ++line) {
    right_[sensed_node(line) * right_columns_ + first + line] = 1.0;
  }
}

DERMIS_PROCESSOR_CLONES void LumpedCircuit::factorise() noexcept {
  for (std::size_t i = 0; i < nodes_; ++i) {
    double* const row = &matrix_[i * nodes_];
    for (std::size_t j = 0; j <= i; ++j) {
      const double* const above = &matrix_[j * nodes_];
      double before = 0.0;
#pragma omp simd reduction(+ : before)
      for (std::size_t k = 0; k < j; ++k) before += row[k] * above[k];
      const double sum = row[j] - before;
      row[j] = i == j ? std::sqrt(std::max(sum, kLeakSiemens)) : sum / above[j];
    }
  }
}

DERMIS_PROCESSOR_CLONES void LumpedCircuit::substitute(std::size_t columns) noexcept {
  const auto subtract = [&](std::size_t to, std::size_t from, double factor) {
    if (factor == 0.0) return;
    double* const target = &right_[to * right_columns_];
    const double* const source = &right_[from * right_columns_];
#pragma omp simd
    for (std::size_t column = 0; column < columns; ++column) target[column] -= factor * source[column];
  };
  const auto divide = [&](std::size_t node) {
    const double scale = 1.0 / matrix_[node * nodes_ + node];
    for (std::size_t column = 0; column < columns; ++column) right_[node * right_columns_ + column] *= scale;
  };
  for (std::size_t i = 0; i < nodes_; ++i) {
    for (std::size_t k = 0; k < i; ++k) subtract(i, k, matrix_[i * nodes_ + k]);
    divide(i);
  }
  for (std::size_t i = nodes_; i-- > 0;) {
    divide(i);
    for (std::size_t k = 0; k < i; ++k) subtract(k, i, matrix_[i * nodes_ + k]);
  }
}

void LumpedCircuit::read(std::size_t scan, std::size_t driven, std::size_t first_probe,
                         std::span<double> ratio) const noexcept {
  for (std::size_t line = 0; line < array_.sensed_lines(); ++line) {
    const std::size_t node = sensed_node(line);
    double reading = is_open_[node] ? 0.0 : right_[node * right_columns_ + scan];
    if (one_loaded()) {
      reading /= 1.0 + load_siemens_[line] * right_[node * right_columns_ + first_probe + line];
    } else {
      reading *= load_siemens_[line] * array_.readout.load_ohm[line];  // virtual ground: current times resistor
    }
    ratio[taxel_on_line(array_, driven_, driven, line)] = reading;
  }
}

double ratio_of_shorted_lines(const ArrayDescription& array, Axis axis, std::size_t line) noexcept {
  const Readout& readout = array.readout;
  const bool driven = axis == driven_axis(array);
  const bool opposed = readout.circuit == Circuit::flexitac || readout.idle_rows == IdleRows::grounded;
  if (readout.circuit == Circuit::none || !driven || !opposed) return 1.0;
  const double first = readout.drive_ohm[line];
  const double second = readout.drive_ohm[line + 1];
  return first > 0.0 && second > 0.0 ? second / first : 1.0;
}

}  // namespace dermis::touch::compensation
