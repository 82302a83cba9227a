// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/pipeline/pipeline.hpp"

#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "bindings.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "frames.hpp"

namespace dermis::python {
namespace {

Nanos steady_now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

/// The data in `beside` belong to counts alone.
Recording frames_of(const touch::pipeline::Model& model, const py::object& frames, const FrameSeries& beside) {
  const bool is_whole = py::isinstance<Recording>(frames) || is_path(frames);
  if (!is_whole) return recording_of(frames, &model.array, beside);
  const bool is_more_told = !beside.time_ns.is_none() || beside.rate_hz || !beside.temperature_celsius.is_none() ||
                            !beside.supply_v.is_none();
  if (is_more_told) throw py::value_error("frames: a recording has times, temperatures and supplies of its own");
  return recording_of(frames);
}

/// A pipeline that says so where two threads of Python use it at once.
class SharedPipeline {
 public:
  explicit SharedPipeline(std::shared_ptr<touch::pipeline::Model> model)
      : model_(std::move(model)),
        shape_{model_->array.rows, model_->array.cols},
        pipeline_(value_or_raise(touch::pipeline::Pipeline::create(*model_))) {}

  [[nodiscard]] std::shared_ptr<touch::pipeline::Model> model() const { return model_; }

  ShapedForce process(const py::object& counts, const py::object& temperature, std::optional<double> supply,
                      std::optional<std::int64_t> time_ns) {
    const std::unique_lock lock = exclusively();
    const py::array_t<float> values = numbers<float>(counts, "counts", extents());
    raw_.time = time_ns ? Nanos(*time_ns) : steady_now();
    set_temperature(temperature);
    raw_.supply_v = supply;
    raw_.counts.assign(values.data(), values.data() + values.size());
    ShapedForce force{shape_, {}};
    pipeline_.process(raw_, force.frame);
    warn_of_tare();
    return force;
  }

  ShapedForce process_frame(const ShapedRaw& raw) {
    const std::unique_lock lock = exclusively();
    check_shape("the frame has", raw.shape);
    ShapedForce force{shape_, {}};
    pipeline_.process(raw.frame, force.frame);
    warn_of_tare();
    return force;
  }

  Forces run(const Recording& recording) {
    const std::unique_lock lock = exclusively();
    check_shape("the frames have", recording.shape);
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
    pipeline_.tare(force ? touch::pipeline::TareOver::any_load : touch::pipeline::TareOver::drift);
  }

  void undo_tare() {
    const std::unique_lock lock = exclusively();
    pipeline_.undo_tare();
  }

  [[nodiscard]] bool taring() {
    const std::unique_lock lock = exclusively();
    return pipeline_.last_tare().state == touch::pipeline::Tare::State::taking;
  }

  void follow_drift(bool follow) {
    const std::unique_lock lock = exclusively();
    touch::compensation::OffsetDriftOptions options = pipeline_.drift().options();
    options.track = follow;
    pipeline_.drift().set_options(options);
  }

 private:
  /// One of the array, or one of each sensor.
  void set_temperature(const py::object& celsius) {
    raw_.temperature_celsius.reset();
    raw_.sensor_celsius.clear();
    if (celsius.is_none()) return;
    const bool is_list = py::isinstance<py::array>(celsius) ? celsius.cast<py::array>().ndim() > 0
                                                            : py::isinstance<py::sequence>(celsius);
    if (!is_list) {
      raw_.temperature_celsius = static_cast<double>(py::float_(celsius));
      return;
    }
    const py::array_t<float> sensors = numbers<float>(celsius, "temperature", {-1});
    raw_.sensor_celsius.assign(sensors.data(), sensors.data() + sensors.size());
  }

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
    const touch::pipeline::Tare& tare = pipeline_.last_tare();
    if (!tare.has_ended() || std::exchange(reported_tare_, tare.number) == tare.number) return;
    std::string text = touch::pipeline::describe(tare, model_->array);
    if (tare.state == touch::pipeline::Tare::State::refused) text = "not tared: " + text + ", or tare(force=True)";
    if (!text.empty() && PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
  }

  [[nodiscard]] std::unique_lock<std::mutex> exclusively() {
    std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) throw std::runtime_error("the pipeline is at work in another thread: make one for each thread");
    return lock;
  }

  void check_shape(const std::string& what, const FrameShape& shape) const {
    if (shape == shape_) return;
    throw py::value_error(what + " " + bytes::files::size_text(shape) + " taxels, the array of the model has " +
                          bytes::files::size_text(shape_));
  }

  [[nodiscard]] std::vector<py::ssize_t> extents() const {
    return {static_cast<py::ssize_t>(shape_.rows), static_cast<py::ssize_t>(shape_.cols)};
  }

  std::shared_ptr<touch::pipeline::Model> model_;
  FrameShape shape_;
  touch::pipeline::Pipeline pipeline_;
  std::uint64_t reported_tare_ = 0;
  RawFrame raw_;
  std::mutex mutex_;
};

}  // namespace

void bind_pipeline(py::module_& module) {
  py::class_<SharedPipeline>(module, "Pipeline")
      .def(py::init([](const py::object& model) { return std::make_unique<SharedPipeline>(model_of(model)); }),
           py::arg("model"))
      .def_property_readonly("model", &SharedPipeline::model)
      .def("process", &SharedPipeline::process_frame, py::arg("frame"))
      .def("process", &SharedPipeline::process, py::arg("counts"), py::arg("temperature") = py::none(),
           py::arg("supply") = py::none(), py::arg("time_ns") = py::none())
      .def(
          "run",
          [](SharedPipeline& self, const py::object& frames, const py::args& unnamed, const py::object& time_ns,
             std::optional<double> rate_hz, const py::object& temperature_celsius, const py::object& supply_v) {
            if (!unnamed.empty())
              throw py::type_error("run() takes the frames; name what comes beside, as rate_hz=100");
            return self.run(frames_of(*self.model(), frames, {time_ns, rate_hz, temperature_celsius, supply_v}));
          },
          py::arg("frames"), py::arg("time_ns") = py::none(), py::arg("rate_hz") = py::none(),
          py::arg("temperature_celsius") = py::none(), py::arg("supply_v") = py::none())
      .def_property_readonly("why_rejected", &SharedPipeline::why_rejected)
      .def("tare", &SharedPipeline::tare, py::kw_only(), py::arg("force") = false)
      .def("undo_tare", &SharedPipeline::undo_tare)
      .def_property_readonly("taring", &SharedPipeline::taring)
      .def("follow_drift", &SharedPipeline::follow_drift, py::arg("follow") = true);
}

}  // namespace dermis::python
