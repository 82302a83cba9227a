// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <chrono>
#include <exception>
#include <limits>
#include <memory>
#include <utility>

#include "bindings.hpp"
#include "dermis/bytes/files/loads_csv.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "frames.hpp"

namespace dermis::python {
namespace {

/// `where`: (row, col), or (first_row, first_col, last_row, last_col), both ends inclusive.
TaxelRegion region_of(const py::tuple& where) {
  const auto at = [&where](std::size_t k) { return where[k].cast<std::size_t>(); };
  if (where.size() == 2) return {at(0), at(1), at(0), at(1)};
  if (where.size() == 4) return {at(0), at(1), at(2), at(3)};
  throw py::value_error("where: is (row, col) or (first_row, first_col, last_row, last_col)");
}

Load make_load(std::size_t frame, const py::tuple& where, std::optional<double> newtons,
               std::optional<double> pascals) {
  if (newtons.has_value() == pascals.has_value()) throw py::value_error("give the load as newtons or as pascals");
  const double value = newtons ? *newtons : *pascals;
  if (!(value >= 0.0 && value <= std::numeric_limits<double>::max())) {
    throw py::value_error("a load is a finite number of at least 0");
  }
  return {frame, newtons ? LoadKind::force : LoadKind::pressure, region_of(where), value};
}

void check_load(const Load& load, const ArrayDescription& array, std::size_t frames) {
  const TaxelRegion& where = load.where;
  const bool ordered = where.first_row <= where.last_row && where.first_col <= where.last_col;
  if (!ordered || where.last_row >= array.rows || where.last_col >= array.cols) {
    throw py::value_error("the load of frame " + std::to_string(load.frame) + ": the array has no such taxels");
  }
  if (load.frame >= frames) {
    throw py::value_error("a load names frame " + std::to_string(load.frame) + ", the recording has " +
                          std::to_string(frames) + " frames, counted from 0");
  }
  if (load.kind == LoadKind::pressure && !array.taxel_area_m2) {
    throw py::value_error("a load in pascals needs the array's taxel_area_mm2");
  }
}

std::vector<Load> loads_of(const py::object& loads, const ArrayDescription& array, std::size_t frames) {
  if (is_path(loads)) return value_or_raise(bytes::files::read_loads(path_of(loads), array, frames));
  std::vector<Load> list;
  for (const py::handle load : loads) list.push_back(load.cast<Load>());
  for (const Load& load : list) check_load(load, array, frames);
  return list;
}

py::tuple calibrate(const py::object& array, const py::object& frames, const py::object& loads, double settle_s,
                    const py::object& progress) {
  const ArrayDescription description = array_of(array);
  const Recording recording = recording_of(frames);
  const std::vector<Load> labels = loads_of(loads, description, recording.size());
  if (!(settle_s >= 0.0 && settle_s <= 1e9)) throw py::value_error("settle_s: must be 0 to 1e9");
  const auto settle = std::chrono::duration_cast<Nanos>(std::chrono::duration<double>(settle_s));
  std::exception_ptr thrown;  // by `progress`; the calibration itself knows no exceptions
  learn::calibration::Progress report;
  if (!progress.is_none()) {
    report = [&](const std::string& stage, double share) {
      const py::gil_scoped_acquire acquire;
      if (thrown) return;
      try {
        progress(stage, share);
      } catch (py::error_already_set&) {
        thrown = std::current_exception();
      }
    };
  }
  const std::vector<RawFrame> raw = recording.frames();
  Result<learn::calibration::Calibration> made = [&] {
    const py::gil_scoped_release release;
    return learn::calibration::calibrate(description, raw, labels, settle, report);
  }();
  if (thrown) std::rethrow_exception(thrown);
  learn::calibration::Calibration calibration = value_or_raise(std::move(made));
  return py::make_tuple(std::make_shared<touch::pipeline::Model>(std::move(calibration.model)),
                        std::move(calibration.report));
}

std::string evaluate(const touch::pipeline::Model& model, const py::object& frames, const py::object& loads) {
  const Recording recording = recording_of(frames);
  const std::vector<Load> labels = loads_of(loads, model.array, recording.size());
  const std::vector<RawFrame> raw = recording.frames();
  Result<learn::calibration::Evaluation> evaluation = [&] {
    const py::gil_scoped_release release;
    return learn::calibration::evaluate(model, raw, labels);
  }();
  return to_json(value_or_raise(std::move(evaluation)));
}

}  // namespace

void bind_calibration(py::module_& module) {
  using learn::calibration::CalibrationReport;
  py::class_<Load>(module, "Load")
      .def(py::init(&make_load), py::arg("frame"), py::arg("where"), py::kw_only(), py::arg("newtons") = py::none(),
           py::arg("pascals") = py::none())
      .def_readonly("frame", &Load::frame)
      .def_property_readonly("newtons",
                             [](const Load& load) -> std::optional<double> {
                               if (load.kind == LoadKind::force) return load.value;
                               return std::nullopt;
                             })
      .def_property_readonly("pascals",
                             [](const Load& load) -> std::optional<double> {
                               if (load.kind == LoadKind::pressure) return load.value;
                               return std::nullopt;
                             })
      .def_property_readonly("where", [](const Load& load) {
        return py::make_tuple(load.where.first_row, load.where.first_col, load.where.last_row, load.where.last_col);
      });

  py::class_<CalibrationReport>(module, "CalibrationReport")
      .def_readonly("frames", &CalibrationReport::frames)
      .def_readonly("frames_rejected", &CalibrationReport::frames_rejected)
      .def_readonly("first_rejection", &CalibrationReport::first_rejection)
      .def_readonly("remarks", &CalibrationReport::remarks)
      .def_readonly("circuit", &CalibrationReport::circuit)
      .def_property_readonly("choice", [](const CalibrationReport& report) { return report.training.choice; })
      .def_property_readonly("median_fit_error",
                             [](const CalibrationReport& report) { return report.training.median_fit_error; })
      .def_property_readonly("lightest_newtons",
                             [](const CalibrationReport& report) { return report.training.lightest_newtons; })
      .def_property_readonly("heaviest_newtons",
                             [](const CalibrationReport& report) { return report.training.heaviest_newtons; });

  module.def(
      "read_loads",
      [](const py::object& path, const py::object& array, std::size_t frames) {
        return value_or_raise(bytes::files::read_loads(path_of(path), array_of(array), frames));
      },
      py::arg("path"), py::arg("array"), py::arg("frames"));
  module.def("calibrate", &calibrate, py::arg("array"), py::arg("frames"), py::arg("loads"), py::kw_only(),
             py::arg("settle_s") = 0.0, py::arg("progress") = py::none());
  module.def("evaluate_json", &evaluate, py::arg("model"), py::arg("frames"), py::arg("loads"));
}

}  // namespace dermis::python
