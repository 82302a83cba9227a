// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dataset_frames.hpp"

#include <cstdint>
#include <utility>

#include "columns.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::recordings {

struct Hdf5DatasetReader::State {
  Hdf5Input file;
  CountsDataset counts;
  std::optional<double> rate_hz;
  std::optional<NumberColumn<std::int64_t>> time_ns{};
  std::optional<NumberColumn<double>> time_s{};
  hsize_t next = 0;

  Status open_times(const std::string& dataset);
  Status open_times_in(const std::string& group);
  Result<Nanos> time();
};

Status Hdf5DatasetReader::State::open_times_in(const std::string& group) {
  const std::string nanos_name = group + "time_ns";
  const std::string seconds_name = group + "time_s";
  if (file.contains(nanos_name.c_str())) {
    auto nanos = NumberColumn<std::int64_t>::open(file, nanos_name.c_str(), counts.frame_count());
    if (!nanos) return nanos.error();
    time_ns = *std::move(nanos);
  } else if (file.contains(seconds_name.c_str())) {
    auto seconds = NumberColumn<double>::open(file, seconds_name.c_str(), counts.frame_count());
    if (!seconds) return seconds.error();
    time_s = *std::move(seconds);
  }
  return Done{};
}

Status Hdf5DatasetReader::State::open_times(const std::string& dataset) {
  if (rate_hz) return Done{};
  for (const std::string& group : {dataset.substr(0, dataset.rfind('/') + 1), std::string("/")}) {
    if (Status opened = open_times_in(group); !opened) return opened;
    if (time_ns || time_s) return Done{};
  }
  return bad_input(file.path() +
                   ": has no times, neither time_s nor time_ns: give a rate, when it is converted or as " +
                   "'file:" + file.path() + "#" + dataset + "?rate=HZ'");
}

Result<Nanos> Hdf5DatasetReader::State::time() {
  if (time_ns) {
    std::int64_t nanos = 0;
    if (const Status read = time_ns->read(next, nanos); !read) return read.error();
    return Nanos(nanos);
  }
  double seconds = rate_hz ? static_cast<double>(next) / *rate_hz : 0.0;
  if (time_s) {
    if (const Status read = time_s->read(next, seconds); !read) return read.error();
  }
  const std::optional<Nanos> time = files::nanos_from_seconds(seconds);
  if (time) return *time;
  return bad_input(file.path() + ": frame " + std::to_string(next) +
                   " has no time; seconds of at most 9e9 are expected");
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
  const std::string name = dataset.starts_with('/') ? dataset : "/" + dataset;
  Result<Hdf5Input> file = Hdf5Input::open(path);
  if (!file) return file.error();
  if (!file->contains(name.c_str())) {
    return bad_input(path + ": has no dataset " + files::in_quotes(name) + file->datasets_text());
  }
  Result<CountsDataset> counts = CountsDataset::open(*file, name.c_str(), shape);
  if (!counts) return counts.error();
  auto state = std::make_unique<State>(State{*std::move(file), *std::move(counts), rate_hz});
  if (const Status opened = state->open_times(name); !opened) return opened.error();
  return std::unique_ptr<Hdf5DatasetReader>(new Hdf5DatasetReader(std::move(state)));
}

Result<bool> Hdf5DatasetReader::next(RawFrame& frame) {
  const QuietHdf5 quiet;
  if (state_->next == state_->counts.frame_count()) return false;
  const Result<Nanos> time = state_->time();
  if (!time) return time.error();
  if (const Status read = state_->counts.read(state_->next, frame.counts); !read) return read.error();
  frame.time = *time;
  frame.temperature_celsius.reset();
  frame.supply_v.reset();
  frame.acquisition = {};
  ++state_->next;
  return true;
}

std::optional<FrameShape> Hdf5DatasetReader::shape() const {
  return state_->counts.shape();
}

}  // namespace dermis::bytes::recordings
