// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <memory>
#include <optional>
#include <string>

#include "bindings.hpp"
#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/files/safetensors.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/touch/pipeline/direct_model.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::python {
namespace {

/// Warns in Python where the file is older than the checksums.
std::shared_ptr<touch::pipeline::Model> read_model(const std::string& path) {
  auto model = std::make_shared<touch::pipeline::Model>(value_or_raise(bytes::models::read_model(path)));
  const std::optional<std::string> note = bytes::files::checksum_note(path, bytes::models::kModelFormat);
  if (note && PyErr_WarnEx(PyExc_UserWarning, note->c_str(), 1) != 0) throw py::error_already_set();
  return model;
}

}  // namespace

std::shared_ptr<touch::pipeline::Model> model_of(const py::object& object) {
  if (is_path(object)) return read_model(path_of(object));
  if (!py::isinstance<touch::pipeline::Model>(object))
    throw py::type_error("model: is a Model or the path of its file");
  static_cast<void>(object.cast<touch::pipeline::Model&>());  // says so where it is not made yet
  return object.cast<std::shared_ptr<touch::pipeline::Model>>();
}

void bind_array(py::module_& module) {
  py::class_<ArrayDescription>(module, "ArrayDescription")
      .def_static(
          "from_toml",
          [](const std::string& text) { return value_or_raise(bytes::files::array_from_toml(text, "array.toml")); },
          py::arg("text"))
      .def("to_toml", [](const ArrayDescription& array) { return bytes::files::array_to_toml(array); })
      .def_readonly("name", &ArrayDescription::name)
      .def_readonly("rows", &ArrayDescription::rows)
      .def_readonly("cols", &ArrayDescription::cols)
      .def_readonly("row_pitch_m", &ArrayDescription::row_pitch_m)
      .def_readonly("col_pitch_m", &ArrayDescription::col_pitch_m)
      .def_readonly("taxel_area_m2", &ArrayDescription::taxel_area_m2)
      .def_property_readonly("circuit", [](const ArrayDescription& array) { return to_string(array.readout.circuit); })
      .def_property_readonly("adc_bits", [](const ArrayDescription& array) { return array.readout.adc_bits; })
      .def(
          "taxel_name",
          [](const ArrayDescription& array, std::size_t row, std::size_t col) {
            if (row >= array.rows || col >= array.cols)
              throw py::index_error("the array has no taxel " + taxel_name(row, col));
            return taxel_name(row, col);
          },
          py::arg("row"), py::arg("col"))
      .def("__repr__",
           [](const ArrayDescription& array) {
             return "<dermis.ArrayDescription '" + array.name + "' " + std::to_string(array.rows) + "x" +
                    std::to_string(array.cols) + " " + to_string(array.readout.circuit) + ">";
           })
      .def(py::pickle(
          [](const ArrayDescription& array) { return bytes::files::array_to_toml(array); },
          [](const std::string& text) { return value_or_raise(bytes::files::array_from_toml(text, "array.toml")); }));

  py::class_<touch::pipeline::Model, std::shared_ptr<touch::pipeline::Model>>(module, "Model")
      .def_readonly("array", &touch::pipeline::Model::array)
      .def_readonly("provenance", &touch::pipeline::Model::provenance)
      .def(
          "write",
          [](const touch::pipeline::Model& model, const py::object& path, bool force) {
            raise_where_failed(bytes::models::write_model(new_path(path, force), model));
          },
          py::arg("path"), py::kw_only(), py::arg("force") = false)
      .def("__repr__", [](const touch::pipeline::Model& model) {
        return "<dermis.Model of '" + model.array.name + "' " + std::to_string(model.array.rows) + "x" +
               std::to_string(model.array.cols) + ">";
      });

  module.def(
      "read_array", [](const py::object& path) { return value_or_raise(bytes::files::read_array(path_of(path))); },
      py::arg("path"));
  module.def(
      "read_model", [](const py::object& path) { return read_model(path_of(path)); }, py::arg("path"));
}

}  // namespace dermis::python
