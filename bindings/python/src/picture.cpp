// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bindings.hpp"
#include "dermis/out/report/frame_picture.hpp"

namespace dermis::python {
namespace {

/// A PNG of one value a taxel, in a scale that ends at 1, 2, 5, 10, ...; None where nothing can paint it.
std::optional<py::bytes> picture(const py::object& values, const std::string& title, const std::string& subtitle,
                                 const std::string& unit) {
  const py::array_t<double> taxels = numbers<double>(values, "values", {-1, -1});
  out::report::FramePicture frame;
  frame.title = title;
  frame.subtitle = subtitle;
  frame.rows = static_cast<std::size_t>(taxels.shape(0));
  frame.cols = static_cast<std::size_t>(taxels.shape(1));
  frame.values.assign(taxels.data(), taxels.data() + taxels.size());
  frame.high = out::report::force_scale(out::report::largest_of(frame.values));
  frame.unit = unit;
  const Result<std::string> png = out::report::frame_png(frame);
  return png ? std::optional<py::bytes>(*png) : std::nullopt;
}

}  // namespace

void bind_picture(py::module_& module) {
  module.def("picture", &picture, py::arg("values"), py::arg("title"), py::arg("subtitle"), py::arg("unit"));
}

}  // namespace dermis::python
