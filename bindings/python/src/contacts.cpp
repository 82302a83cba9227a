// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/contacts.hpp"

#include <memory>
#include <utility>

#include "bindings.hpp"
#include "dermis/touch/contacts/contact_tracker.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "frames.hpp"

namespace dermis::python {
namespace {

const char* phase_of(const Contact& contact) {
  switch (contact.phase) {
    case ContactPhase::onset: return "onset";
    case ContactPhase::held: return "held";
    case ContactPhase::release: return "release";
  }
  return "";
}

ContactPhase phase_from(const std::string& name) {
  if (name == "onset") return ContactPhase::onset;
  return name == "held" ? ContactPhase::held : ContactPhase::release;
}

std::pair<double, double> pair_of(const PlaneVector& vector) {
  return {vector.x, vector.y};
}

PlaneVector vector_of(const py::handle& pair) {
  const auto [x, y] = pair.cast<std::pair<double, double>>();
  return {x, y};
}

/// A tracker that refuses the forces of another array.
class Tracker {
 public:
  Tracker(const ArrayDescription& array, const touch::contacts::ContactOptions& options,
          std::optional<touch::contacts::StripTable> strip)
      : shape_{array.rows, array.cols}, tracker_(array, options, std::move(strip)) {}

  std::vector<Contact> process(const ShapedForce& force) {
    if (force.shape != shape_) throw py::value_error("force: has another shape than the array of the tracker");
    tracker_.process(force.frame, report_);
    return report_.contacts;
  }

  void forget() { tracker_.forget(); }

 private:
  FrameShape shape_;
  touch::contacts::ContactTracker tracker_;
  ContactReport report_;
};

std::unique_ptr<Tracker> make_tracker(const py::object& of, const touch::contacts::ContactOptions& options) {
  raise_where_failed(options.validate());
  if (py::isinstance<touch::pipeline::Model>(of)) {
    const auto& model = of.cast<const touch::pipeline::Model&>();
    return std::make_unique<Tracker>(model.array, options, model.strip);
  }
  return std::make_unique<Tracker>(array_of(of), options, std::nullopt);
}

py::tuple state_of(const Contact& c) {
  return py::make_tuple(c.id, phase_of(c), c.onset.count(), pair_of(c.position), pair_of(c.sigma_position_m),
                        pair_of(c.velocity), c.force_n, c.sigma_force_n, c.area_m2, c.peak_pressure_pa,
                        c.mean_pressure_pa, c.major_axis_m, c.minor_axis_m, c.angle_rad, c.taxels);
}

Contact contact_from(const py::tuple& state) {
  Contact c;
  c.id = state[0].cast<std::uint32_t>();
  c.phase = phase_from(state[1].cast<std::string>());
  c.onset = Nanos(state[2].cast<std::int64_t>());
  c.position = vector_of(state[3]);
  c.sigma_position_m = vector_of(state[4]);
  c.velocity = vector_of(state[5]);
  double* const numbers[] = {&c.force_n,          &c.sigma_force_n, &c.area_m2,      &c.peak_pressure_pa,
                             &c.mean_pressure_pa, &c.major_axis_m,  &c.minor_axis_m, &c.angle_rad};
  for (std::size_t k = 0; k < std::size(numbers); ++k) *numbers[k] = state[6 + k].cast<double>();
  c.taxels = state[14].cast<std::uint32_t>();
  return c;
}

}  // namespace

void bind_contacts(py::module_& module) {
  const touch::contacts::ContactOptions defaults;
  py::class_<Contact>(module, "Contact")
      .def_readonly("id", &Contact::id)
      .def_property_readonly("phase", &phase_of)
      .def_property_readonly("onset_ns", [](const Contact& contact) { return contact.onset.count(); })
      .def_property_readonly("position_m", [](const Contact& contact) { return pair_of(contact.position); })
      .def_property_readonly("sigma_position_m",
                             [](const Contact& contact) { return pair_of(contact.sigma_position_m); })
      .def_property_readonly("velocity_m_s", [](const Contact& contact) { return pair_of(contact.velocity); })
      .def_readonly("force_n", &Contact::force_n)
      .def_readonly("sigma_force_n", &Contact::sigma_force_n)
      .def_readonly("area_m2", &Contact::area_m2)
      .def_readonly("peak_pressure_pa", &Contact::peak_pressure_pa)
      .def_readonly("mean_pressure_pa", &Contact::mean_pressure_pa)
      .def_readonly("major_axis_m", &Contact::major_axis_m)
      .def_readonly("minor_axis_m", &Contact::minor_axis_m)
      .def_readonly("angle_rad", &Contact::angle_rad)
      .def_readonly("taxels", &Contact::taxels)
      .def("__repr__",
           [](const Contact& contact) {
             return "<dermis.Contact " + std::to_string(contact.id) + " " + phase_of(contact) + " " +
                    std::to_string(contact.force_n) + " N>";
           })
      .def(
          "__eq__", [](const Contact& a, const Contact& b) { return a == b; }, py::is_operator())
      .def(checked_pickle(&state_of, &contact_from));

  py::class_<Tracker>(module, "ContactTracker")
      .def(py::init([](const py::object& of, double onset_sigma, double onset_force_n, double release_share,
                       std::size_t most_contacts) {
             return make_tracker(of, {onset_sigma, onset_force_n, release_share, most_contacts});
           }),
           py::arg("model"), py::kw_only(), py::arg("onset_sigma") = defaults.onset_sigma,
           py::arg("onset_force_n") = defaults.onset_force_n, py::arg("release_share") = defaults.release_share,
           py::arg("most_contacts") = defaults.most_contacts)
      .def("process", &Tracker::process, py::arg("force"))
      .def("forget", &Tracker::forget);
}

}  // namespace dermis::python
