// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::support {

/// Every readout circuit, for tests that go through all of them.
struct NamedCircuit {
  std::string name;
  Circuit circuit = Circuit::divider;
  IdleRows idle_rows = IdleRows::grounded;
  IdleColumns idle_columns = IdleColumns::loaded;
  bool real_amplifiers = false;
  bool resistive_lines = false;
  bool film = false;
};

inline std::ostream& operator<<(std::ostream& out, const NamedCircuit& circuit) {
  return out << circuit.name;
}

inline std::vector<NamedCircuit> all_circuits() {
  using enum Circuit;
  const IdleRows float_rows = IdleRows::floating;
  const IdleColumns float_columns = IdleColumns::floating;
  std::vector<NamedCircuit> circuits = {
      {"divider", divider},
      {"divider_floating_rows", divider, float_rows},
      {"divider_one_load", divider, IdleRows::grounded, float_columns},
      {"divider_two_terminal", divider, float_rows, float_columns},
      {"transimpedance", transimpedance},
      {"transimpedance_floating_rows", transimpedance, float_rows},
      {"real_amplifiers", transimpedance, IdleRows::grounded, IdleColumns::loaded, true},
      {"real_amplifiers_floating_rows", transimpedance, float_rows, IdleColumns::loaded, true},
      {"flexitac", flexitac},
  };
  const std::size_t lumped = circuits.size();
  for (std::size_t k = 0; k < lumped; ++k) {
    circuits.push_back(circuits[k]);
    circuits.back().name += "_resistive_lines";
    circuits.back().resistive_lines = true;
  }
  return circuits;
}

/// Every circuit without resistance of its lines, and two with it, under a film.
inline std::vector<NamedCircuit> circuits_with_film() {
  std::vector<NamedCircuit> circuits;
  for (const NamedCircuit& circuit : all_circuits()) {
    const bool is_plain = circuit.circuit == Circuit::divider && circuit.idle_columns == IdleColumns::loaded;
    if (circuit.resistive_lines && !is_plain) continue;
    circuits.push_back(circuit);
    circuits.back().name += "_film";
    circuits.back().film = true;
  }
  return circuits;
}

/// An array of this circuit whose resistances differ from line to line: drivers of 1 to 200 ohm, loads of 100 ohm to
/// 10 kohm, lines of up to 20 ohm from taxel to taxel, amplifiers with an offset of a few millivolt and a gain of 1e4,
/// a film of 2 to 50 kohm between neighbouring taxels under any load.
inline ArrayDescription random_array(const NamedCircuit& circuit, std::size_t rows, std::size_t cols, Random& random) {
  ArrayDescription array;
  array.rows = rows;
  array.cols = cols;
  Readout& readout = array.readout;
  readout.circuit = circuit.circuit;
  readout.idle_rows = circuit.idle_rows;
  readout.idle_columns = circuit.idle_columns;
  readout.adc_bits = 24;
  for (std::size_t k = 0; k < array.driven_lines(); ++k) readout.drive_ohm.push_back(random.log_uniform(1.0, 200.0));
  for (std::size_t k = 0; k < array.sensed_lines(); ++k) readout.load_ohm.push_back(random.log_uniform(100.0, 1e4));
  if (circuit.real_amplifiers) {
    readout.supply_v = 5.0;
    readout.amplifier_gain = 1e4;
    for (std::size_t j = 0; j < cols; ++j) {
      readout.column_switch_ohm.push_back(random.uniform(0.0, 100.0));
      readout.amplifier_offset_v.push_back(random.uniform(-3e-3, 3e-3));
    }
  }
  if (circuit.resistive_lines) {
    for (std::size_t i = 0; i < rows; ++i) readout.row_segment_ohm.push_back(random.uniform(0.0, 20.0));
    for (std::size_t j = 0; j < cols; ++j) readout.column_segment_ohm.push_back(random.uniform(0.0, 20.0));
  }
  if (circuit.film) {
    const double ohm = random.log_uniform(2e3, 5e4);
    readout.film = Film{ohm, ohm};
  }
  return array;
}

/// Taxels of low_ohm to high_ohm, log-uniform.
inline std::vector<double> random_siemens(const ArrayDescription& array, Random& random, double low_ohm = 200.0,
                                          double high_ohm = 1e7) {
  std::vector<double> siemens(array.taxel_count());
  for (double& value : siemens) value = 1.0 / random.log_uniform(low_ohm, high_ohm);
  return siemens;
}

}  // namespace dermis::support
