// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recognising/labelled_examples.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "dermis/touch/frames/quantile.hpp"
#include "recognising/force_source.hpp"

namespace dermis::recognising {
namespace {

using learn::recognition::ForceRecording;
using learn::recognition::LabelledFrames;
using learn::recognition::Layout;

constexpr double kMostRateDifference = 0.1;  // of the first recording

/// A recording, and its notes on its frames.
struct ReadRecording {
  ForceRecording recording;
  Layout layout;
  std::vector<std::string> extra_names{};
  std::vector<std::string> troubles{};
};

/// "2x3 taxels", or "chest 16x16, hand 4x5 taxels".
std::string text_of(const Layout& layout) {
  std::string text;
  for (const learn::recognition::SensedArray& array : layout.arrays) {
    if (layout.arrays.size() > 1) text += (text.empty() ? "" : ", ") + array.name + " ";
    text += fmt::format("{}x{}", array.rows, array.cols);
  }
  return text + " taxels";
}

/// By the median of the intervals; 0 where they show none.
double rate_of(const std::vector<Nanos>& times) {
  if (times.size() < 2) return 0.0;
  std::vector<Nanos> intervals;
  for (std::size_t i = 1; i < times.size(); ++i) intervals.push_back(times[i] - times[i - 1]);
  const Nanos usual = upper_median(std::move(intervals));
  const double rate = 1.0 / std::max(std::chrono::duration<double>(usual).count(), 1e-9);
  return learn::recognition::is_rate(rate) ? rate : 0.0;
}

/// `arrays`: which of several; empty: all.
Result<ReadRecording> read_recording(const ExampleOptions& options, const std::string& from,
                                     const std::vector<std::string>& arrays, const live::sources::SourceOptions& how) {
  Result<ForceSource> source = ForceSource::open({.from = from,
                                                  .model = options.model,
                                                  .tare = options.tare || options.tare_force,
                                                  .tare_force = options.tare_force,
                                                  .source = how,
                                                  .arrays = arrays,
                                                  .extra = options.data.extras});
  if (!source) return source.error();
  if (source->is_live()) return live::sources::has_no_end(from);
  ReadRecording read{.recording = {.name = source->from().short_name(), .frames = {}}, .layout = {}};
  std::vector<Nanos> times;
  for (;;) {
    const Result<bool> more = source->next();
    if (!more) return more.error();
    if (!*more) break;
    read.recording.frames.insert(read.recording.frames.end(), source->loads().begin(), source->loads().end());
    read.recording.extras.insert(read.recording.extras.end(), source->extras().begin(), source->extras().end());
    read.recording.tare_frames += source->is_tare() ? 1 : 0;
    times.push_back(source->time());
  }
  if (read.recording.tare_frames == times.size()) {
    return bad_input(from + ": ends before it is tared, which takes 1 s");
  }
  read.troubles = source->describe_troubles();
  read.extra_names = source->extra_names();
  read.layout = source->layout().value_or(Layout{});
  read.layout.rate_hz = options.data.rate_hz > 0.0 ? options.data.rate_hz : rate_of(times);
  return read;
}

/// Whether another recording is of the same arrays and rate as the first.
Status check_alike(const ReadRecording& first, const ReadRecording& other) {
  const std::string& name = other.recording.name;
  const std::string& first_name = first.recording.name;
  if (other.recording.name == first.recording.name) {
    return bad_field("in",
                     "two recordings are called " + name + "; rename one, so that the labels can tell them apart");
  }
  if (text_of(other.layout) != text_of(first.layout)) {
    return bad_input(fmt::format("{}: has frames of {}, {} of {}; learn from recordings of the same arrays", name,
                                 text_of(other.layout), first_name, text_of(first.layout)));
  }
  const double rate_hz = first.layout.rate_hz;
  if (std::abs(other.layout.rate_hz - rate_hz) > kMostRateDifference * rate_hz) {
    return bad_input(fmt::format("{}: has {:.4g} frames a second, {} {:.4g}; learn from recordings of one rate", name,
                                 other.layout.rate_hz, first_name, rate_hz));
  }
  return Done{};
}

/// Where a further reading is missing, the mean of all others of its column stands.
Status fill_missing(const std::string& path, std::vector<ReadRecording>& read) {
  const std::vector<std::string>& names = read.front().extra_names;
  const auto for_each_of = [&](std::size_t column, const auto& work) {
    for (ReadRecording& one : read) {
      std::vector<float>& extras = one.recording.extras;
      for (std::size_t place = column; place < extras.size(); place += names.size()) work(extras[place]);
    }
  };
  for (std::size_t column = 0; column < names.size(); ++column) {
    double sum = 0.0;
    std::size_t count = 0;
    for_each_of(column, [&](float value) {
      if (std::isnan(value)) return;
      sum += static_cast<double>(value);
      ++count;
    });
    if (count == 0) {
      return bad_input(
          fmt::format("{}: '{}' has no value at the times of the frames; time_s must be that of their "
                      "recording, as a conversion writes it into frames.csv",
                      path, names[column]));
    }
    const auto mean = static_cast<float>(sum / static_cast<double>(count));
    for_each_of(column, [&](float& value) { value = std::isnan(value) ? mean : value; });
  }
  return Done{};
}

Result<LabelledFrames> read_recordings(const ExampleOptions& options, const live::sources::SourceOptions& how) {
  std::vector<ReadRecording> read;
  std::vector<std::string> arrays = options.arrays;
  for (const std::string& from : options.in) {
    Result<ReadRecording> next = read_recording(options, from, arrays, how);
    if (!next) return next.error();
    for (const ReadRecording& before : read) {
      if (Status alike = check_alike(before, *next); !alike) return alike.error();
    }
    read.push_back(*std::move(next));
    arrays = learn::recognition::names_of(read.front().layout.arrays);
  }
  if (Status filled = fill_missing(options.data.extras, read); !filled) return filled.error();
  for (const ReadRecording& one : read) {
    for (const std::string& line : one.troubles) {
      if (how.notice) how.notice(line);
    }
  }
  const Layout layout = read.front().layout;
  std::vector<ForceRecording> recordings;
  for (ReadRecording& one : read) recordings.push_back(std::move(one.recording));
  return learn::recognition::label_recordings(layout, std::move(recordings), options.data.labels, options.data.label);
}

}  // namespace

Result<LabelledFrames> read_examples(const ExampleOptions& options, const live::sources::SourceOptions& source) {
  if (!learn::recognition::is_rate(options.data.rate_hz)) return bad_field("rate", "must be 0.001 to 1e6");
  const bool has_plain = !options.data.frames.empty() || !options.data.arrays.empty();
  if (options.in.empty()) {
    if (!options.model.empty() || options.tare || options.tare_force) {
      return bad_field("frames", "are loads already; a model and tare are for recordings");
    }
    if (!options.data.frames.empty() && !options.data.arrays.empty())
      return learn::recognition::read_dataset(options.data);
    return bad_input("name the examples: recordings (in), or frames with their arrays (frames, arrays)");
  }
  if (has_plain) return bad_field("in", "excludes frames and arrays; name one kind of examples");
  return read_recordings(options, source);
}

}  // namespace dermis::recognising
