// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <memory>
#include <utility>

#include "bindings.hpp"
#include "dermis/live/threats/threat_limits.hpp"
#include "dermis/live/threats/threat_monitor.hpp"
#include "dermis/touch/contacts/contact_tracker.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "frames.hpp"

namespace dermis::python {
namespace {

using live::threats::ThreatLimit;
using live::threats::ThreatMonitor;
using live::threats::ThreatPhase;
using live::threats::ThreatState;

/// A limit and how it stands.
struct Threat {
  ThreatLimit limit;
  ThreatState state;

  [[nodiscard]] bool stands() const { return state.phase == ThreatPhase::standing; }
};

/// Limits on one array, with the contacts that they need.
class Monitor {
 public:
  Monitor(live::threats::ThreatLimits limits, const touch::pipeline::Model& model, const std::string& name)
      : limits_(std::move(limits)),
        shape_{model.array.rows, model.array.cols},
        monitor_(value_or_raise(ThreatMonitor::create(limits_, name, model.array))),
        contacts_(model.array, {}, model.strip) {}

  std::vector<Threat> process(const ShapedForce& force) {
    if (force.shape != shape_) throw py::value_error("force: has another shape than the array of the limits");
    contacts_.process(force.frame, report_);
    monitor_.process(force.frame, report_);
    return states([](const ThreatState& state) { return state.changed; });
  }

  [[nodiscard]] std::vector<Threat> standing() const {
    return states([](const ThreatState& state) { return state.phase == ThreatPhase::standing; });
  }

  void reset() { monitor_.reset(); }

 private:
  template <typename Wanted>
  [[nodiscard]] std::vector<Threat> states(Wanted is_wanted) const {
    std::vector<Threat> some;
    for (const ThreatState& state : monitor_.states()) {
      if (is_wanted(state)) some.push_back({limits_.limits[state.limit], state});
    }
    return some;
  }

  live::threats::ThreatLimits limits_;
  FrameShape shape_;
  ThreatMonitor monitor_;
  touch::contacts::ContactTracker contacts_;
  ContactReport report_;
};

}  // namespace

void bind_threats(py::module_& module) {
  py::class_<Threat>(module, "Threat")
      .def_property_readonly("name", [](const Threat& threat) { return threat.limit.name; })
      .def_property_readonly("stands", &Threat::stands)
      .def_property_readonly(
          "quantity",
          [](const Threat& threat) {
            return live::threats::threat_quantity_names()[static_cast<std::size_t>(threat.limit.quantity)];
          })
      .def_property_readonly("limit", [](const Threat& threat) { return threat.limit.limit; })
      .def_property_readonly("value", [](const Threat& threat) { return threat.state.now.value; })
      .def_property_readonly("sigma", [](const Threat& threat) { return threat.state.now.sigma; })
      .def_property_readonly("worst", [](const Threat& threat) { return threat.state.worst.value; })
      .def_property_readonly("position_m",
                             [](const Threat& threat) {
                               const PlaneVector& position = threat.state.now.position;
                               return std::pair(position.x, position.y);
                             })
      .def_property_readonly("crossed_ns", [](const Threat& threat) { return threat.state.crossed.count(); })
      .def("__repr__", [](const Threat& threat) {
        const char* const how = threat.stands() ? " stands: " : " is over: ";
        return "<dermis.Threat '" + threat.limit.name + "'" + how + describe(threat.limit, threat.state.now) + ">";
      });

  py::class_<Monitor>(module, "ThreatMonitor")
      .def(py::init([](const py::object& limits, const touch::pipeline::Model& model,
                       const std::optional<std::string>& name) {
             return std::make_unique<Monitor>(value_or_raise(live::threats::read_threat_limits(path_of(limits))), model,
                                              name.value_or(model.array.name));
           }),
           py::arg("limits"), py::arg("model"), py::kw_only(), py::arg("name") = py::none())
      .def("process", &Monitor::process, py::arg("force"))
      .def_property_readonly("standing", &Monitor::standing)
      .def("reset", &Monitor::reset);
}

}  // namespace dermis::python
