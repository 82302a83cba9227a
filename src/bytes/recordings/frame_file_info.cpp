// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/frame_file_info.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <system_error>

#include "bytes/recordings/format_rows.hpp"
#include "dermis/bytes/files/frame_times.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/touch/frames/mean_celsius.hpp"

namespace dermis::bytes::recordings {
namespace {

/// Before 2000, a time is no clock time but counted from an origin of its own: that of a simulation.
constexpr Nanos kEarliestClock = std::chrono::sys_days(std::chrono::year(2000) / 1 / 1).time_since_epoch();

Result<FrameFileInfo> info_of_recording(const std::string& path) {
  Result<RecordingInfo> recording = recording_info(path);
  if (!recording) return recording.error();
  FrameFileInfo info;
  info.frames = recording->frames;
  info.duration_s = recording->duration_s;
  if (recording->frames > 0 && recording->start_utc >= kEarliestClock) info.start_utc = recording->start_utc;
  info.lost = recording->lost;
  info.complete = recording->complete;
  if (recording->arrays.size() > 1) {
    info.arrays = std::move(recording->arrays);
  } else {
    const RecordedArrayInfo& array = recording->arrays.front();
    info.shape = array.shape;
    info.notes = {array.name, array.array_toml, array.model_hash, array.simulation, array.model_file};
  }
  info.compression = recording->compression;
  info.software = recording->software_version;
  info.topics = std::move(recording->topics);
  info.unread = std::move(recording->unread);
  return info;
}

void add(const RawFrame& frame, FrameFileInfo& info) {
  if (info.frames++ == 0 && frame.acquisition.arrival_utc >= kEarliestClock) {
    info.start_utc = frame.acquisition.arrival_utc;
  }
  const std::optional<double> celsius = mean_celsius(frame);
  if (!celsius) return;
  auto& range = info.temperature_celsius;
  if (!range) range.emplace(*celsius, *celsius);
  range = {std::min(range->first, *celsius), std::max(range->second, *celsius)};
}

/// Returns the time of the first frame.
Result<Nanos> add_all(FrameSource& source, bool is_timed, FrameFileInfo& info) {
  RawFrame frame;
  Nanos first{};
  files::FrameTimes clock;
  while (true) {
    const Result<bool> more = source.next(frame);
    if (!more) return more.error();
    if (!*more) break;
    if (info.frames == 0) first = frame.time;
    clock.add(frame.time);
    add(frame, info);
  }
  info.shape = source.shape();
  if (is_timed) {
    info.duration_s = clock.seconds();
    info.doubts = clock.findings();
    if (auto doubt = clock.wrong_unit(false)) info.doubts.push_back(*std::move(doubt));
  }
  return first;
}

Result<FrameFileInfo> info_of_frames(const std::string& path, FrameFormat format,
                                     const std::optional<FrameShape>& shape) {
  const bool is_timed = has_times(format) || (may_have_times(format) && open_frames(path, {.shape = shape}));
  FrameFileInfo info;
  const Result<std::unique_ptr<FrameSource>> source = open_frames(
      path, {.shape = shape, .rate_hz = is_timed ? std::nullopt : std::optional(1e3), .loss = [&](const std::string&) {
               info.complete = false;
             }});
  if (!source) return source.error();
  Result<FrameNotes> notes = read_frame_notes(path);
  if (!notes) return notes.error();
  info.notes = std::move(*notes);
  if (const Result<Nanos> first = add_all(**source, is_timed, info); !first) return first.error();
  if (row_of(format).holds == Holds::all) info.lost = (*source)->statistics().lost_frames;
  return info;
}

Result<FrameFileInfo> info_of_one_array(const std::string& path, const std::optional<FrameShape>& shape) {
  Result<FrameFileInfo> info = info_of_frames(path, FrameFormat::mcap, shape);
  if (!info) return info;
  const Result<RecordingInfo> recording = recording_info(recording_place(path).path);
  if (!recording) return recording.error();
  info->compression = recording->compression;
  info->software = recording->software_version;
  return info;
}

Result<FrameFileInfo> info_of(const std::string& path, FrameFormat format, const std::optional<FrameShape>& shape) {
  if (format != FrameFormat::mcap) return info_of_frames(path, format, shape);
  const RecordingPlace place = recording_place(path);
  return place.array.empty() ? info_of_recording(place.path) : info_of_one_array(path, shape);
}

}  // namespace

std::optional<double> FrameFileInfo::rate_hz() const {
  if (!arrays.empty()) return std::nullopt;
  if (!duration_s || !(*duration_s > 0.0) || frames < 2) return std::nullopt;
  return static_cast<double>(frames - 1) / *duration_s;
}

Result<FrameFileInfo> frame_file_info(const std::string& path, const std::optional<FrameShape>& shape) {
  const Result<FrameFormat> format = recognise_frames(path);
  if (!format) return format.error();
  Result<FrameFileInfo> info = info_of(path, *format, shape);
  if (!info) return info;
  const bool is_folded =
      *format == FrameFormat::mcap && shape && info->shape && *info->shape == FrameShape{1, shape->taxel_count()};
  if (is_folded) info->shape = shape;
  if (shape && info->shape && *info->shape != *shape) {
    return bad_input(path + ": has frames of " + files::size_text(*info->shape) + " taxels");
  }
  info->format = *format;
  std::error_code is_no_file;
  const std::uintmax_t bytes = std::filesystem::file_size(recording_place(path).path, is_no_file);
  if (!is_no_file) info->bytes = bytes;
  return info;
}

Result<FrameFileInfo> frame_source_info(FrameSource& source) {
  FrameFileInfo info;
  const bool is_timed = !source.is_live();
  const Result<Nanos> first = add_all(source, is_timed, info);
  if (!first) return first.error();
  info.start_utc = is_timed && *first >= kEarliestClock ? std::optional(*first) : std::nullopt;
  info.lost = source.statistics().lost_frames;
  return info;
}

}  // namespace dermis::bytes::recordings
