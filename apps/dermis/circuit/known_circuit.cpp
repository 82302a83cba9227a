// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "circuit/known_circuit.hpp"

#include "dermis/files/array_toml.hpp"

namespace dermis::app {

Result<ArrayDescription> read_known_circuit(const std::string& path) {
  Result<ArrayDescription> array = files::read_array(path);
  if (!array) return array;
  if (array->readout.circuit == Circuit::none) {
    return bad_input(path + ": circuit = \"none\" has nothing to compute; name the circuit and its resistances");
  }
  if (array->has_unknown_circuit()) {
    return bad_input(path + ": a circuit that is to be fitted cannot be computed; give its resistances in ohm");
  }
  return array;
}

Result<double> adc_noise_ratio(const ArrayDescription& array) {
  const Readout& readout = array.readout;
  if (readout.adc_reference_v && !readout.supply_v) {
    return bad_input("readout.supply_v: is missing; the noise of an ADC with a reference in volts depends on it");
  }
  const double full_scale = readout.adc_reference_v ? *readout.adc_reference_v / *readout.supply_v : 1.0;
  return readout.adc_noise_counts * full_scale / readout.full_scale_counts();
}

Error in_file(const std::string& path, const Error& error) {
  return {error.kind, path + ": " + error.message};
}

}  // namespace dermis::app
