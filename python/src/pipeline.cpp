// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/pipeline/pipeline.hpp"

#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "bindings.hpp"
#include "frames.hpp"

namespace dermis::python {
namespace {

Nanos steady_now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

/// A pipeline that says so where two threads of Python use it at once.
class SharedPipeline {
 public:
  explicit SharedPipeline(const pipeline::Model& model)
      : shape_{model.array.rows, model.array.cols},
        array_(model.array),
        pipeline_(value_or_raise(pipeline::Pipeline::create(model))) {}

  ShapedForce process(const py::object& counts, std::optional<double> temperature, std::optional<double> supply,
                      std::optional<std::int64_t> time_ns) {
    const std::unique_lock lock = exclusively();
    const py::array_t<float> values = numbers<float>(counts, "counts", extents());
    raw_.time = time_ns ? Nanos(*time_ns) : steady_now();
    raw_.temperature_celsius = temperature;
    raw_.supply_v = supply;
    raw_.counts.assign(values.data(), values.data() + values.size());
    ShapedForce force{shape_, {}};
    pipeline_.process(raw_, force.frame);
    warn_of_tare();
    return force;
  }

  ShapedForce process_frame(const ShapedRaw& raw) {
    const std::unique_lock lock = exclusively();
    if (raw.shape != shape_) throw py::value_error("the frame has another shape than the array of the model");
    ShapedForce force{shape_, {}};
    pipeline_.process(raw.frame, force.frame);
    warn_of_tare();
    return force;
  }

  Forces run(const Recording& recording) {
    const std::unique_lock lock = exclusively();
    if (recording.shape != shape_) throw py::value_error("the frames have another shape than the array of the model");
    Forces forces(shape_, recording.size());
    process_all(recording, forces);
    warn_of_tare();
    return forces;
  }

  std::string why_rejected() {
    const std::unique_lock lock = exclusively();
    return pipeline_.why_rejected();
  }

  void tare(bool force) {
    const std::unique_lock lock = exclusively();
    pipeline_.tare(force ? pipeline::TareOver::any_load : pipeline::TareOver::drift);
  }

  void undo_tare() {
    const std::unique_lock lock = exclusively();
    pipeline_.undo_tare();
  }

  [[nodiscard]] bool taring() const { return pipeline_.last_tare().state == pipeline::Tare::State::taking; }

  void follow_drift(bool follow) {
    const std::unique_lock lock = exclusively();
    compensation::OffsetDriftOptions options = pipeline_.drift().options();
    options.track = follow;
    pipeline_.drift().set_options(options);
  }

 private:
  void process_all(const Recording& recording, Forces& forces) {
    const py::gil_scoped_release release;
    ForceFrame force;
    for (std::size_t k = 0; k < recording.size(); ++k) {
      recording.read(k, raw_);
      pipeline_.process(raw_, force);
      forces.set(k, force);
    }
  }

  /// Once for each tare that was refused or has taken a load.
  void warn_of_tare() {
    const pipeline::Tare& tare = pipeline_.last_tare();
    if (!tare.has_ended() || std::exchange(told_tare_, tare.number) == tare.number) return;
    std::string text = pipeline::describe(tare, array_);
    if (tare.state == pipeline::Tare::State::refused) text = "not tared: " + text + ", or tare(force=True)";
    if (!text.empty() && PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
  }

  [[nodiscard]] std::unique_lock<std::mutex> exclusively() {
    std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) throw std::runtime_error("the pipeline is at work in another thread: make one for each thread");
    return lock;
  }

  [[nodiscard]] std::vector<py::ssize_t> extents() const {
    return {static_cast<py::ssize_t>(shape_.rows), static_cast<py::ssize_t>(shape_.cols)};
  }

  FrameShape shape_;
  ArrayDescription array_;
  pipeline::Pipeline pipeline_;
  std::uint64_t told_tare_ = 0;
  RawFrame raw_;
  std::mutex mutex_;
};

}  // namespace

void bind_pipeline(py::module_& module) {
  py::class_<SharedPipeline>(module, "Pipeline")
      .def(py::init([](const pipeline::Model& model) { return std::make_unique<SharedPipeline>(model); }),
           py::arg("model"))
      .def("process", &SharedPipeline::process_frame, py::arg("frame"))
      .def("process", &SharedPipeline::process, py::arg("counts"), py::arg("temperature") = py::none(),
           py::arg("supply") = py::none(), py::arg("time_ns") = py::none())
      .def(
          "run",
          [](SharedPipeline& self, const py::object& frames) {
            if (py::isinstance<Recording>(frames)) return self.run(frames.cast<const Recording&>());
            return self.run(recording_of(frames));
          },
          py::arg("frames"))
      .def_property_readonly("why_rejected", &SharedPipeline::why_rejected)
      .def("tare", &SharedPipeline::tare, py::kw_only(), py::arg("force") = false)
      .def("undo_tare", &SharedPipeline::undo_tare)
      .def_property_readonly("taring", &SharedPipeline::taring)
      .def("follow_drift", &SharedPipeline::follow_drift, py::arg("follow") = true);
}

}  // namespace dermis::python
