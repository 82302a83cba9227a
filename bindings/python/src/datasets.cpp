// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstring>
#include <numeric>
#include <optional>
#include <utility>

#include "bindings.hpp"
#include "dermis/out/datasets/dataset_files.hpp"
#include "dermis/out/datasets/episodes.hpp"

namespace dermis::python {
namespace {

using out::datasets::Column;
using out::datasets::ColumnType;

/// Keeps all episodes.
class EpisodesInMemory final : public out::datasets::EpisodeSink {
 public:
  struct Episode {
    std::size_t steps = 0;
    std::vector<std::vector<std::byte>> values;  ///< Of each column.
  };

  Status begin(const std::vector<Column>& columns) override {
    columns_ = columns;
    return Done{};
  }

  Status write(const out::datasets::StepBlock& block) override {
    if (is_new_) episodes_.push_back({0, std::vector<std::vector<std::byte>>(columns_.size())});
    is_new_ = false;
    Episode& episode = episodes_.back();
    episode.steps += block.steps;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      episode.values[k].insert(episode.values[k].end(), block.values[k].begin(), block.values[k].end());
    }
    return Done{};
  }

  Status end_episode() override {
    is_new_ = true;
    return Done{};
  }

  Status commit(const out::datasets::EpisodeTally& tally) override {
    held_out_ = tally.held_out;
    labels_ = tally.labels;
    return Done{};
  }

  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }
  [[nodiscard]] const std::vector<Episode>& episodes() const { return episodes_; }
  [[nodiscard]] std::size_t held_out() const { return held_out_; }
  [[nodiscard]] const std::vector<std::string>& labels() const { return labels_; }

 private:
  std::vector<Column> columns_;
  std::vector<Episode> episodes_;
  bool is_new_ = true;
  std::size_t held_out_ = 0;
  std::vector<std::string> labels_;
};

/// By its type in C++: pybind11 of Debian reads the size of a dtype where numpy 2 no longer has it.
template <typename T>
py::array array_of(const std::vector<py::ssize_t>& shape, const std::vector<std::byte>& bytes) {
  py::array_t<T> values(shape);
  if (!bytes.empty()) std::memcpy(values.mutable_data(), bytes.data(), bytes.size());
  return values;
}

py::array column_array(const Column& column, std::size_t steps, const std::vector<std::byte>& bytes) {
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(steps)};
  if (column.shape != std::vector<std::size_t>{1}) shape.insert(shape.end(), column.shape.begin(), column.shape.end());
  if (column.type == ColumnType::float32) return array_of<float>(shape, bytes);
  if (column.type == ColumnType::int64) return array_of<std::int64_t>(shape, bytes);
  return array_of<bool>(shape, bytes);
}

/// Recordings as episodes, which are made when somebody asks for one.
class Dataset {
 public:
  Dataset(std::vector<std::string> recordings, out::datasets::EpisodeOptions options)
      : recordings_(std::move(recordings)), options_(std::move(options)) {
    raise_where_failed(options_.validate());
  }

  [[nodiscard]] std::size_t size() { return episodes().episodes().size(); }

  [[nodiscard]] std::vector<std::size_t> held_out() {
    std::vector<std::size_t> last(episodes().held_out());
    std::iota(last.begin(), last.end(), size() - last.size());
    return last;
  }

  [[nodiscard]] const std::vector<std::string>& labels() { return episodes().labels(); }

  py::dict episode(std::ptrdiff_t index) {
    const auto count = static_cast<std::ptrdiff_t>(size());
    const std::ptrdiff_t place = index < 0 ? index + count : index;
    if (place < 0 || place >= count) throw py::index_error("the dataset has " + std::to_string(count) + " episodes");
    const EpisodesInMemory::Episode& found = episodes().episodes()[static_cast<std::size_t>(place)];
    py::dict columns;
    for (std::size_t k = 0; k < found.values.size(); ++k) {
      const Column& column = episodes().columns()[k];
      columns[py::str(column.name())] = column_array(column, found.steps, found.values[k]);
    }
    return columns;
  }

  void write(const py::object& folder, const std::string& layout, const std::string& task) {
    out::datasets::DatasetOptions how{.fps = options_.fps, .task = task};
    how.python = py::module_::import("sys").attr("executable").cast<std::string>();
    how.format = value_or_raise(out::datasets::dataset_format(layout));
    const auto sink = value_or_raise(out::datasets::create_dataset(path_of(folder), how));
    make(*sink);
  }

 private:
  void make(out::datasets::EpisodeSink& sink) {
    std::vector<std::string> warnings;
    out::datasets::EpisodeOptions options = options_;  // another thread may do the same
    options.loss = [&warnings](const std::string& line) { warnings.push_back(line); };
    options.notice = options.loss;
    const auto made = [&] {
      const py::gil_scoped_release others_run;
      return out::datasets::make_episodes(recordings_, options, sink);
    }();
    if (!made) raise(made.error());
    for (const std::string& line : warnings) {
      if (PyErr_WarnEx(PyExc_UserWarning, line.c_str(), 1) != 0) throw py::error_already_set();
    }
  }

  EpisodesInMemory& episodes() {
    if (!episodes_) {
      auto made = std::make_unique<EpisodesInMemory>();
      make(*made);
      if (!episodes_) episodes_ = std::move(made);
    }
    return *episodes_;
  }

  std::vector<std::string> recordings_;
  out::datasets::EpisodeOptions options_;
  std::unique_ptr<EpisodesInMemory> episodes_;
};

std::vector<std::vector<Nanos>> times_of(const py::object& times_ns) {
  std::vector<std::vector<Nanos>> all;
  if (times_ns.is_none()) return all;
  for (const py::handle each : times_ns) {
    const auto times = numbers<std::int64_t>(py::reinterpret_borrow<py::object>(each), "times_ns", {-1});
    std::vector<Nanos>& of_recording = all.emplace_back();
    for (py::ssize_t k = 0; k < times.size(); ++k) of_recording.emplace_back(times.at(k));
  }
  return all;
}

/// One file, several, or none where it is None.
std::vector<std::string> paths_of(const py::object& object) {
  std::vector<std::string> paths;
  if (object.is_none()) return paths;
  if (is_path(object)) return {path_of(object)};
  for (const py::handle each : object) paths.push_back(path_of(py::reinterpret_borrow<py::object>(each)));
  return paths;
}

std::unique_ptr<Dataset> make_dataset(const py::object& recordings, const py::object& model, double fps,
                                      std::size_t window, const std::optional<std::vector<std::string>>& columns,
                                      bool flat, const py::object& state, const py::object& action,
                                      const py::object& times_ns, bool tare, bool tare_force, bool follow_drift,
                                      const py::object& hold_out, bool cut) {
  std::vector<std::string> paths = paths_of(recordings);
  out::datasets::EpisodeOptions options{.fps = fps, .window = window, .flat = flat};
  if (!model.is_none()) options.model = path_of(model);
  options.quantities = columns.value_or(std::vector<std::string>());
  options.states = paths_of(state);
  options.finds_state = state.is_none();
  options.actions = paths_of(action);
  options.times = times_of(times_ns);
  options.tare = tare;
  options.tare_force = tare_force;
  options.follow_drift = follow_drift;
  options.cut = cut;
  const bool is_share = py::isinstance<py::float_>(hold_out) || py::isinstance<py::int_>(hold_out);
  options.hold_out = is_share ? std::vector{py::str(hold_out).cast<std::string>()} : paths_of(hold_out);
  return std::make_unique<Dataset>(std::move(paths), std::move(options));
}

}  // namespace

void bind_datasets(py::module_& module) {
  module.def(
      "_first_step_ns",
      [](const py::object& recording, double fps) {
        return value_or_raise(out::datasets::first_step(path_of(recording), fps)).count();
      },
      py::arg("recording"), py::arg("fps"));
  py::class_<Dataset>(module, "Dataset")
      .def(py::init(&make_dataset), py::arg("recordings"), py::kw_only(), py::arg("model") = py::none(),
           py::arg("fps") = 30.0, py::arg("window") = 1, py::arg("columns") = py::none(), py::arg("flat") = false,
           py::arg("state") = py::none(), py::arg("action") = py::none(), py::arg("times_ns") = py::none(),
           py::arg("tare") = false, py::arg("tare_force") = false, py::arg("follow_drift") = false,
           py::arg("hold_out") = py::none(), py::arg("cut") = false)
      .def("__len__", &Dataset::size)
      .def_property_readonly("held_out", &Dataset::held_out)
      .def_property_readonly("labels", &Dataset::labels)
      .def("__getitem__", &Dataset::episode, py::arg("episode"))
      .def("write", &Dataset::write, py::arg("folder"), py::kw_only(), py::arg("format") = "lerobot",
           py::arg("task") = "touch");
}

}  // namespace dermis::python
