// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <array>
#include <filesystem>
#include <limits>
#include <system_error>
#include <type_traits>

#include "bindings.hpp"
#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/touch/frames/version.hpp"

namespace dermis::python {
namespace {

/// "(frames, 12, 10)": a length that may be any is named by its place.
std::string expected(const std::vector<py::ssize_t>& shape) {
  static constexpr std::array kLengths = {"frames", "rows", "cols"};
  std::string text = "(";
  for (std::size_t k = 0; k < shape.size(); ++k) {
    text += (k == 0 ? "" : ", ") + (shape[k] < 0 ? kLengths.at(k) : std::to_string(shape[k]));
  }
  return text + (shape.size() == 1 ? ",)" : ")");
}

/// The entries that a numpy.ma array masks are NaN: there is no reading.
py::object with_nan_for_masked(const py::object& object, const char* name, bool can_be_nan) {
  if (!py::isinstance(object, py::module_::import("numpy.ma").attr("MaskedArray"))) return object;
  if (!can_be_nan) throw py::type_error(std::string(name) + ": may not be masked; fill() it");
  return object.attr("astype")("float64").attr("filled")(std::numeric_limits<double>::quiet_NaN());
}

/// pybind11 asks for memory where an object has none, and takes what is there for its value.
void* refuse_unmade(std::size_t /*bytes*/) {
  throw py::type_error("this object is not made yet: its __init__() was not called");
}

/// Objects of __new__() alone are refused wherever one is used.
void refuse_unmade_objects(const py::module_& module) {
  for (const auto& [name, object] : module.attr("__dict__").cast<py::dict>()) {
    if (!PyType_Check(object.ptr())) continue;
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): as Python means it
    py::detail::type_info* const type = py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(object.ptr()));
    if (type != nullptr) type->operator_new = &refuse_unmade;
  }
}

bool fits(const py::array& array, const std::vector<py::ssize_t>& shape) {
  if (array.ndim() != static_cast<py::ssize_t>(shape.size())) return false;
  for (std::size_t k = 0; k < shape.size(); ++k) {
    if (shape[k] >= 0 && array.shape(static_cast<py::ssize_t>(k)) != shape[k]) return false;
  }
  return true;
}

}  // namespace

void raise(const Error& error) {
  const py::module_ package = py::module_::import("dermis");
  const char* const name = error.kind == ErrorKind::bad_input ? "BadInput" : "Failed";
  PyErr_SetString(package.attr(name).ptr(), error.message.c_str());
  throw py::error_already_set();
}

std::string shape_text(const py::array& array) {
  return expected(std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim()));
}

template <typename T>
py::array_t<T> numbers(const py::object& object, const char* name, const std::vector<py::ssize_t>& shape) {
  const py::array array = py::array::ensure(with_nan_for_masked(object, name, std::is_floating_point_v<T>));
  if (!array) {
    PyErr_Clear();
    throw py::type_error(std::string(name) + ": is no array of numbers");
  }
  const char kind = array.dtype().kind();
  const bool is_wanted = std::is_same_v<T, bool> ? kind == 'b' : kind == 'u' || kind == 'i' || kind == 'f';
  if (!is_wanted) {
    const auto type = py::str(array.dtype()).cast<std::string>();
    const char* const wanted = std::is_same_v<T, bool> ? "bool" : "integers or floating point numbers";
    throw py::type_error(std::string(name) + ": has the dtype " + type + ", not " + wanted);
  }
  if (!fits(array, shape)) {
    throw py::value_error(std::string(name) + ": has the shape " + shape_text(array) + ", expected is " +
                          expected(shape));
  }
  return py::array_t<T, py::array::c_style | py::array::forcecast>(array);
}

template py::array_t<float> numbers(const py::object&, const char*, const std::vector<py::ssize_t>&);
template py::array_t<double> numbers(const py::object&, const char*, const std::vector<py::ssize_t>&);
template py::array_t<bool> numbers(const py::object&, const char*, const std::vector<py::ssize_t>&);
template py::array_t<std::int64_t> numbers(const py::object&, const char*, const std::vector<py::ssize_t>&);

bool is_path(const py::object& object) {
  return py::isinstance<py::str>(object) || py::hasattr(object, "__fspath__");
}

std::string path_of(const py::object& object) {
  if (!is_path(object)) throw py::type_error("a path is a str or an os.PathLike");
  return py::str(py::hasattr(object, "__fspath__") ? object.attr("__fspath__")() : object).cast<std::string>();
}

std::string new_path(const py::object& object, bool is_forced) {
  std::string path = path_of(object);
  std::error_code error;
  if (!is_forced && std::filesystem::is_regular_file(path, error)) {
    raise(bad_input("'" + path + "' exists; name another, or replace it with force=True"));
  }
  return path;
}

ArrayDescription array_of(const py::object& object) {
  if (is_path(object)) return value_or_raise(bytes::files::read_array(path_of(object)));
  if (!py::isinstance<ArrayDescription>(object)) {
    throw py::type_error("array: is an ArrayDescription or the path of an array.toml");
  }
  return object.cast<ArrayDescription>();
}

PYBIND11_MODULE(_dermis, module) {
  // pybind11 looks numpy up for the first array: two threads would wait there for each other, for ever.
  py::dtype::of<float>();
  module.attr("__version__") = DERMIS_VERSION;
  bind_array(module);
  bind_frames(module);
  bind_pipeline(module);
  bind_contacts(module);
  bind_circuit(module);
  bind_calibration(module);
  bind_sources(module);
  bind_serve(module);
  bind_picture(module);
  bind_threats(module);
  bind_recognition(module);
  bind_datasets(module);
  refuse_unmade_objects(module);
}

}  // namespace dermis::python
