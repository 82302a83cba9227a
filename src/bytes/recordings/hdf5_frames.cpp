// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/hdf5_frames.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "bytes/recordings/hdf5_columns.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/files/u16_counts.hpp"
#include "dermis/touch/frames/version.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr const char* kCounts = "counts";
constexpr const char* kTimeS = "time_s";
constexpr const char* kSensors = "sensor_celsius";

/// Which optional members of a frame have a value, as in the dataset `known`.
constexpr unsigned kTemperature = 1;
constexpr unsigned kSupply = 2;
constexpr unsigned kSequence = 4;
constexpr unsigned kDeviceTime = 8;
constexpr const char* kKnownMeaning =
    "1: temperature_celsius, 2: supply_v, 4: sequence, 8: device_time_ns have a value";

/// The members of a frame besides its counts, and something of each of them.
template <template <typename> typename Of>
struct Fields {
  Of<std::int64_t> time_ns{};
  Of<double> temperature_celsius{};
  Of<double> supply_v{};
  Of<std::uint64_t> sequence{};
  Of<std::int64_t> device_time_ns{};
  Of<std::int64_t> arrival_steady_ns{};
  Of<std::int64_t> arrival_utc_ns{};
  Of<std::uint32_t> lost_before{};
  Of<std::uint32_t> held_taxels{};
  Of<std::uint8_t> known{};
};

/// Calls visit(a.field, b.field) for each field.
template <typename A, typename B, typename Visit>
void for_each_field(A& a, B& b, const Visit& visit) {
  visit(a.time_ns, b.time_ns);
  visit(a.temperature_celsius, b.temperature_celsius);
  visit(a.supply_v, b.supply_v);
  visit(a.sequence, b.sequence);
  visit(a.device_time_ns, b.device_time_ns);
  visit(a.arrival_steady_ns, b.arrival_steady_ns);
  visit(a.arrival_utc_ns, b.arrival_utc_ns);
  visit(a.lost_before, b.lost_before);
  visit(a.held_taxels, b.held_taxels);
  visit(a.known, b.known);
}

template <typename T>
using Value = T;

template <typename T>
struct Label {
  const char* name;
  const char* units;
};

constexpr Fields<Label> kLabels{
    {"time_ns", "ns"},        {"temperature_celsius", "degC"}, {"supply_v", "V"},        {"sequence", "1"},
    {"device_time_ns", "ns"}, {"arrival_steady_ns", "ns"},     {"arrival_utc_ns", "ns"}, {"lost_before", "1"},
    {"held_taxels", "1"},     {"known", kKnownMeaning}};

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Fields<Value> fields_of(const RawFrame& frame) {
  const Acquisition& acquisition = frame.acquisition;
  const unsigned known = (frame.temperature_celsius ? kTemperature : 0U) | (frame.supply_v ? kSupply : 0U) |
                         (acquisition.sequence ? kSequence : 0U) | (acquisition.device_time ? kDeviceTime : 0U);
  return {frame.time.count(),
          frame.temperature_celsius.value_or(kNone),
          frame.supply_v.value_or(kNone),
          acquisition.sequence.value_or(0),
          acquisition.device_time.value_or(Nanos{}).count(),
          acquisition.arrival_steady.count(),
          acquisition.arrival_utc.count(),
          acquisition.lost_before,
          acquisition.held_taxels,
          static_cast<std::uint8_t>(known)};
}

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

namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 19U;
constexpr std::size_t kMaxChunkFrames = 1024;

}  // namespace

struct Hdf5FramesWriter::State {
  template <typename T>
  struct Column {
    Hdf5Id dataset;
    std::vector<T> waiting;
  };

  Hdf5Output file;
  FrameShape shape;
  std::size_t chunk_frames;
  Hdf5Id counts{};
  Column<double> time_s{};
  Fields<Column> columns{};
  std::size_t sensor_count = 0;  ///< The most of any frame so far.
  Column<float> sensors{};
  bool is_u16 = true;
  hsize_t written = 0;      ///< Frames in the datasets.
  std::size_t waiting = 0;  ///< Frames that are not yet in the datasets.
  std::vector<float> counts_f32{};
  std::vector<std::uint16_t> counts_u16{};

  void add_notes(const FrameNotes& notes) const;
  Status create_datasets();
  Hdf5Id create_counts(const char* name, hid_t type) const;
  Status widen_sensors(std::size_t count);
  Status copy_sensors(hsize_t first, hsize_t frames, const Hdf5Id& wide, std::size_t count) const;
  void append_sensors(const std::vector<float>& celsius);
  template <typename T>
  bool create_column(const Label<T>& label, Column<T>& column) const;
  template <typename T>
  Status flush_column(Column<T>& column) const;
  Status flush();
  Status flush_counts();
  Status widen();
};

void Hdf5FramesWriter::State::add_notes(const FrameNotes& notes) const {
  file.add_text("format", "dermis frames");
  file.add_text("software", "dermis " DERMIS_VERSION);
  if (!notes.name.empty()) file.add_text("name", notes.name);
  if (!notes.array_toml.empty()) file.add_text("array", notes.array_toml);
  if (!notes.model_hash.empty()) file.add_text("model_hash", notes.model_hash);
  if (!notes.simulation.empty()) file.add_text("simulation", notes.simulation);
}

Hdf5Id Hdf5FramesWriter::State::create_counts(const char* name, hid_t type) const {
  Hdf5Id dataset = file.create_dataset(name, type, {shape.rows, shape.cols}, chunk_frames);
  if (dataset) Hdf5Output::add_text(dataset.get(), "units", "counts");
  return dataset;
}

template <typename T>
bool Hdf5FramesWriter::State::create_column(const Label<T>& label, Column<T>& column) const {
  column.dataset = file.create_dataset(label.name, hdf5_type<T>(), {}, kMaxChunkFrames);
  if (column.dataset) Hdf5Output::add_text(column.dataset.get(), "units", label.units);
  return static_cast<bool>(column.dataset);
}

Status Hdf5FramesWriter::State::create_datasets() {
  counts = create_counts(kCounts, hdf5_type<std::uint16_t>());
  bool are_created = counts && create_column({kTimeS, "s"}, time_s);
  for_each_field(kLabels, columns,
                 [&](const auto& label, auto& column) { are_created = are_created && create_column(label, column); });
  if (!are_created) return file.failure();
  return file.status();
}

/// A dataset of more sensors: earlier frames have no reading of those that are new.
Status Hdf5FramesWriter::State::widen_sensors(std::size_t count) {
  if (Status flushed = flush(); !flushed) return flushed;
  constexpr const char* kWide = "sensor_celsius_wide";
  const std::size_t frames = std::clamp<std::size_t>(kChunkBytes / (count * sizeof(float)), 1, kMaxChunkFrames);
  Hdf5Id wide = file.create_dataset(kWide, hdf5_type<float>(), {count}, frames);
  if (!wide) return file.failure();
  Hdf5Output::add_text(wide.get(), "units", "degC");
  for (hsize_t first = 0; first < written; first += frames) {
    if (Status copied = copy_sensors(first, std::min<hsize_t>(frames, written - first), wide, count); !copied) {
      return copied;
    }
  }
  sensors.dataset.close();
  if ((sensor_count > 0 && H5Ldelete(file.id(), kSensors, H5P_DEFAULT) < 0) ||
      H5Lmove(file.id(), kWide, file.id(), kSensors, H5P_DEFAULT, H5P_DEFAULT) < 0) {
    return file.failure();
  }
  sensors.dataset = std::move(wide);
  sensor_count = count;
  return file.status();
}

Status Hdf5FramesWriter::State::copy_sensors(hsize_t first, hsize_t frames, const Hdf5Id& wide,
                                             std::size_t count) const {
  std::vector<float> narrow(frames * sensor_count);
  if (sensor_count > 0) {
    Status read = file.read_back(sensors.dataset, first, frames, hdf5_type<float>(), narrow.data());
    if (!read) return read;
  }
  std::vector<float> celsius(frames * count, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t frame = 0; frame < frames; ++frame) {
    std::copy_n(narrow.data() + frame * sensor_count, sensor_count, celsius.data() + frame * count);
  }
  return file.append(wide, first, frames, hdf5_type<float>(), celsius.data());
}

/// A sensor that this frame has not is NaN.
void Hdf5FramesWriter::State::append_sensors(const std::vector<float>& celsius) {
  for (std::size_t sensor = 0; sensor < sensor_count; ++sensor) {
    sensors.waiting.push_back(sensor < celsius.size() ? celsius[sensor] : std::numeric_limits<float>::quiet_NaN());
  }
}

/// The counts of earlier frames as f32 too, since u16 cannot hold those of the next.
Status Hdf5FramesWriter::State::widen() {
  if (Status flushed = flush(); !flushed) return flushed;
  constexpr const char* kWide = "counts_f32";
  Hdf5Id wide = create_counts(kWide, hdf5_type<float>());
  if (!wide) return file.failure();
  std::vector<float> frames;
  for (hsize_t first = 0; first < written; first += chunk_frames) {
    const hsize_t count = std::min<hsize_t>(chunk_frames, written - first);
    frames.resize(count * shape.taxel_count());
    if (Status read = file.read_back(counts, first, count, hdf5_type<float>(), frames.data()); !read) return read;
    if (Status copied = file.append(wide, first, count, hdf5_type<float>(), frames.data()); !copied) return copied;
  }
  counts.close();
  is_u16 = false;
  if (H5Ldelete(file.id(), kCounts, H5P_DEFAULT) < 0 ||
      H5Lmove(file.id(), kWide, file.id(), kCounts, H5P_DEFAULT, H5P_DEFAULT) < 0) {
    return file.failure();
  }
  counts = std::move(wide);
  return file.status();
}

Status Hdf5FramesWriter::State::flush_counts() {
  if (!is_u16) return file.append(counts, written, waiting, hdf5_type<float>(), counts_f32.data());
  counts_u16.resize(counts_f32.size());
  std::transform(counts_f32.begin(), counts_f32.end(), counts_u16.begin(),
                 [](float count) { return static_cast<std::uint16_t>(count); });
  return file.append(counts, written, waiting, hdf5_type<std::uint16_t>(), counts_u16.data());
}

template <typename T>
Status Hdf5FramesWriter::State::flush_column(Column<T>& column) const {
  Status done = file.append(column.dataset, written, waiting, hdf5_type<T>(), column.waiting.data());
  column.waiting.clear();
  return done;
}

Status Hdf5FramesWriter::State::flush() {
  if (waiting == 0) return file.status();
  Status done = flush_counts();
  if (done) done = flush_column(time_s);
  if (done && sensors.dataset) done = flush_column(sensors);
  for_each_field(columns, columns, [&](auto& column, const auto& /*same*/) {
    if (done) done = flush_column(column);
  });
  written += waiting;
  waiting = 0;
  counts_f32.clear();
  return done;
}

Hdf5FramesWriter::Hdf5FramesWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}

Hdf5FramesWriter::~Hdf5FramesWriter() {
  const QuietHdf5 quiet;
  state_.reset();
}

Result<std::unique_ptr<Hdf5FramesWriter>> Hdf5FramesWriter::create(const std::string& path, FrameShape shape,
                                                                   const FrameNotes& notes) {
  assert(shape.taxel_count() > 0);
  const QuietHdf5 quiet;
  Result<Hdf5Output> file = Hdf5Output::create(path);
  if (!file) return file.error();
  const std::size_t frames = kChunkBytes / (shape.taxel_count() * sizeof(std::uint16_t));
  auto state =
      std::make_unique<State>(State{*std::move(file), shape, std::clamp<std::size_t>(frames, 1, kMaxChunkFrames)});
  state->add_notes(notes);
  if (const Status created = state->create_datasets(); !created) return created.error();
  return std::unique_ptr<Hdf5FramesWriter>(new Hdf5FramesWriter(std::move(state)));
}

Status Hdf5FramesWriter::write(const RawFrame& frame) {
  assert(frame.counts.size() == state_->shape.taxel_count());
  const QuietHdf5 quiet;
  State& state = *state_;
  if (state.is_u16 && !files::fit_u16(frame.counts)) {
    if (Status widened = state.widen(); !widened) return widened;
  }
  if (frame.sensor_celsius.size() > state.sensor_count) {
    if (Status widened = state.widen_sensors(frame.sensor_celsius.size()); !widened) return widened;
  }
  state.counts_f32.insert(state.counts_f32.end(), frame.counts.begin(), frame.counts.end());
  state.append_sensors(frame.sensor_celsius);
  state.time_s.waiting.push_back(files::seconds_of(frame.time));
  const Fields<Value> fields = fields_of(frame);
  for_each_field(state.columns, fields, [](auto& column, const auto& field) { column.waiting.push_back(field); });
  if (++state.waiting == state.chunk_frames) return state.flush();
  return state.file.status();
}

Status Hdf5FramesWriter::commit() {
  const QuietHdf5 quiet;
  if (Status flushed = state_->flush(); !flushed) return flushed;
  return state_->file.commit();
}

}  // namespace dermis::bytes::recordings
