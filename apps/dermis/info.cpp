// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "commands.hpp"
#include "dermis/recordings/frame_file_info.hpp"
#include "shape_options.hpp"

namespace dermis::app {
namespace {

using recordings::FrameFileInfo;

struct InfoOptions {
  std::string file;
  ShapeOptions shape;
  bool json = false;
};

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

void print_json(const std::string& file, const FrameFileInfo& info) {
  Json json = {{"file", file},
               {"format", recordings::to_string(info.format)},
               {"size_bytes", info.bytes},
               {"frames", info.frames},
               {"duration_s", or_null(info.duration_s)},
               {"rate_hz", or_null(info.rate_hz())},
               {"start_utc", or_null(info.start_utc ? utc_text(*info.start_utc) : std::string())},
               {"rows", info.shape ? Json(info.shape->rows) : Json(nullptr)},
               {"cols", info.shape ? Json(info.shape->cols) : Json(nullptr)},
               {"lost", or_null(info.lost)},
               {"complete", info.complete},
               {"unread", or_null(info.unread)},
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

std::string mend_of(const FrameFileInfo& info) {
  const bool is_recording = info.format == recordings::FrameFormat::mcap;
  return is_recording ? "'dermis recover' makes it so" : "its last frame is cut off";
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

void print_text(const FrameFileInfo& info) {
  print_line("format", recordings::to_string(info.format) + (info.compression.empty() ? "" : ", " + info.compression));
  print_line("size", fmt::format("{} bytes", info.bytes));
  print_line("frames", std::to_string(info.frames));
  if (info.shape) print_line("taxels", fmt::format("{}x{}", info.shape->rows, info.shape->cols));
  print_line("duration", info.duration_s ? fmt::format("{:.3f} s", *info.duration_s) : "not known: no times");
  if (const std::optional<double> rate = info.rate_hz()) print_line("rate", fmt::format("{:.3f} Hz", *rate));
  if (info.start_utc) print_line("start", utc_text(*info.start_utc));
  if (info.lost) print_line("lost", fmt::format("{} frames", *info.lost));
  print_line("complete", info.complete ? "yes" : "no: " + mend_of(info));
  print_line("unread", info.unread);
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
  const Result<std::optional<FrameShape>> shape = options.shape.shape();
  if (!shape) return shape.error();
  const Result<FrameFileInfo> info = recordings::frame_file_info(options.file, *shape);
  if (!info) return info.error();
  if (options.json) {
    print_json(options.file, *info);
  } else {
    print_text(*info);
  }
  if (info->frames == 0) {
    return bad_input(options.file + ": has no frame" + (info->unread.empty() ? "" : ": " + info->unread));
  }
  if (!info->unread.empty()) return failed(options.file + ": not all frames can be read: " + info->unread);
  if (!info->complete) return failed(options.file + ": is not complete: " + mend_of(*info));
  return Done{};
}

}  // namespace

void add_info(Command& command) {
  auto options = std::make_shared<InfoOptions>();
  command
      .option("file", options->file,
              ".mcap, .csv, .h5, .hdf5, .npy, or a file of another system (docs/file-formats.md)")
      .required();
  options->shape.add(command);
  command.flag("--json", options->json, "As JSON");
  command.action([options] { return print_info(*options); });
}

}  // namespace dermis::app
