// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/compensation/circuit_model.hpp"

#include <cassert>
#include <utility>
#include <vector>

#include "touch/compensation/circuit_model/circuit_scan.hpp"
#include "touch/compensation/circuit_model/line_network.hpp"
#include "touch/compensation/circuit_model/scanned_lines.hpp"
#include "touch/compensation/readout_parts.hpp"

namespace dermis::touch::compensation {
namespace {

/// Potentials are kept for every pair of a scanned line and a node: 0.3 GB.
constexpr std::size_t kMostPotentials = std::size_t{1} << 25U;

std::size_t potential_count(const ArrayDescription& array) {
  const Readout& readout = array.readout;
  const bool resistive = has_resistive_lines(readout);
  const std::size_t lines = array.rows + array.cols;
  const bool two_terminal = readout.idle_rows == IdleRows::floating && readout.idle_columns == IdleColumns::floating;
  if (two_terminal) return array.taxel_count() * (resistive ? 2 * array.taxel_count() : lines);
  return array.taxel_count() * (resistive ? 2 * lines : lines);
}

}  // namespace

struct CircuitModel::Implementation {
  explicit Implementation(const ArrayDescription& array)
      : lines(array),
        network(lines),
        scan(make_circuit_scan(lines, network)),
        ratio(array.taxel_count()),
        supply_left(array.taxel_count(), 1.0) {}

  /// A driver's resistance takes from its reading what it takes of the supply: Y = -(d I / d rho) / I.
  void load_supply() noexcept {
    lines.for_each_reading([&](std::size_t d, std::size_t s, std::size_t reading) {
      const double current = scan->currents()(at(d), at(s));
      const double taken = current == 0.0 ? 0.0 : -scan->current_by_resistor(d, s, d) / current;
      supply_left[reading] = 1.0 / (1.0 + lines.supply_ohm() * taken);
      ratio[reading] *= supply_left[reading];
    });
  }

  /// Loss of a reading's derivative.
  [[nodiscard]] double loss(std::size_t reading) const noexcept { return supply_left[reading] * supply_left[reading]; }

  ScannedLines lines;
  LineNetwork network;
  std::unique_ptr<CircuitScan> scan;
  std::vector<double> ratio;
  std::vector<double> supply_left;
};

CircuitModel::CircuitModel(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
CircuitModel::CircuitModel(CircuitModel&&) noexcept = default;
CircuitModel& CircuitModel::operator=(CircuitModel&&) noexcept = default;
CircuitModel::~CircuitModel() = default;

Result<CircuitModel> CircuitModel::create(const ArrayDescription& array) {
  if (Status valid = array.validate(); !valid) return valid.error();
  const Readout& readout = array.readout;
  if (readout.circuit == Circuit::none || array.has_unknown_circuit()) {
    return bad_input("readout: the circuit and all its resistances must be known to compute readings");
  }
  if (potential_count(array) > kMostPotentials) {
    return bad_input("array: too large to be solved with this readout circuit: divide it into smaller arrays");
  }
  return CircuitModel(std::make_unique<Implementation>(array));
}

void CircuitModel::solve(std::span<const double> siemens) noexcept {
  auto& [lines, network, scan, ratio, supply_left] = *implementation_;
  assert(siemens.size() == lines.taxels());
  network.eliminate(lines, siemens);
  scan->solve();
  const Matrix& currents = scan->currents();
  for (std::size_t d = 0; d < lines.driven(); ++d) {
    for (std::size_t s = 0; s < lines.sensed(); ++s) {
      const SensedLine& sensed = lines.sensed_head(s);
      ratio[lines.reading(d, s)] = sensed.gain * currents(at(d), at(s)) + sensed.offset;
    }
  }
  if (lines.supply_ohm() > 0.0) implementation_->load_supply();
}

void CircuitModel::set_resistors(std::span<const double> drive_ohm, std::span<const double> load_ohm) {
  ScannedLines& lines = implementation_->lines;
  const std::vector<bool> held = lines.held();
  lines.set_resistors(drive_ohm, load_ohm);
  if (lines.held() != held) implementation_->network = LineNetwork(lines);
}

void CircuitModel::set_film(const FilmConductances& film) noexcept {
  implementation_->lines.set_film(film);
}

std::span<const double> CircuitModel::ratio() const noexcept {
  return implementation_->ratio;
}

std::span<const double> CircuitModel::supply_left() const noexcept {
  return implementation_->supply_left;
}

void CircuitModel::taxel_jacobian(std::span<double> jacobian) const noexcept {
  assert(jacobian.size() == implementation_->ratio.size() * implementation_->ratio.size());
  implementation_->scan->taxel_jacobian(jacobian);
  const std::size_t taxels = implementation_->ratio.size();
  for (std::size_t k = 0; k < jacobian.size(); ++k) jacobian[k] *= implementation_->loss(k / taxels);
}

void CircuitModel::own_derivatives(std::span<double> derivatives) const noexcept {
  assert(derivatives.size() == implementation_->ratio.size());
  implementation_->scan->own_derivatives(derivatives);
  for (std::size_t k = 0; k < derivatives.size(); ++k) derivatives[k] *= implementation_->loss(k);
}

void CircuitModel::multiply_taxel_jacobian(std::span<const double> change, std::span<double> product) noexcept {
  assert(change.size() == implementation_->ratio.size() && product.size() == implementation_->ratio.size());
  implementation_->scan->multiply_taxel_jacobian(change, product);
  for (std::size_t k = 0; k < product.size(); ++k) product[k] *= implementation_->loss(k);
}

void CircuitModel::drive_jacobian(std::span<double> jacobian) const noexcept {
  const ScannedLines& lines = implementation_->lines;
  assert(jacobian.size() == lines.taxels() * lines.driven());
  lines.for_each_reading([&](std::size_t d, std::size_t s, std::size_t reading) {
    for (std::size_t line = 0; line < lines.driven(); ++line) {
      jacobian[reading * lines.driven() + line] = implementation_->loss(reading) * lines.sensed_head(s).gain *
                                                  implementation_->scan->current_by_resistor(d, s, line);
    }
  });
}

void CircuitModel::load_jacobian(std::span<double> jacobian) const noexcept {
  const ScannedLines& lines = implementation_->lines;
  const Matrix& currents = implementation_->scan->currents();
  assert(jacobian.size() == lines.taxels() * lines.sensed());
  lines.for_each_reading([&](std::size_t d, std::size_t s, std::size_t reading) {
    const SensedLine& sensed = lines.sensed_head(s);
    for (std::size_t line = 0; line < lines.sensed(); ++line) {
      const double by_rho = implementation_->scan->current_by_resistor(d, s, lines.driven() + line);
      jacobian[reading * lines.sensed() + line] = sensed.gain * by_rho * lines.sensed_head(line).rho_by_load;
    }
    jacobian[reading * lines.sensed() + s] += sensed.gain_by_load * currents(at(d), at(s));
    for (std::size_t line = 0; line < lines.sensed(); ++line) {
      jacobian[reading * lines.sensed() + line] *= implementation_->loss(reading);
    }
  });
}

}  // namespace dermis::touch::compensation
