// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "wiresens.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "columns.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr const char* kPressure = "pressure";
constexpr const char* kTime = "ts";
constexpr const char* kFrameCount = "frame_count";
constexpr const char* kPredicted = "predCount";

using std::chrono::microseconds;

/// A double does not hold microseconds since 1970 exactly: where one is meant, that one.
std::optional<Nanos> time_of(double seconds) {
  const std::optional<Nanos> nanos = files::nanos_from_seconds(seconds);
  if (!nanos) return std::nullopt;
  const auto micros = std::chrono::round<microseconds>(*nanos);
  return files::seconds_of(micros) == seconds ? micros : *nanos;
}

}  // namespace

struct WiresensHdf5Reader::State {
  Hdf5Input file;
  CountsDataset pressure;
  NumberColumn<double> seconds;
  hsize_t frame_count = 0;
  bool has_gaps = false;  ///< Entries that were never written may lie between the frames.
  hsize_t next = 0;

  Status read_frame_count();
  Result<bool> read_next(RawFrame& frame);
};

/// WiReSens writes the index of its last frame into arrays that are longer; where they are not, it is their length.
Status WiresensHdf5Reader::State::read_frame_count() {
  Result<NumberColumn<std::uint64_t>> column = NumberColumn<std::uint64_t>::open(file, kFrameCount, 1);
  if (!column) return column.error();
  std::uint64_t described = 0;
  if (Status read = column->read(0, described); !read) return read;
  has_gaps = described < pressure.frame_count();
  frame_count = has_gaps ? described + 1 : pressure.frame_count();
  return Done{};
}

Result<bool> WiresensHdf5Reader::State::read_next(RawFrame& frame) {
  while (next < frame_count) {
    double at = 0.0;
    if (const Status read = seconds.read(next, at); !read) return read.error();
    if (const Status read = pressure.read(next, frame.counts); !read) return read.error();
    ++next;
    const bool was_never_written =
        at == 0.0 && std::all_of(frame.counts.begin(), frame.counts.end(), [](float count) { return count == 0.0F; });
    if (has_gaps && was_never_written) continue;
    const std::optional<Nanos> time = time_of(at);
    if (time) {
      frame.time = *time;
      return true;
    }
    return bad_input(seconds.place() + ": frame " + std::to_string(next - 1) +
                     " has no time; seconds of at most 9e9 are expected");
  }
  return false;
}

WiresensHdf5Reader::WiresensHdf5Reader(std::unique_ptr<State> state) : state_(std::move(state)) {}

WiresensHdf5Reader::~WiresensHdf5Reader() {
  const QuietHdf5 quiet;
  state_.reset();
}

Result<std::unique_ptr<WiresensHdf5Reader>> WiresensHdf5Reader::open(const std::string& path,
                                                                     std::optional<FrameShape> shape) {
  const QuietHdf5 quiet;
  Result<Hdf5Input> file = Hdf5Input::open(path);
  if (!file) return file.error();
  Result<CountsDataset> pressure = CountsDataset::open(*file, kPressure, shape);
  if (!pressure) return pressure.error();
  Result<NumberColumn<double>> seconds = NumberColumn<double>::open(*file, kTime, pressure->frame_count());
  if (!seconds) return seconds.error();
  auto state = std::make_unique<State>(State{*std::move(file), *std::move(pressure), *std::move(seconds)});
  if (const Status read = state->read_frame_count(); !read) return read.error();
  return std::unique_ptr<WiresensHdf5Reader>(new WiresensHdf5Reader(std::move(state)));
}

Result<bool> WiresensHdf5Reader::next(RawFrame& frame) {
  const QuietHdf5 quiet;
  frame.temperature_celsius.reset();
  frame.supply_v.reset();
  frame.acquisition = {};
  return state_->read_next(frame);
}

std::optional<FrameShape> WiresensHdf5Reader::shape() const {
  return state_->pressure.shape();
}

struct WiresensHdf5Writer::State {
  static constexpr std::size_t kBlockFrames = 64;

  Hdf5Output file;
  FrameShape shape;
  Hdf5Id pressure{};
  Hdf5Id time{};
  Hdf5Id predicted{};
  Hdf5Id frame_count{};
  hsize_t written = 0;
  std::vector<std::int32_t> readings{};
  std::vector<double> seconds{};

  Status create_datasets();
  Status append_counts(const RawFrame& frame);
  Status flush();
};

Status WiresensHdf5Writer::State::create_datasets() {
  constexpr hsize_t kTimesPerChunk = 1024;
  pressure = file.create_dataset(kPressure, H5T_STD_I32LE, {shape.rows, shape.cols}, 1);
  time = file.create_dataset(kTime, H5T_IEEE_F64LE, {}, kTimesPerChunk);
  predicted = file.create_dataset(kPredicted, H5T_IEEE_F64LE, {}, kTimesPerChunk);
  frame_count = file.create_dataset(kFrameCount, H5T_STD_U32LE, {}, 1);
  if (!pressure || !time || !predicted || !frame_count) return file.failure();
  return file.status();
}

Status WiresensHdf5Writer::State::append_counts(const RawFrame& frame) {
  constexpr float kEnd = 2147483648.0F;
  for (std::size_t taxel = 0; taxel < frame.counts.size(); ++taxel) {
    const float count = frame.counts[taxel];
    if (!(count >= -kEnd && count < kEnd) || count != std::trunc(count)) {
      std::string number;
      files::append_number(number, count);
      return bad_input("frame " + std::to_string(written + seconds.size()) + " has a count of " + number + " at " +
                       taxel_name(taxel / shape.cols, taxel % shape.cols) +
                       ", and WiReSens files hold whole counts; write another format");
    }
    readings.push_back(static_cast<std::int32_t>(count));
  }
  return Done{};
}

Status WiresensHdf5Writer::State::flush() {
  if (seconds.empty()) return file.status();
  const std::vector<double> none(seconds.size(), 0.0);
  Status done = file.append(pressure, written, seconds.size(), H5T_NATIVE_INT32, readings.data());
  if (done) done = file.append(time, written, seconds.size(), H5T_NATIVE_DOUBLE, seconds.data());
  if (done) done = file.append(predicted, written, seconds.size(), H5T_NATIVE_DOUBLE, none.data());
  written += seconds.size();
  readings.clear();
  seconds.clear();
  return done;
}

WiresensHdf5Writer::WiresensHdf5Writer(std::unique_ptr<State> state) : state_(std::move(state)) {}

WiresensHdf5Writer::~WiresensHdf5Writer() {
  const QuietHdf5 quiet;
  state_.reset();
}

Result<std::unique_ptr<WiresensHdf5Writer>> WiresensHdf5Writer::create(const std::string& path, FrameShape shape) {
  assert(shape.taxel_count() > 0);
  const QuietHdf5 quiet;
  Result<Hdf5Output> file = Hdf5Output::create(path);
  if (!file) return file.error();
  auto state = std::make_unique<State>(State{*std::move(file), shape});
  if (const Status created = state->create_datasets(); !created) return created.error();
  return std::unique_ptr<WiresensHdf5Writer>(new WiresensHdf5Writer(std::move(state)));
}

Status WiresensHdf5Writer::write(const RawFrame& frame) {
  assert(frame.counts.size() == state_->shape.taxel_count());
  const QuietHdf5 quiet;
  if (Status appended = state_->append_counts(frame); !appended) return appended;
  state_->seconds.push_back(files::seconds_of(frame.time));
  return state_->seconds.size() == State::kBlockFrames ? state_->flush() : state_->file.status();
}

Status WiresensHdf5Writer::commit() {
  const QuietHdf5 quiet;
  if (Status flushed = state_->flush(); !flushed) return flushed;
  const auto count = static_cast<std::uint32_t>(state_->written);
  if (Status counted = state_->file.append(state_->frame_count, 0, 1, H5T_NATIVE_UINT32, &count); !counted) {
    return counted;
  }
  return state_->file.commit();
}

}  // namespace dermis::bytes::recordings
