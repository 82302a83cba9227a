// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "commands.hpp"
#include "dermis/recordings/frame_files.hpp"
#include "dermis/recordings/recording.hpp"

namespace dermis::app {
namespace {

using recordings::FrameFormat;

/// Before 2000, a time is no clock time but counted from an origin of its own: that of a simulation.
constexpr Nanos kEarliestClock = std::chrono::sys_days(std::chrono::year(2000) / 1 / 1).time_since_epoch();

struct InfoOptions {
  std::string file;
  bool json = false;
};

/// What a file of frames holds; empty where the format cannot tell.
struct Info {
  std::string format;
  std::uint64_t bytes = 0;
  std::uint64_t frames = 0;
  std::optional<FrameShape> shape;
  std::optional<double> duration_s;
  std::optional<Nanos> start_utc;
  std::optional<std::uint64_t> lost;
  bool complete = true;
  std::optional<std::pair<double, double>> temperature_celsius;  ///< Lowest and highest.
  recordings::FrameNotes notes;
  std::string compression;
  std::string software;
  std::vector<recordings::RecordedArrayInfo> arrays;  ///< Where there are several.
  std::vector<recordings::RecordingTopic> topics;
};

Result<Info> info_of_recording(const std::string& path) {
  Result<recordings::RecordingInfo> recording = recordings::recording_info(path);
  if (!recording) return recording.error();
  Info info;
  info.frames = recording->frames;
  info.duration_s = recording->duration_s;
  if (recording->frames > 0 && recording->start_utc >= kEarliestClock) info.start_utc = recording->start_utc;
  info.lost = recording->lost;
  info.complete = recording->complete;
  if (recording->arrays.size() > 1) {
    info.arrays = std::move(recording->arrays);
  } else {
    const recordings::RecordedArrayInfo& array = recording->arrays.front();
    info.shape = array.shape;
    info.notes = {array.name, array.array_toml, array.model_hash};
  }
  info.compression = recording->compression;
  info.software = recording->software_version;
  info.topics = std::move(recording->topics);
  return info;
}

void take(const RawFrame& frame, Info& info) {
  if (info.frames++ == 0 && frame.acquisition.arrival_utc >= kEarliestClock)
    info.start_utc = frame.acquisition.arrival_utc;
  if (!frame.temperature_celsius || std::isnan(*frame.temperature_celsius)) return;
  const double celsius = *frame.temperature_celsius;
  auto& range = info.temperature_celsius;
  if (!range) range.emplace(celsius, celsius);
  range = {std::min(range->first, celsius), std::max(range->second, celsius)};
}

/// Reads all frames.
Result<Info> info_of_frames(const std::string& path, FrameFormat format) {
  const bool is_timed = format != FrameFormat::npy;
  const Result<std::unique_ptr<FrameSource>> source =
      recordings::open_frames(path, {.rate_hz = is_timed ? std::nullopt : std::optional(1e3)});
  if (!source) return source.error();
  Result<recordings::FrameNotes> notes = recordings::read_frame_notes(path);
  if (!notes) return notes.error();
  Info info;
  info.notes = std::move(*notes);
  info.shape = (*source)->shape();
  RawFrame frame;
  Nanos first{};
  while (true) {
    const Result<bool> more = (*source)->next(frame);
    if (!more) return more.error();
    if (!*more) break;
    if (info.frames == 0) first = frame.time;
    take(frame, info);
  }
  if (is_timed) info.duration_s = std::chrono::duration<double>(info.frames > 0 ? frame.time - first : Nanos{}).count();
  if (format == FrameFormat::hdf5) info.lost = (*source)->statistics().lost_frames;
  return info;
}

Result<Info> info_of(const std::string& path) {
  const Result<FrameFormat> format = recordings::recognise_frames(path);
  if (!format) return format.error();
  Result<Info> info = *format == FrameFormat::mcap ? info_of_recording(path) : info_of_frames(path, *format);
  if (!info) return info;
  info->format = to_string(*format);
  std::error_code is_no_file;
  const std::uintmax_t bytes = std::filesystem::file_size(path, is_no_file);
  if (!is_no_file) info->bytes = bytes;
  return info;
}

/// Of one array: several have rates of their own.
std::optional<double> rate_hz(const Info& info) {
  if (!info.arrays.empty()) return std::nullopt;
  if (!info.duration_s || !(*info.duration_s > 0.0) || info.frames < 2) return std::nullopt;
  return static_cast<double>(info.frames - 1) / *info.duration_s;
}

/// "2026-11-21T22:15:03.250Z"
std::string utc_text(Nanos since_1970) {
  const auto millis = std::chrono::floor<std::chrono::milliseconds>(since_1970);
  const auto seconds = std::chrono::floor<std::chrono::seconds>(millis);
  const std::chrono::sys_days day(std::chrono::floor<std::chrono::days>(seconds));
  const std::chrono::year_month_day date(day);
  const auto time = seconds - std::chrono::floor<std::chrono::days>(seconds);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), time.count() / 3600,
                     time.count() / 60 % 60, time.count() % 60, (millis - seconds).count());
}

using Json = nlohmann::ordered_json;

template <typename T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

Json array_json(const recordings::RecordedArrayInfo& array) {
  return {{"name", array.name},
          {"rows", array.shape ? Json(array.shape->rows) : Json(nullptr)},
          {"cols", array.shape ? Json(array.shape->cols) : Json(nullptr)},
          {"frames", array.frames},
          {"lost", array.lost},
          {"array_toml", or_null(array.array_toml)},
          {"model_hash", or_null(array.model_hash)}};
}

void print_json(const std::string& file, const Info& info) {
  Json json = {{"file", file},
               {"format", info.format},
               {"size_bytes", info.bytes},
               {"frames", info.frames},
               {"duration_s", or_null(info.duration_s)},
               {"rate_hz", or_null(rate_hz(info))},
               {"start_utc", or_null(info.start_utc ? utc_text(*info.start_utc) : std::string())},
               {"rows", info.shape ? Json(info.shape->rows) : Json(nullptr)},
               {"cols", info.shape ? Json(info.shape->cols) : Json(nullptr)},
               {"lost", or_null(info.lost)},
               {"complete", info.complete},
               {"temperature_celsius", or_null(info.temperature_celsius)},
               {"name", or_null(info.notes.name)},
               {"array_toml", or_null(info.notes.array_toml)},
               {"model_hash", or_null(info.notes.model_hash)},
               {"compression", or_null(info.compression)},
               {"software", or_null(info.software)},
               {"arrays", Json::array()},
               {"topics", Json::array()}};
  for (const recordings::RecordedArrayInfo& array : info.arrays) json["arrays"].push_back(array_json(array));
  for (const recordings::RecordingTopic& topic : info.topics) {
    json["topics"].push_back({{"name", topic.name}, {"type", topic.type}, {"messages", topic.messages}});
  }
  fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

void print_line(const char* what, const std::string& value) {
  if (!value.empty()) fmt::print("{:<14}{}\n", what, value);
}

/// "chest  16x16  1000 frames, 0 lost (with its description), model fnv1a64:..."
std::string array_text(const recordings::RecordedArrayInfo& array) {
  std::string text = array.name;
  if (array.shape) text += fmt::format("  {}x{}", array.shape->rows, array.shape->cols);
  text += fmt::format("  {} frames, {} lost", array.frames, array.lost);
  if (!array.array_toml.empty()) text += " (with its description)";
  if (!array.model_hash.empty()) text += ", model " + array.model_hash;
  return text;
}

void print_text(const Info& info) {
  print_line("format", info.format + (info.compression.empty() ? "" : ", " + info.compression));
  print_line("size", fmt::format("{} bytes", info.bytes));
  print_line("frames", std::to_string(info.frames));
  if (info.shape) print_line("taxels", fmt::format("{}x{}", info.shape->rows, info.shape->cols));
  print_line("duration", info.duration_s ? fmt::format("{:.3f} s", *info.duration_s) : "not known: no times");
  if (const std::optional<double> rate = rate_hz(info)) print_line("rate", fmt::format("{:.3f} Hz", *rate));
  if (info.start_utc) print_line("start", utc_text(*info.start_utc));
  if (info.lost) print_line("lost", fmt::format("{} frames", *info.lost));
  print_line("complete", info.complete ? "yes" : "no: 'dermis recover' makes it so");
  if (info.temperature_celsius) {
    print_line("temperature",
               fmt::format("{:.2f} to {:.2f} C", info.temperature_celsius->first, info.temperature_celsius->second));
  }
  for (const recordings::RecordedArrayInfo& array : info.arrays) print_line("array", array_text(array));
  print_line("array", info.notes.name + (info.notes.array_toml.empty() ? "" : " (with its description)"));
  print_line("model", info.notes.model_hash);
  print_line("software", info.software);
  for (const recordings::RecordingTopic& topic : info.topics) {
    fmt::print("{:<14}{}  {}  {} messages\n", "topic", topic.name, topic.type, topic.messages);
  }
}

Status print_info(const InfoOptions& options) {
  const Result<Info> info = info_of(options.file);
  if (!info) return info.error();
  if (options.json) {
    print_json(options.file, *info);
  } else {
    print_text(*info);
  }
  return Done{};
}

}  // namespace

void add_info(Command& command) {
  auto options = std::make_shared<InfoOptions>();
  command.option("file", options->file, ".mcap, .csv, .h5, .hdf5 or .npy").required();
  command.flag("--json", options->json, "As JSON");
  command.action([options] { return print_info(*options); });
}

}  // namespace dermis::app
