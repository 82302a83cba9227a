// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cmath>
#include <utility>

#include "columns.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "frame_fields.hpp"
#include "frames.hpp"

namespace dermis::bytes::recordings {
namespace {

void restore(const Fields<Value>& fields, RawFrame& frame) {
  const auto has = [&](unsigned member) { return (fields.known & member) != 0; };
  frame.time = Nanos(fields.time_ns);
  frame.temperature_celsius = has(kTemperature) ? std::optional(fields.temperature_celsius) : std::nullopt;
  frame.supply_v = has(kSupply) ? std::optional(fields.supply_v) : std::nullopt;
  frame.acquisition.sequence = has(kSequence) ? std::optional(fields.sequence) : std::nullopt;
  frame.acquisition.device_time = has(kDeviceTime) ? std::optional(Nanos(fields.device_time_ns)) : std::nullopt;
  frame.acquisition.arrival_steady = Nanos(fields.arrival_steady_ns);
  frame.acquisition.arrival_utc = Nanos(fields.arrival_utc_ns);
  frame.acquisition.lost_before = fields.lost_before;
  frame.acquisition.held_taxels = fields.held_taxels;
}

}  // namespace

struct Hdf5FramesReader::State {
  template <typename T>
  using Column = std::optional<NumberColumn<T>>;

  Hdf5Input file;
  CountsDataset counts;
  Fields<Column> columns{};
  Column<double> time_s{};  ///< Where there is no time_ns.
  std::optional<CountsDataset> sensors{};
  FrameNotes notes{};
  hsize_t next = 0;
  std::uint64_t lost = 0;

  template <typename T>
  Status open_column(const char* name, Column<T>& column);
  Status open_columns();
  Status open_sensors();
  Status read_fields(Fields<Value>& fields);
  Status read_time(std::int64_t& nanos);
  unsigned known_without_saying(const Fields<Value>& fields) const;
};

template <typename T>
Status Hdf5FramesReader::State::open_column(const char* name, Column<T>& column) {
  if (!file.contains(name)) return Done{};
  Result<NumberColumn<T>> opened = NumberColumn<T>::open(file, name, counts.frame_count());
  if (!opened) return opened.error();
  column = *std::move(opened);
  return Done{};
}

Status Hdf5FramesReader::State::open_columns() {
  Status opened = Done{};
  for_each_field(kLabels, columns, [&](const auto& label, auto& column) {
    if (opened) opened = open_column(label.name, column);
  });
  if (opened && !columns.time_ns) opened = open_column(kTimeS, time_s);
  if (opened && !columns.time_ns && !time_s) {
    return bad_input(file.path() + ": has counts, but neither time_ns nor time_s");
  }
  return opened;
}

/// Temperatures: one number for each sensor in each frame.
Status Hdf5FramesReader::State::open_sensors() {
  if (!file.contains(kSensors)) return Done{};
  const Result<Hdf5Dataset> dataset = file.dataset(kSensors);
  if (!dataset) return dataset.error();
  if (dataset->sizes.size() != 2 || dataset->sizes[0] != counts.frame_count() || dataset->sizes[1] == 0 ||
      (dataset->sizes[1] > kMaxLines && dataset->sizes[1] != counts.shape().taxel_count())) {
    return bad_input(dataset->place + " does not hold the sensors of each of " + std::to_string(counts.frame_count()) +
                     " frames");
  }
  Result<CountsDataset> opened = CountsDataset::open(file, kSensors, FrameShape{1, dataset->sizes[1]});
  if (!opened) return opened.error();
  sensors = *std::move(opened);
  return Done{};
}

Status Hdf5FramesReader::State::read_time(std::int64_t& nanos) {
  double seconds = 0.0;
  if (Status done = time_s->read(next, seconds); !done) return done;
  const std::optional<Nanos> time = files::nanos_from_seconds(seconds);
  if (!time) {
    return bad_input(time_s->place() + ": frame " + std::to_string(next) +
                     " has no time; write seconds of at most 9e9");
  }
  nanos = time->count();
  return Done{};
}

/// In files that others wrote, NaN is no value, and numbers that are there are values.
unsigned Hdf5FramesReader::State::known_without_saying(const Fields<Value>& fields) const {
  return (columns.temperature_celsius && !std::isnan(fields.temperature_celsius) ? kTemperature : 0U) |
         (columns.supply_v && !std::isnan(fields.supply_v) ? kSupply : 0U) | (columns.sequence ? kSequence : 0U) |
         (columns.device_time_ns ? kDeviceTime : 0U);
}

Status Hdf5FramesReader::State::read_fields(Fields<Value>& fields) {
  Status done = Done{};
  for_each_field(columns, fields, [&](auto& column, auto& field) {
    if (done && column) done = column->read(next, field);
  });
  if (done && time_s) done = read_time(fields.time_ns);
  if (!columns.known) fields.known = static_cast<std::uint8_t>(known_without_saying(fields));
  return done;
}

Hdf5FramesReader::Hdf5FramesReader(std::unique_ptr<State> state) : state_(std::move(state)) {}

Hdf5FramesReader::~Hdf5FramesReader() {
  const QuietHdf5 quiet;
  state_.reset();
}

Result<std::unique_ptr<Hdf5FramesReader>> Hdf5FramesReader::open(const std::string& path,
                                                                 std::optional<FrameShape> shape) {
  const QuietHdf5 quiet;
  Result<Hdf5Input> file = Hdf5Input::open(path);
  if (!file) return file.error();
  Result<CountsDataset> counts = CountsDataset::open(*file, kCounts, shape);
  if (!counts) return counts.error();
  auto state = std::make_unique<State>(State{*std::move(file), *std::move(counts)});
  if (const Status opened = state->open_columns(); !opened) return opened.error();
  if (const Status opened = state->open_sensors(); !opened) return opened.error();
  state->notes = {state->file.text("name"), state->file.text("array"), state->file.text("model_hash"),
                  state->file.text("simulation")};
  return std::unique_ptr<Hdf5FramesReader>(new Hdf5FramesReader(std::move(state)));
}

Result<bool> Hdf5FramesReader::next(RawFrame& frame) {
  const QuietHdf5 quiet;
  if (state_->next == state_->counts.frame_count()) return false;
  Fields<Value> fields;
  if (const Status read = state_->read_fields(fields); !read) return read.error();
  if (const Status read = state_->counts.read(state_->next, frame.counts); !read) return read.error();
  frame.sensor_celsius.clear();
  if (state_->sensors) {
    if (const Status read = state_->sensors->read(state_->next, frame.sensor_celsius); !read) return read.error();
  }
  restore(fields, frame);
  state_->lost += frame.acquisition.lost_before;
  ++state_->next;
  return true;
}

std::optional<FrameShape> Hdf5FramesReader::shape() const {
  return state_->counts.shape();
}

SourceStatistics Hdf5FramesReader::statistics() const {
  SourceStatistics statistics;
  statistics.frames = state_->next;
  statistics.lost_frames = state_->lost;
  return statistics;
}

const FrameNotes& Hdf5FramesReader::notes() const noexcept {
  return state_->notes;
}

}  // namespace dermis::bytes::recordings
