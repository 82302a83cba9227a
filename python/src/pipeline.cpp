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
      : shape_{model.array.rows, model.array.cols}, pipeline_(value_or_raise(pipeline::Pipeline::create(model))) {}

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
    return force;
  }

  ShapedForce process_frame(const ShapedRaw& raw) {
    const std::unique_lock lock = exclusively();
    if (raw.shape != shape_) throw py::value_error("the frame has another shape than the array of the model");
    ShapedForce force{shape_, {}};
    pipeline_.process(raw.frame, force.frame);
    return force;
  }

  Forces run(const Recording& recording) {
    const std::unique_lock lock = exclusively();
    if (recording.shape != shape_) throw py::value_error("the frames have another shape than the array of the model");
    const py::gil_scoped_release release;
    Forces forces(shape_, recording.size());
    ForceFrame force;
    for (std::size_t k = 0; k < recording.size(); ++k) {
      recording.read(k, raw_);
      pipeline_.process(raw_, force);
      forces.set(k, force);
    }
    return forces;
  }

  std::string why_rejected() {
    const std::unique_lock lock = exclusively();
    return pipeline_.why_rejected();
  }

  void tare() {
    const std::unique_lock lock = exclusively();
    pipeline_.drift().tare();
  }

  void follow_drift(bool follow) {
    const std::unique_lock lock = exclusively();
    compensation::OffsetDriftOptions options = pipeline_.drift().options();
    options.track = follow;
    pipeline_.drift().set_options(options);
  }

 private:
  [[nodiscard]] std::unique_lock<std::mutex> exclusively() {
    std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) throw std::runtime_error("the pipeline is at work in another thread: make one for each thread");
    return lock;
  }

  [[nodiscard]] std::vector<py::ssize_t> extents() const {
    return {static_cast<py::ssize_t>(shape_.rows), static_cast<py::ssize_t>(shape_.cols)};
  }

  FrameShape shape_;
  pipeline::Pipeline pipeline_;
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
      .def("tare", &SharedPipeline::tare)
      .def("follow_drift", &SharedPipeline::follow_drift, py::arg("follow") = true);
}

}  // namespace dermis::python
