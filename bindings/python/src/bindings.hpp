// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::touch::pipeline {
struct Model;
}  // namespace dermis::touch::pipeline

/// Shared by the sources of the Python module. bindings/python/dermis/__init__.pyi is the reference of what they bind.
namespace dermis::python {

namespace py = pybind11;

/// One source file each.
void bind_array(py::module_& module);
void bind_frames(py::module_& module);
void bind_pipeline(py::module_& module);
void bind_contacts(py::module_& module);
void bind_circuit(py::module_& module);
void bind_calibration(py::module_& module);
void bind_sources(py::module_& module);
void bind_serve(py::module_& module);
void bind_picture(py::module_& module);
void bind_threats(py::module_& module);
void bind_recognition(py::module_& module);
void bind_datasets(py::module_& module);

/// Throws dermis.BadInput or dermis.Failed with the line of the error.
[[noreturn]] void raise(const Error& error);

template <typename T>
T value_or_raise(Result<T>&& result) {
  if (!result) raise(result.error());
  return *std::move(result);
}

inline void raise_where_failed(const Status& status) {
  if (!status) raise(status.error());
}

/// A view of numbers that live as long as `owner`.
template <typename T>
py::array_t<T> view(const py::object& owner, std::vector<T>& values, std::vector<py::ssize_t> shape) {
  return py::array_t<T>(std::move(shape), values.data(), owner);
}

/// py::pickle() of a class. `restore` takes what anybody may have written: where it throws, or misses a part, the
/// pickle is refused by dermis.BadInput.
template <typename Save, typename Restore>
auto checked_pickle(Save save, Restore restore) {
  return py::pickle(save, [restore](const py::tuple& state) {
    try {
      return restore(state);
    } catch (const py::builtin_exception&) {
    } catch (const py::error_already_set&) {
    }
    raise(bad_input("the pickled object is damaged, or of another version of dermis"));
  });
}

/// For `restore`.
inline void require_whole(bool is_whole) {
  if (!is_whole) throw py::value_error();
}

/// "(8, 16)"
std::string shape_text(const py::array& array);

/// `array` as numbers in C order, converted where they are not. Raises where its dtype is none of numbers, or its shape
/// is not `shape`, in which -1 stands for any length. `name`: of the argument.
template <typename T>
py::array_t<T> numbers(const py::object& object, const char* name, const std::vector<py::ssize_t>& shape);

/// A path: str or os.PathLike.
std::string path_of(const py::object& object);
bool is_path(const py::object& object);
/// The path of a file to write. Raises where one exists, unless it `is_forced`.
std::string new_path(const py::object& object, bool is_forced);

/// An ArrayDescription, or the path of its array.toml.
ArrayDescription array_of(const py::object& object);

/// A Model, or the path of its file.
std::shared_ptr<touch::pipeline::Model> model_of(const py::object& object);

}  // namespace dermis::python
