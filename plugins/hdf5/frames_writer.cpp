// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>
#include <vector>

#include "columns.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/files/u16_counts.hpp"
#include "dermis/touch/frames/version.hpp"
#include "frame_fields.hpp"
#include "frames.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 19U;
constexpr std::size_t kMaxChunkFrames = 1024;
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

  Status add_notes(const FrameNotes& notes) const;
  Status create_datasets();
  Hdf5Id create(const char* name, hid_t type, const Hdf5Sizes& sizes, hsize_t frames_per_chunk,
                const char* units) const;
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

Status Hdf5FramesWriter::State::add_notes(const FrameNotes& notes) const {
  Status added = Done{};
  for (const auto& [name, text] : {std::pair<const char*, std::string>{"format", "dermis frames"},
                                   {"software", "dermis " DERMIS_VERSION},
                                   {"name", notes.name},
                                   {"array", notes.array_toml},
                                   {"model_hash", notes.model_hash},
                                   {"simulation", notes.simulation}}) {
    if (added && !text.empty()) added = file.set_text("/", name, text);
  }
  return added;
}

/// With the name of its units; nothing where that cannot be.
Hdf5Id Hdf5FramesWriter::State::create(const char* name, hid_t type, const Hdf5Sizes& sizes, hsize_t frames_per_chunk,
                                       const char* units) const {
  Hdf5Id dataset = file.create_dataset(name, type, sizes, frames_per_chunk);
  return dataset && file.set_text(name, "units", units) ? std::move(dataset) : Hdf5Id();
}

Hdf5Id Hdf5FramesWriter::State::create_counts(const char* name, hid_t type) const {
  return create(name, type, {shape.rows, shape.cols}, chunk_frames, "counts");
}

template <typename T>
bool Hdf5FramesWriter::State::create_column(const Label<T>& label, Column<T>& column) const {
  column.dataset = create(label.name, hdf5_type<T>(), {}, kMaxChunkFrames, label.units);
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
  Hdf5Id wide = create(kWide, hdf5_type<float>(), {count}, frames, "degC");
  if (!wide) return file.failure();
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
  if (const Status added = state->add_notes(notes); !added) return added.error();
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
