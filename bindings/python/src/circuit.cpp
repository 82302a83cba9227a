// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <memory>
#include <utility>

#include "bindings.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"

namespace dermis::python {
namespace {

std::vector<py::ssize_t> extents(const ArrayDescription& array) {
  return {static_cast<py::ssize_t>(array.rows), static_cast<py::ssize_t>(array.cols)};
}

py::array_t<double> forward(const py::object& array, const py::object& siemens) {
  const ArrayDescription description = array_of(array);
  const py::array_t<double> conductances = numbers<double>(siemens, "siemens", extents(description));
  for (py::ssize_t k = 0; k < conductances.size(); ++k) {
    const double value = conductances.data()[k];
    if (!(value >= 0.0 && value <= std::numeric_limits<double>::max())) {
      throw py::value_error("siemens: conductances are finite numbers of at least 0");
    }
  }
  const auto circuit = value_or_raise(learn::simulation::ReadoutCircuit::create(description));
  py::array_t<double> ratio(extents(description));
  circuit.ratios(std::span(conductances.data(), description.taxel_count()),
                 std::span(ratio.mutable_data(), description.taxel_count()));
  return ratio;
}

py::tuple invert(const py::object& array, const py::object& ratio) {
  const ArrayDescription description = array_of(array);
  const py::array_t<double> readings = numbers<double>(ratio, "ratio", extents(description));
  const auto inversion = value_or_raise(touch::compensation::make_crosstalk_inversion(description));
  py::array_t<double> siemens(extents(description));
  const touch::compensation::InversionResult result =
      inversion->invert(std::span(readings.data(), description.taxel_count()),
                        std::span(siemens.mutable_data(), description.taxel_count()));
  return py::make_tuple(siemens, result.solved, result.residual_ratio);
}

}  // namespace

void bind_circuit(py::module_& module) {
  module.def("circuit_forward", &forward, py::arg("array"), py::arg("siemens"));
  module.def("circuit_invert", &invert, py::arg("array"), py::arg("ratio"));
}

}  // namespace dermis::python
