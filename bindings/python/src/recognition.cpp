// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "bindings.hpp"
#include "dermis/learn/recognition/classes_file.hpp"
#include "dermis/learn/recognition/stream_recogniser.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "frames.hpp"

namespace dermis::python {
namespace {

using learn::recognition::Classes;
using learn::recognition::StreamRecogniser;
using learn::recognition::Verdict;

/// An answer that lives on.
struct Recognition {
  std::string name;
  std::string likeliest;
  std::string reason;
  std::map<std::string, double> probabilities;
  double unknown_score = 0.0;
  std::pair<std::size_t, std::size_t> frames;
};

Recognition lasting(const learn::recognition::Recognition& found, const Classes& classes) {
  const learn::recognition::Answer& answer = found.answer;
  const bool is_known = answer.verdict == Verdict::known;
  Recognition kept;
  kept.likeliest = classes.names[answer.likeliest];
  kept.name = is_known ? kept.likeliest : "unknown";
  kept.reason = is_known ? "" : to_string(answer.verdict);
  for (std::size_t k = 0; k < classes.names.size(); ++k) kept.probabilities[classes.names[k]] = answer.probabilities[k];
  kept.unknown_score = answer.unknown_score;
  kept.frames = {found.frames.first, found.frames.last};
  return kept;
}

/// Newtons of one array; `rate_hz` empty: that of the examples.
learn::recognition::Layout layout_of(const ArrayDescription& array, const Classes& classes,
                                     std::optional<double> rate_hz) {
  learn::recognition::Layout layout;
  layout.arrays = {learn::recognition::sensed_array(array, array.name)};
  layout.readings = array.taxel_count();
  layout.rate_hz = rate_hz.value_or(classes.layout.rate_hz);
  layout.quantity = Quantity::force;
  return layout;
}

/// Names what touches one array, from its forces.
class Recogniser {
 public:
  Recogniser(FrameShape shape, StreamRecogniser stream) : shape_(shape), stream_(std::move(stream)) {}

  std::optional<Recognition> process(const ShapedForce& force) {
    if (force.shape != shape_) throw py::value_error("force: has another shape than the array of the model");
    loads_ = force.frame.newtons;
    for (float& load : loads_) load = std::isfinite(load) ? std::max(load, 0.0F) : 0.0F;
    return answer(stream_.next(loads_));
  }

  std::optional<Recognition> finish() { return answer(stream_.finish()); }

  [[nodiscard]] const std::vector<std::string>& names() const { return stream_.classes().names; }

 private:
  [[nodiscard]] std::optional<Recognition> answer(const std::optional<learn::recognition::Recognition>& found) const {
    if (!found) return std::nullopt;
    return lasting(*found, stream_.classes());
  }

  FrameShape shape_;
  StreamRecogniser stream_;
  std::vector<float> loads_;
};

std::unique_ptr<Recogniser> make_recogniser(const py::object& classes_path, const touch::pipeline::Model& model,
                                            std::optional<double> rate_hz) {
  if (rate_hz && !learn::recognition::is_rate(*rate_hz)) throw py::value_error("rate_hz: must be 0.001 to 1e6");
  const std::string path = path_of(classes_path);
  const Classes classes = value_or_raise(learn::recognition::read_classes(path));
  Result<StreamRecogniser> stream = StreamRecogniser::create(classes, layout_of(model.array, classes, rate_hz));
  if (!stream) raise(bad_input(path + ": " + stream.error().message));
  return std::make_unique<Recogniser>(FrameShape{model.array.rows, model.array.cols}, *std::move(stream));
}

}  // namespace

void bind_recognition(py::module_& module) {
  py::class_<Recognition>(module, "Recognition")
      .def_readonly("name", &Recognition::name)
      .def_readonly("likeliest", &Recognition::likeliest)
      .def_readonly("probabilities", &Recognition::probabilities)
      .def_readonly("unknown_score", &Recognition::unknown_score)
      .def_readonly("reason", &Recognition::reason)
      .def_readonly("frames", &Recognition::frames)
      .def("__repr__", [](const Recognition& found) {
        const std::string of = found.name == found.likeliest ? "" : ", likeliest '" + found.likeliest + "'";
        return "<dermis.Recognition '" + found.name + "'" + of + " in frames " + std::to_string(found.frames.first) +
               " to " + std::to_string(found.frames.second) + ">";
      });
  py::class_<Recogniser>(module, "Recogniser")
      .def(py::init(&make_recogniser), py::arg("classes"), py::arg("model"), py::kw_only(),
           py::arg("rate_hz") = py::none())
      .def("process", &Recogniser::process, py::arg("force"))
      .def("finish", &Recogniser::finish)
      .def_property_readonly("names", &Recogniser::names);
}

}  // namespace dermis::python
