// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dataset_frames.hpp"

#include <cstdint>
#include <utility>
#include <vector>

#include "columns.hpp"
#include "dermis/bytes/files/array_frames.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::recordings {

namespace {

using files::NumberArray;

NumberArray array_of(const Hdf5Dataset& dataset) {
  return NumberArray::last_fastest({dataset.sizes.begin(), dataset.sizes.end()});
}

/// All values of a dataset, one element of its first axis after the other.
Result<std::vector<float>> read_values(const Hdf5Input& file, const std::string& name, const NumberArray& array) {
  if (array.value_count() > files::kMostArrayValues) {
    return bad_input("has more than 67 million values; save it in parts");
  }
  std::vector<float> values;
  if (array.value_count() == 0) return values;
  const FrameShape row{1, array.value_count() / array.sizes[0]};
  Result<CountsDataset> rows = CountsDataset::open_rows(file, name.c_str(), row);
  if (!rows) return rows.error();
  std::vector<float> next;
  for (hsize_t k = 0; k < rows->frame_count(); ++k) {
    if (Status read = rows->read(k, next); !read) return read.error();
    values.insert(values.end(), next.begin(), next.end());
  }
  return values;
}

/// Groups that times may stand in: beside the dataset, and at the top.
std::vector<std::string> groups_of(const std::string& dataset) {
  return {dataset.substr(0, dataset.rfind('/') + 1), "/"};
}

}  // namespace

struct Hdf5DatasetReader::State {
  Hdf5Input file;
  std::optional<double> rate_hz;
  FrameShape shape{};
  hsize_t frames = 0;
  std::optional<CountsDataset> counts{};
  std::unique_ptr<FrameSource> loaded{};  // where frames do not stand first
  std::optional<NumberColumn<std::int64_t>> time_ns{};
  std::optional<NumberColumn<double>> time_s{};
  std::vector<double> seconds{};  // by other names
  hsize_t next = 0;

  Status open_frames(const std::string& dataset, const std::string& axes, const std::optional<FrameShape>& wanted);
  [[nodiscard]] std::size_t times_beside(const std::string& dataset) const;
  Status open_times(const std::string& dataset);
  Status open_times_in(const std::string& group);
  Status read_seconds(const std::string& name, double unit_s);
  Result<Nanos> time();
  Status read_counts(RawFrame& frame);
};

std::size_t Hdf5DatasetReader::State::times_beside(const std::string& dataset) const {
  for (const std::string& group : groups_of(dataset)) {
    for (const files::TimeName& time : files::kTimeNames) {
      const Result<Hdf5Dataset> times = file.dataset((group + time.name).c_str());
      if (times && times->sizes.size() == 1) return times->sizes[0];
    }
  }
  return 0;
}

/// One by one where they stand first, else as a whole.
Status Hdf5DatasetReader::State::open_frames(const std::string& dataset, const std::string& axes_text,
                                             const std::optional<FrameShape>& wanted) {
  const Result<Hdf5Dataset> found = file.dataset(dataset.c_str());
  if (!found) return found.error();
  const NumberArray array = array_of(*found);
  const files::ArrayHints hints{file.path() + "#" + dataset, axes_text, wanted, times_beside(dataset)};
  const std::string place = file.path() + ": dataset " + files::in_quotes(dataset) + " ";
  Result<std::vector<float>> values = std::vector<float>();
  if (files::needs_values(array, hints)) values = read_values(file, dataset, array);
  if (!values) return bad_input(place + values.error().message);
  const Result<files::FrameAxes> axes = files::frame_axes(array, hints, *values);
  if (!axes) return bad_input(place + axes.error().message);
  shape = axes->shape;
  frames = axes->frames;
  const NumberArray taken = NumberArray::last_fastest({axes->frames, shape.rows, shape.cols});
  if (axes->is_in_order() && taken.value_count() == array.value_count() && array.sizes[0] == axes->frames) {
    Result<CountsDataset> opened = CountsDataset::open_rows(file, dataset.c_str(), shape);
    if (!opened) return opened.error();
    counts = *std::move(opened);
    return Done{};
  }
  if (values->empty()) values = read_values(file, dataset, array);
  if (!values) return bad_input(place + values.error().message);
  loaded = files::frames_of_array(file.path(), *axes, *std::move(values), {{}, 1.0});  // times are those of time()
  return Done{};
}

Status Hdf5DatasetReader::State::read_seconds(const std::string& name, double unit_s) {
  const Result<Hdf5Dataset> dataset = file.dataset(name.c_str());
  if (!dataset || dataset->sizes != Hdf5Sizes{frames} || frames == 0 || frames > files::kMostArrayValues) return Done{};
  std::vector<double> numbers(frames);
  if (Status read = dataset->read(0, frames, hdf5_type<double>(), numbers.data()); !read) return read;
  Result<std::vector<double>> converted = files::seconds_of(std::move(numbers), unit_s);
  if (!converted) return bad_input(dataset->place + ": times " + converted.error().message);
  seconds = *std::move(converted);
  return Done{};
}

Status Hdf5DatasetReader::State::open_times_in(const std::string& group) {
  const std::string nanos_name = group + "time_ns";
  const std::string seconds_name = group + "time_s";
  if (file.contains(nanos_name.c_str())) {
    auto nanos = NumberColumn<std::int64_t>::open(file, nanos_name.c_str(), frames);
    if (!nanos) return nanos.error();
    time_ns = *std::move(nanos);
  } else if (file.contains(seconds_name.c_str())) {
    auto column = NumberColumn<double>::open(file, seconds_name.c_str(), frames);
    if (!column) return column.error();
    time_s = *std::move(column);
  }
  for (const files::TimeName& time : files::kTimeNames) {
    if (time_ns || time_s || !seconds.empty()) break;
    if (Status read = read_seconds(group + time.name, time.unit_s); !read) return read;
  }
  return Done{};
}

Status Hdf5DatasetReader::State::open_times(const std::string& dataset) {
  if (rate_hz) return Done{};
  for (const std::string& group : groups_of(dataset)) {
    if (Status opened = open_times_in(group); !opened) return opened;
    if (time_ns || time_s || !seconds.empty()) return Done{};
  }
  return bad_input(file.path() +
                   ": has no times, neither time_s, time_ns, timestamps, timestamp, time nor t of each of " +
                   std::to_string(frames) + " frames: give a rate, when it is converted or as " +
                   "'file:" + file.path() + "#" + dataset + "?rate=HZ'");
}

Result<Nanos> Hdf5DatasetReader::State::time() {
  if (time_ns) {
    std::int64_t nanos = 0;
    if (const Status read = time_ns->read(next, nanos); !read) return read.error();
    return Nanos(nanos);
  }
  double second = rate_hz ? static_cast<double>(next) / *rate_hz : 0.0;
  if (!seconds.empty()) second = seconds[next];
  if (time_s) {
    if (const Status read = time_s->read(next, second); !read) return read.error();
  }
  const std::optional<Nanos> time = files::nanos_from_seconds(second);
  if (time) return *time;
  return bad_input(file.path() + ": frame " + std::to_string(next) +
                   " has no time; seconds of at most 9e9 are expected");
}

Status Hdf5DatasetReader::State::read_counts(RawFrame& frame) {
  if (counts) return counts->read(next, frame.counts);
  const Result<bool> read = loaded->next(frame);
  return read ? Status(Done{}) : Status(read.error());
}

Hdf5DatasetReader::Hdf5DatasetReader(std::unique_ptr<State> state) : state_(std::move(state)) {}

Hdf5DatasetReader::~Hdf5DatasetReader() {
  const QuietHdf5 quiet;
  state_.reset();
}

Result<std::unique_ptr<Hdf5DatasetReader>> Hdf5DatasetReader::open(const std::string& path, const std::string& dataset,
                                                                   const std::optional<FrameShape>& shape,
                                                                   const std::optional<double>& rate_hz) {
  const QuietHdf5 quiet;
  const files::ArrayChoice choice = files::array_choice(dataset);
  const std::string name = choice.name.starts_with('/') ? choice.name : "/" + choice.name;
  Result<Hdf5Input> file = Hdf5Input::open(path);
  if (!file) return file.error();
  if (!file->contains(name.c_str())) {
    return bad_input(path + ": has no dataset " + files::in_quotes(name) + file->datasets_text());
  }
  auto state = std::make_unique<State>(State{*std::move(file), rate_hz});
  if (const Status opened = state->open_frames(name, choice.axes, shape); !opened) return opened.error();
  if (const Status opened = state->open_times(name); !opened) return opened.error();
  return std::unique_ptr<Hdf5DatasetReader>(new Hdf5DatasetReader(std::move(state)));
}

Result<bool> Hdf5DatasetReader::next(RawFrame& frame) {
  const QuietHdf5 quiet;
  if (state_->next == state_->frames) return false;
  const Result<Nanos> time = state_->time();
  if (!time) return time.error();
  if (const Status read = state_->read_counts(frame); !read) return read.error();
  frame.time = *time;
  frame.temperature_celsius.reset();
  frame.supply_v.reset();
  frame.acquisition = {};
  ++state_->next;
  return true;
}

std::optional<FrameShape> Hdf5DatasetReader::shape() const {
  return state_->shape;
}

}  // namespace dermis::bytes::recordings
