// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"

namespace dermis::python {
namespace {

constexpr double kMostNanos = 9.2e18;  // of std::int64_t
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<py::ssize_t> extents(const FrameShape& shape) {
  return {static_cast<py::ssize_t>(shape.rows), static_cast<py::ssize_t>(shape.cols)};
}

std::vector<py::ssize_t> extents(std::size_t frames, const FrameShape& shape) {
  return {static_cast<py::ssize_t>(frames), static_cast<py::ssize_t>(shape.rows), static_cast<py::ssize_t>(shape.cols)};
}

template <typename T>
std::vector<T> copied(const py::array_t<T>& array) {
  return std::vector<T>(array.data(), array.data() + array.size());
}

bool is_size(const FrameShape& shape) {
  constexpr std::size_t kMostTaxels = kMaxLines * kMaxLines;
  return shape.rows <= kMostTaxels && shape.cols <= kMostTaxels && shape.taxel_count() <= kMostTaxels;
}

FrameShape shape_in(const py::tuple& state) {
  const FrameShape shape{state[0].cast<std::size_t>(), state[1].cast<std::size_t>()};
  require_whole(is_size(shape));
  return shape;
}

bool has_all(std::size_t values, std::size_t frames, const FrameShape& shape) {
  if (frames == 0 || shape.taxel_count() == 0) return values == 0;
  return values % frames == 0 && values / frames == shape.taxel_count();
}

std::optional<double> there(double value) {
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

/// One number a frame, the same number for all frames, or none.
std::vector<double> series(const py::object& object, const char* name, std::size_t frames) {
  if (object.is_none()) return std::vector<double>(frames, kNone);
  if (py::isinstance<py::float_>(object) || py::isinstance<py::int_>(object)) {
    return std::vector<double>(frames, object.cast<double>());
  }
  return copied(numbers<double>(object, name, {static_cast<py::ssize_t>(frames)}));
}

std::vector<std::int64_t> times(const py::object& time_ns, const std::optional<double>& rate_hz, std::size_t frames) {
  if (time_ns.is_none() == !rate_hz) throw py::value_error("give the times of the frames as time_ns, or their rate_hz");
  if (!time_ns.is_none()) {
    std::vector<std::int64_t> given =
        copied(numbers<std::int64_t>(time_ns, "time_ns", {static_cast<py::ssize_t>(frames)}));
    const auto back = std::is_sorted_until(given.begin(), given.end());
    if (back != given.end()) {
      throw py::value_error("time_ns: goes back at [" + std::to_string(back - given.begin()) +
                            "]; give the frames in the order of their times");
    }
    return given;
  }
  if (!(*rate_hz > 0.0 && *rate_hz <= 1e6)) throw py::value_error("rate_hz: must be above 0, at most 1e6");
  if (1e9 * static_cast<double>(frames) / *rate_hz > kMostNanos) {
    throw py::value_error("rate_hz: is so low that these frames would take more than 292 years");
  }
  std::vector<std::int64_t> times(frames);
  for (std::size_t k = 0; k < frames; ++k) times[k] = std::llround(1e9 * static_cast<double>(k) / *rate_hz);
  return times;
}

Recording make_recording(const py::object& counts, const py::object& time_ns, std::optional<double> rate_hz,
                         const py::object& temperature, const py::object& sensors, const py::object& supply,
                         const py::object& array) {
  const std::optional<ArrayDescription> description =
      array.is_none() ? std::nullopt : std::optional<ArrayDescription>(array_of(array));
  Recording recording =
      recording_of(counts, description ? &*description : nullptr, {time_ns, rate_hz, temperature, supply, sensors});
  if (!description) return recording;
  recording.notes = {description->name, bytes::files::array_to_toml(*description)};
  return recording;
}

Recording read_recording(const std::string& path, std::optional<double> rate_hz) {
  py::gil_scoped_release release;
  const auto raise_here = [](const Error& error) {
    py::gil_scoped_acquire acquire;
    raise(error);
  };
  std::string lost;
  Result<std::unique_ptr<FrameSource>> source =
      bytes::recordings::open_frames(path, {.rate_hz = rate_hz, .loss = [&](const std::string& line) { lost = line; }});
  if (!source) raise_here(source.error());
  Recording recording;
  RawFrame frame;
  for (;;) {
    const Result<bool> more = (*source)->next(frame);
    if (!more) raise_here(more.error());
    if (!*more) break;
    recording.append(frame);
  }
  if (!lost.empty()) {
    const py::gil_scoped_acquire acquire;
    if (PyErr_WarnEx(PyExc_UserWarning, lost.c_str(), 1) != 0) throw py::error_already_set();
  }
  if (const std::optional<FrameShape> shape = (*source)->shape()) recording.shape = *shape;
  const Result<bytes::recordings::FrameNotes> notes = bytes::recordings::read_frame_notes(path);
  if (notes) recording.notes = *notes;
  return recording;
}

void write_recording(const Recording& recording, const std::string& path) {
  auto sink = value_or_raise(bytes::recordings::create_frames(path, recording.shape, recording.notes));
  RawFrame frame;
  for (std::size_t k = 0; k < recording.size(); ++k) {
    recording.read(k, frame);
    raise_where_failed(sink->write(frame));
  }
  raise_where_failed(sink->commit());
}

py::object status_of(FrameStatus status) {
  return py::module_::import("dermis").attr("FrameStatus")(static_cast<unsigned>(status));
}

py::bytes bytes_of(const std::vector<TaxelStatus>& taxels) {
  std::string bytes;
  for (const TaxelStatus taxel : taxels) bytes.push_back(static_cast<char>(taxel));
  return bytes;
}

/// Errors that taxels share are not kept: the standard deviation of each then counts alone.
ForceSums sums_of(const ForceFrame& frame, std::vector<float> signed_newtons) {
  ForceSums sums;
  sums.newtons = std::move(signed_newtons);
  for (const float sigma : frame.sigma_newtons) sums.own_variance.push_back(sigma * sigma);
  sums.newtons_per_siemens.resize(sums.newtons.size());
  sums.newtons_per_celsius.resize(sums.newtons.size());
  return sums;
}

/// (newtons, standard deviation) of the taxels in a mask.
py::tuple total_of(const ShapedForce& force, const py::object& mask) {
  const py::array_t<bool> wanted = numbers<bool>(mask, "mask", extents(force.shape));
  std::vector<std::size_t> taxels;
  for (std::size_t taxel = 0; taxel < force.frame.newtons.size(); ++taxel) {
    if (wanted.data()[taxel]) taxels.push_back(taxel);
  }
  const TotalForce total = force.frame.total(taxels);
  return py::make_tuple(total.newtons, total.sigma_newtons);
}

std::vector<TaxelStatus> taxels_of(const std::string& bytes) {
  std::vector<TaxelStatus> taxels;
  for (const char byte : bytes) taxels.push_back(static_cast<TaxelStatus>(byte));
  return taxels;
}

void bind_single_frames(py::module_& module) {
  py::class_<ShapedRaw>(module, "RawFrame")
      .def_property_readonly("time_ns", [](const ShapedRaw& raw) { return raw.frame.time.count(); })
      .def_property_readonly("temperature_celsius", [](const ShapedRaw& raw) { return raw.frame.temperature_celsius; })
      .def_property_readonly("sensor_celsius",
                             [](const py::object& self) {
                               auto& raw = self.cast<ShapedRaw&>();
                               return view(self, raw.frame.sensor_celsius,
                                           {static_cast<py::ssize_t>(raw.frame.sensor_celsius.size())});
                             })
      .def_property_readonly("supply_v", [](const ShapedRaw& raw) { return raw.frame.supply_v; })
      .def_property_readonly("counts",
                             [](const py::object& self) {
                               auto& raw = self.cast<ShapedRaw&>();
                               return view(self, raw.frame.counts, extents(raw.shape));
                             })
      .def_property_readonly("sequence", [](const ShapedRaw& raw) { return raw.frame.acquisition.sequence; })
      .def_property_readonly("lost_before", [](const ShapedRaw& raw) { return raw.frame.acquisition.lost_before; })
      .def(checked_pickle(
          [](const ShapedRaw& raw) {
            return py::make_tuple(raw.shape.rows, raw.shape.cols, raw.frame.time.count(), raw.frame.temperature_celsius,
                                  raw.frame.supply_v, raw.frame.counts, raw.frame.acquisition.sequence,
                                  raw.frame.acquisition.lost_before, raw.frame.sensor_celsius);
          },
          [](const py::tuple& state) {
            ShapedRaw raw;
            raw.shape = shape_in(state);
            raw.frame.time = Nanos(state[2].cast<std::int64_t>());
            raw.frame.temperature_celsius = state[3].cast<std::optional<double>>();
            raw.frame.supply_v = state[4].cast<std::optional<double>>();
            raw.frame.counts = state[5].cast<std::vector<float>>();
            raw.frame.acquisition.sequence = state[6].cast<std::optional<std::uint64_t>>();
            raw.frame.acquisition.lost_before = state[7].cast<std::uint32_t>();
            raw.frame.sensor_celsius = state[8].cast<std::vector<float>>();
            require_whole(has_all(raw.frame.counts.size(), 1, raw.shape));
            return raw;
          }));

  const auto force_view = [](std::vector<float> ForceFrame::*member) {
    return [member](const py::object& self) {
      auto& force = self.cast<ShapedForce&>();
      return view(self, force.frame.*member, extents(force.shape));
    };
  };
  py::class_<ShapedForce>(module, "ForceFrame")
      .def_property_readonly("time_ns", [](const ShapedForce& force) { return force.frame.time.count(); })
      .def_property_readonly("status", [](const ShapedForce& force) { return status_of(force.frame.status); })
      .def_property_readonly("newtons", force_view(&ForceFrame::newtons))
      .def_property_readonly("sigma_newtons", force_view(&ForceFrame::sigma_newtons))
      .def_property_readonly("signal_to_noise", force_view(&ForceFrame::signal_to_noise))
      .def_property_readonly("taxels",
                             [](const py::object& self) {
                               auto& force = self.cast<ShapedForce&>();
                               // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): an enum of one byte
                               const auto* first = reinterpret_cast<const std::uint8_t*>(force.frame.taxels.data());
                               return py::array_t<std::uint8_t>(extents(force.shape), first, self);
                             })
      .def_property_readonly("total", [](const ShapedForce& force) { return force.frame.total().newtons; })
      .def_property_readonly("total_sigma", [](const ShapedForce& force) { return force.frame.total().sigma_newtons; })
      .def("total_of", &total_of, py::arg("mask"))
      .def(checked_pickle(
          [](const ShapedForce& force) {
            return py::make_tuple(force.shape.rows, force.shape.cols, force.frame.time.count(),
                                  static_cast<unsigned>(force.frame.status), force.frame.newtons,
                                  force.frame.sigma_newtons, force.frame.signal_to_noise, bytes_of(force.frame.taxels),
                                  force.frame.sums.newtons);
          },
          [](const py::tuple& state) {
            ShapedForce force;
            force.shape = shape_in(state);
            force.frame.time = Nanos(state[2].cast<std::int64_t>());
            force.frame.status = static_cast<FrameStatus>(state[3].cast<unsigned>());
            force.frame.newtons = state[4].cast<std::vector<float>>();
            force.frame.sigma_newtons = state[5].cast<std::vector<float>>();
            force.frame.signal_to_noise = state[6].cast<std::vector<float>>();
            force.frame.taxels = taxels_of(state[7].cast<std::string>());
            force.frame.sums = sums_of(force.frame, state[8].cast<std::vector<float>>());
            for (const std::size_t values :
                 {force.frame.newtons.size(), force.frame.sigma_newtons.size(), force.frame.signal_to_noise.size(),
                  force.frame.taxels.size(), force.frame.sums.newtons.size()}) {
              require_whole(has_all(values, 1, force.shape));
            }
            return force;
          }));
}

/// Members that are arrays with one value a frame, and with one a taxel.
template <typename Class, typename Value>
auto per_frame(std::vector<Value> Class::*member) {
  return [member](const py::object& self) {
    auto& object = self.cast<Class&>();
    return view(self, object.*member, {static_cast<py::ssize_t>((object.*member).size())});
  };
}
template <typename Class, typename Value>
auto per_taxel(std::vector<Value> Class::*member) {
  return [member](const py::object& self) {
    auto& object = self.cast<Class&>();
    return view(self, object.*member, extents(object.time_ns.size(), object.shape));
  };
}

/// Places of the frames that a slice names.
std::vector<std::size_t> places_of(const py::slice& slice, std::size_t frames) {
  py::ssize_t place = 0;
  py::ssize_t stop = 0;
  py::ssize_t step = 0;
  py::ssize_t count = 0;
  if (!slice.compute(static_cast<py::ssize_t>(frames), &place, &stop, &step, &count)) throw py::error_already_set();
  if (step < 0) throw py::value_error("the step of a slice must be positive: times must not go back");
  std::vector<std::size_t> places(static_cast<std::size_t>(count));
  for (std::size_t& each : places) each = static_cast<std::size_t>(std::exchange(place, place + step));
  return places;
}

/// `each`: values of a frame.
template <typename T>
std::vector<T> picked(const std::vector<T>& values, const std::vector<std::size_t>& places, std::size_t each = 1) {
  std::vector<T> some;
  some.reserve(places.size() * each);
  for (const std::size_t place : places) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(place * each);
    some.insert(some.end(), first, first + static_cast<std::ptrdiff_t>(each));
  }
  return some;
}

Recording part_of_recording(const Recording& whole, const py::slice& slice) {
  const std::vector<std::size_t> places = places_of(slice, whole.size());
  return {whole.shape,
          picked(whole.time_ns, places),
          picked(whole.temperature_celsius, places),
          picked(whole.supply_v, places),
          picked(whole.counts, places, whole.shape.taxel_count()),
          whole.notes,
          whole.sensors,
          picked(whole.sensor_celsius, places, whole.sensors)};
}

Forces part_of_forces(const Forces& whole, const py::slice& slice) {
  const std::vector<std::size_t> places = places_of(slice, whole.time_ns.size());
  const std::size_t taxels = whole.shape.taxel_count();
  Forces part(whole.shape, 0);
  part.time_ns = picked(whole.time_ns, places);
  part.status = picked(whole.status, places);
  part.newtons = picked(whole.newtons, places, taxels);
  part.sigma_newtons = picked(whole.sigma_newtons, places, taxels);
  part.taxels = picked(whole.taxels, places, taxels);
  part.total = picked(whole.total, places);
  part.total_sigma = picked(whole.total_sigma, places);
  return part;
}

/// `values` of each of `frames` frames, with NaN behind them.
std::vector<float> widened(const std::vector<float>& values, std::size_t frames, std::size_t each) {
  std::vector<float> wide(frames * each, std::numeric_limits<float>::quiet_NaN());
  const std::size_t had = frames > 0 ? values.size() / frames : 0;
  for (std::size_t k = 0; k < frames; ++k) std::copy_n(values.data() + k * had, had, wide.data() + k * each);
  return wide;
}

void bind_many_frames(py::module_& module) {
  py::class_<Recording>(module, "Recording")
      .def(py::init(&make_recording), py::arg("counts"), py::kw_only(), py::arg("time_ns") = py::none(),
           py::arg("rate_hz") = py::none(), py::arg("temperature_celsius") = py::none(),
           py::arg("sensor_celsius") = py::none(), py::arg("supply_v") = py::none(), py::arg("array") = py::none())
      .def_static(
          "read",
          [](const py::object& path, std::optional<double> rate_hz) { return read_recording(path_of(path), rate_hz); },
          py::arg("path"), py::kw_only(), py::arg("rate_hz") = py::none())
      .def(
          "write",
          [](const Recording& recording, const py::object& path, bool force) {
            write_recording(recording, new_path(path, force));
          },
          py::arg("path"), py::kw_only(), py::arg("force") = false)
      .def("__len__", &Recording::size)
      .def("__getitem__",
           [](const Recording& recording, py::ssize_t index) {
             const auto size = static_cast<py::ssize_t>(recording.size());
             if (index < 0) index += size;
             if (index < 0 || index >= size)
               throw py::index_error("the recording has " + std::to_string(size) + " frames");
             ShapedRaw raw{recording.shape, {}};
             recording.read(static_cast<std::size_t>(index), raw.frame);
             return raw;
           })
      .def("__getitem__", &part_of_recording)
      .def("__getitem__",
           [](const Recording& /*recording*/, const py::object& /*index*/) -> py::object {
             throw py::type_error(
                 "an index of a Recording is a whole number or a slice; other indices are for its arrays, as in "
                 "recording.counts[index]");
           })
      .def_property_readonly("name", [](const Recording& recording) { return recording.notes.name; })
      .def_property_readonly("model_hash", [](const Recording& recording) { return recording.notes.model_hash; })
      .def_property_readonly("simulation", [](const Recording& recording) { return recording.notes.simulation; })
      .def_property_readonly("array",
                             [](const Recording& recording) -> std::optional<ArrayDescription> {
                               const bytes::recordings::FrameNotes& notes = recording.notes;
                               if (notes.array_toml.empty()) return std::nullopt;
                               return value_or_raise(bytes::files::array_from_toml(notes.array_toml, notes.name));
                             })
      .def_property_readonly("time_ns", per_frame(&Recording::time_ns))
      .def_property_readonly("temperature_celsius", per_frame(&Recording::temperature_celsius))
      .def_property_readonly(
          "sensor_celsius",
          [](const py::object& self) {
            auto& recording = self.cast<Recording&>();
            return view(self, recording.sensor_celsius,
                        {static_cast<py::ssize_t>(recording.size()), static_cast<py::ssize_t>(recording.sensors)});
          })
      .def_property_readonly("supply_v", per_frame(&Recording::supply_v))
      .def_property_readonly("counts", per_taxel(&Recording::counts))
      .def(checked_pickle(
          [](const Recording& recording) {
            return py::make_tuple(recording.shape.rows, recording.shape.cols, recording.time_ns,
                                  recording.temperature_celsius, recording.supply_v, recording.counts,
                                  recording.notes.name, recording.notes.array_toml, recording.notes.model_hash,
                                  recording.notes.simulation, recording.sensors, recording.sensor_celsius);
          },
          [](const py::tuple& state) {
            Recording recording{shape_in(state),
                                state[2].cast<std::vector<std::int64_t>>(),
                                state[3].cast<std::vector<double>>(),
                                state[4].cast<std::vector<double>>(),
                                state[5].cast<std::vector<float>>(),
                                {state[6].cast<std::string>(), state[7].cast<std::string>(),
                                 state[8].cast<std::string>(), state[9].cast<std::string>()},
                                state[10].cast<std::size_t>(),
                                state[11].cast<std::vector<float>>()};
            const std::size_t frames = recording.size();
            require_whole(recording.temperature_celsius.size() == frames && recording.supply_v.size() == frames);
            require_whole(has_all(recording.counts.size(), frames, recording.shape));
            require_whole(has_all(recording.sensor_celsius.size(), frames, {1, recording.sensors}));
            return recording;
          }));

  py::class_<Forces>(module, "Forces")
      .def("__len__", [](const Forces& forces) { return forces.time_ns.size(); })
      .def("__getitem__", &part_of_forces)
      .def("__getitem__",
           [](const Forces& /*forces*/, py::ssize_t index) -> Forces {
             const std::string text = std::to_string(index);
             throw py::type_error("one frame of Forces is forces.newtons[" + text + "], forces.total[" + text +
                                  "] and the like; a slice gives Forces");
           })
      .def("__getitem__",
           [](const Forces& /*forces*/, const py::object& /*index*/) -> Forces {
             throw py::type_error(
                 "an index of Forces is a slice; other indices are for its arrays, as in forces.newtons[index]");
           })
      .def_property_readonly("time_ns", per_frame(&Forces::time_ns))
      .def_property_readonly("status", per_frame(&Forces::status))
      .def_property_readonly("newtons", per_taxel(&Forces::newtons))
      .def_property_readonly("sigma_newtons", per_taxel(&Forces::sigma_newtons))
      .def_property_readonly("taxels", per_taxel(&Forces::taxels))
      .def_property_readonly("total", per_frame(&Forces::total))
      .def_property_readonly("total_sigma", per_frame(&Forces::total_sigma))
      .def(checked_pickle(
          [](const Forces& forces) {
            return py::make_tuple(forces.shape.rows, forces.shape.cols, forces.time_ns, forces.status, forces.newtons,
                                  forces.sigma_newtons, forces.taxels, forces.total, forces.total_sigma);
          },
          [](const py::tuple& state) {
            Forces forces(shape_in(state), 0);
            forces.time_ns = state[2].cast<std::vector<std::int64_t>>();
            forces.status = state[3].cast<std::vector<std::uint16_t>>();
            forces.newtons = state[4].cast<std::vector<float>>();
            forces.sigma_newtons = state[5].cast<std::vector<float>>();
            forces.taxels = state[6].cast<std::vector<std::uint8_t>>();
            forces.total = state[7].cast<std::vector<double>>();
            forces.total_sigma = state[8].cast<std::vector<double>>();
            const std::size_t frames = forces.time_ns.size();
            for (const std::size_t values : {forces.status.size(), forces.total.size(), forces.total_sigma.size()}) {
              require_whole(values == frames);
            }
            for (const std::size_t values :
                 {forces.newtons.size(), forces.sigma_newtons.size(), forces.taxels.size()}) {
              require_whole(has_all(values, frames, forces.shape));
            }
            return forces;
          }));
}

}  // namespace

void Recording::append(const RawFrame& frame) {
  if (frame.sensor_celsius.size() > sensors) {
    sensor_celsius = widened(sensor_celsius, size(), frame.sensor_celsius.size());
    sensors = frame.sensor_celsius.size();
  }
  sensor_celsius.insert(sensor_celsius.end(), frame.sensor_celsius.begin(), frame.sensor_celsius.end());
  time_ns.push_back(frame.time.count());
  temperature_celsius.push_back(frame.temperature_celsius.value_or(kNone));
  supply_v.push_back(frame.supply_v.value_or(kNone));
  counts.insert(counts.end(), frame.counts.begin(), frame.counts.end());
  sensor_celsius.resize(size() * sensors, std::numeric_limits<float>::quiet_NaN());
}

void Recording::read(std::size_t index, RawFrame& frame) const {
  frame.time = Nanos(time_ns[index]);
  frame.temperature_celsius = there(temperature_celsius[index]);
  frame.supply_v = there(supply_v[index]);
  const std::size_t taxels = shape.taxel_count();
  const float* const first = counts.data() + index * taxels;
  frame.counts.assign(first, first + taxels);
  const float* const first_sensor = sensor_celsius.data() + index * sensors;
  frame.sensor_celsius.assign(first_sensor, first_sensor + sensors);
}

std::vector<RawFrame> Recording::frames() const {
  std::vector<RawFrame> frames(size());
  for (std::size_t k = 0; k < size(); ++k) read(k, frames[k]);
  return frames;
}

Recording recording_of(const py::object& counts, const ArrayDescription* array, const FrameSeries& beside) {
  std::vector<py::ssize_t> shape(3, -1);
  if (array != nullptr) shape = {-1, static_cast<py::ssize_t>(array->rows), static_cast<py::ssize_t>(array->cols)};
  const py::array_t<float> values = numbers<float>(counts, "counts", shape);
  const auto frames = static_cast<std::size_t>(values.shape(0));
  Recording recording;
  recording.shape = {static_cast<std::size_t>(values.shape(1)), static_cast<std::size_t>(values.shape(2))};
  if (!is_size(recording.shape)) throw py::value_error("counts: frames have at most 1048576 taxels");
  recording.counts = copied(values);
  recording.time_ns = times(beside.time_ns, beside.rate_hz, frames);
  recording.temperature_celsius = series(beside.temperature_celsius, "temperature_celsius", frames);
  recording.supply_v = series(beside.supply_v, "supply_v", frames);
  if (beside.sensor_celsius.is_none()) return recording;
  const py::array_t<float> sensors =
      numbers<float>(beside.sensor_celsius, "sensor_celsius", {static_cast<py::ssize_t>(frames), -1});
  recording.sensors = static_cast<std::size_t>(sensors.shape(1));
  if (recording.sensors > kMaxLines && recording.sensors != recording.shape.taxel_count()) {
    throw py::value_error("sensor_celsius: has " + std::to_string(recording.sensors) +
                          " sensors; give at most 1024, or one a taxel");
  }
  recording.sensor_celsius = copied(sensors);
  return recording;
}

Recording recording_of(const py::object& object) {
  if (is_path(object)) return read_recording(path_of(object), std::nullopt);
  if (!py::isinstance<Recording>(object))
    throw py::type_error("frames: is a Recording or the path of a file of frames");
  return object.cast<Recording>();
}

Forces::Forces(const FrameShape& array_shape, std::size_t frames)
    : shape(array_shape),
      time_ns(frames),
      status(frames),
      newtons(frames * array_shape.taxel_count()),
      sigma_newtons(newtons.size()),
      taxels(newtons.size()),
      total(frames),
      total_sigma(frames) {}

void Forces::set(std::size_t index, const ForceFrame& frame) {
  const auto first = static_cast<std::ptrdiff_t>(index * shape.taxel_count());
  time_ns[index] = frame.time.count();
  status[index] = static_cast<std::uint16_t>(frame.status);
  const TotalForce sum = frame.total();
  total[index] = sum.newtons;
  total_sigma[index] = sum.sigma_newtons;
  std::copy(frame.newtons.begin(), frame.newtons.end(), newtons.begin() + first);
  std::copy(frame.sigma_newtons.begin(), frame.sigma_newtons.end(), sigma_newtons.begin() + first);
  std::transform(frame.taxels.begin(), frame.taxels.end(), taxels.begin() + first,
                 [](TaxelStatus taxel) { return static_cast<std::uint8_t>(taxel); });
}

void bind_frames(py::module_& module) {
  bind_single_frames(module);
  bind_many_frames(module);
}

}  // namespace dermis::python
