// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/files/file_kind.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/bytes/recordings/frame_file_info.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/live/buses/bus_address.hpp"
#include "dermis/live/fleet/stream_address.hpp"
#include "dermis/out/report/model_facts.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "described_file.hpp"
#include "shape_options.hpp"
#include "unread_bytes.hpp"

namespace dermis::app {
namespace {

using bytes::recordings::FrameFileInfo;

struct InfoOptions {
  std::string file;
  std::string layout;
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

Json array_json(const bytes::recordings::RecordedArrayInfo& array) {
  return {{"name", array.name},
          {"rows", array.shape ? Json(array.shape->rows) : Json(nullptr)},
          {"cols", array.shape ? Json(array.shape->cols) : Json(nullptr)},
          {"frames", array.frames},
          {"lost", array.lost},
          {"array_toml", or_null(array.array_toml)},
          {"model_hash", or_null(array.model_hash)},
          {"simulation", or_null(array.simulation)}};
}

void print_json(const Json& json) {
  fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

void print_json(const std::string& file, const std::string& format, const FrameFileInfo& info,
                const std::string& look) {
  Json json = {{"file", file},
               {"format", format},
               {"size_bytes", info.bytes},
               {"frames", info.frames},
               {"duration_s", or_null(info.duration_s)},
               {"rate_hz", or_null(info.rate_hz())},
               {"start_utc", or_null(info.start_utc ? utc_text(*info.start_utc) : std::string())},
               {"rows", info.shape ? Json(info.shape->rows) : Json(nullptr)},
               {"cols", info.shape ? Json(info.shape->cols) : Json(nullptr)},
               {"lost", or_null(info.lost)},
               {"complete", info.complete},
               {"doubts", info.doubts},
               {"unread", or_null(info.unread)},
               {"or", or_null(look)},
               {"temperature_celsius", or_null(info.temperature_celsius)},
               {"name", or_null(info.notes.name)},
               {"array_toml", or_null(info.notes.array_toml)},
               {"model_hash", or_null(info.notes.model_hash)},
               {"simulation", or_null(info.notes.simulation)},
               {"compression", or_null(info.compression)},
               {"software", or_null(info.software)},
               {"arrays", Json::array()},
               {"topics", Json::array()}};
  for (const bytes::recordings::RecordedArrayInfo& array : info.arrays) json["arrays"].push_back(array_json(array));
  for (const bytes::recordings::RecordingTopic& topic : info.topics) {
    json["topics"].push_back({{"name", topic.name}, {"type", topic.type}, {"messages", topic.messages}});
  }
  print_json(json);
}

std::string mend_of(const FrameFileInfo& info) {
  const bool is_recording = info.format == bytes::recordings::FrameFormat::mcap;
  return is_recording ? "'dermis info recover' makes it so" : "its last frame is cut off";
}

void print_line(const char* what, const std::string& value) {
  if (!value.empty()) fmt::print("{:<14}{}\n", what, value);
}

/// "fnv1a64:... (with its file)"
std::string model_text(const std::string& hash, const std::string& file) {
  return file.empty() ? hash : hash + " (with its file)";
}

/// "chest  16x16  1000 frames, 0 lost (with its description), model fnv1a64:..."
std::string array_text(const bytes::recordings::RecordedArrayInfo& array) {
  std::string text = array.name;
  if (array.shape) text += fmt::format("  {}x{}", array.shape->rows, array.shape->cols);
  text += fmt::format("  {} frames, {} lost", array.frames, array.lost);
  if (!array.array_toml.empty()) text += " (with its description)";
  if (!array.model_hash.empty()) text += ", model " + model_text(array.model_hash, array.model_file);
  if (!array.simulation.empty()) text += ", simulated: " + array.simulation;
  return text;
}

void print_text(const std::string& format, const FrameFileInfo& info) {
  print_line("format", format + (info.compression.empty() ? "" : ", " + info.compression));
  if (info.bytes > 0) print_line("size", fmt::format("{} bytes", info.bytes));
  print_line("frames", std::to_string(info.frames));
  if (info.shape) print_line("taxels", fmt::format("{}x{}", info.shape->rows, info.shape->cols));
  print_line("duration", info.duration_s ? fmt::format("{:.3f} s", *info.duration_s) : "not known: no times");
  if (const std::optional<double> rate = info.rate_hz()) print_line("rate", fmt::format("{:.3f} Hz", *rate));
  for (const std::string& doubt : info.doubts) print_line("doubt", doubt);
  if (info.start_utc) print_line("start", utc_text(*info.start_utc));
  if (info.lost) print_line("lost", fmt::format("{} frames", *info.lost));
  print_line("complete", info.complete ? "yes" : "no: " + mend_of(info));
  print_line("unread", info.unread);
  if (info.temperature_celsius) {
    print_line("temperature",
               fmt::format("{:.2f} to {:.2f} C", info.temperature_celsius->first, info.temperature_celsius->second));
  }
  for (const bytes::recordings::RecordedArrayInfo& array : info.arrays) print_line("array", array_text(array));
  print_line("array", info.notes.name + (info.notes.array_toml.empty() ? "" : " (with its description)"));
  print_line("model", model_text(info.notes.model_hash, info.notes.model_file));
  print_line("simulated", info.notes.simulation);
  print_line("software", info.software);
  for (const bytes::recordings::RecordingTopic& topic : info.topics) {
    fmt::print("{:<14}{}  {}  {} messages\n", "topic", topic.name, topic.type, topic.messages);
  }
}

/// `look`: what the bytes may be, too; empty where nothing is seen in them.
void print(const InfoOptions& options, const std::string& format, const FrameFileInfo& info,
           const std::string& look = {}) {
  if (options.json) return print_json(options.file, format, info, look);
  print_text(format, info);
  print_line("or", look);
}

/// A model or an array.toml, and what to call it.
struct Described {
  const char* format;
  ArrayDescription array;
  std::vector<out::report::Fact> calibration{};
};

/// Reads a file that is a description by its content; empty for any other.
Result<std::optional<Described>> read_described(const std::string& path) {
  constexpr std::size_t kLooked = 4096;
  const std::string_view kind = bytes::files::kind_of(bytes::files::first_bytes_of(path, kLooked));
  if (bytes::recordings::frame_format(path)) return std::optional<Described>();
  if (kind == bytes::files::kTomlKind) {
    Result<ArrayDescription> array = bytes::files::read_array(path);
    if (!array) return array.error();
    return std::optional(Described{"description of an array", *std::move(array)});
  }
  if (kind != bytes::files::kSafetensorsKind) return std::optional<Described>();
  const Result<touch::pipeline::Model> model = bytes::models::read_model(path);
  if (!model) return model.error();
  return std::optional(Described{"model", model->array, out::report::calibration_facts(*model)});
}

Json json_of(const std::vector<out::report::Fact>& facts) {
  Json json = Json::object();
  for (const auto& [name, text] : facts) json[name] = text;
  return json;
}

void print_described(const InfoOptions& options, const Described& described) {
  const std::vector<out::report::Fact> array = out::report::array_facts(described.array);
  if (options.json) {
    const Json json = {{"file", options.file},
                       {"format", described.format},
                       {"array", json_of(array)},
                       {"calibration", json_of(described.calibration)},
                       {"array_toml", bytes::files::array_to_toml(described.array)}};
    return print_json(json);
  }
  constexpr const char* kWide = "{:<25}{}\n";
  fmt::print(kWide, "format", described.format);
  for (const auto& [name, text] : array) fmt::print(kWide, name, text);
  for (const auto& [name, text] : described.calibration) fmt::print(kWide, name, text);
}

Error with_look(Error error, const std::string& file) {
  const std::string look = look_of_unread_file(file);
  if (!look.empty()) error.message += ". " + look;
  return error;
}

/// Numbers without a head are one frame, or many.
std::string other_look(const std::string& file, const FrameFileInfo& info) {
  const bool is_one = info.format == bytes::recordings::FrameFormat::text_matrix && info.frames == 1;
  return is_one ? look_of_unread_file(file) : std::string();
}

Result<FrameFileInfo> info_of_array(const DescribedFile& file, const std::string& array) {
  const Result<std::unique_ptr<FrameSource>> source = file.open(array);
  if (!source) return source.error();
  return bytes::recordings::frame_source_info(**source);
}

/// Frames and losses are sums; times are from the first to the last frame of any.
Result<FrameFileInfo> info_of_arrays(const DescribedFile& file, const std::vector<std::string>& arrays) {
  FrameFileInfo all;
  for (const std::string& array : arrays) {
    const Result<FrameFileInfo> one = info_of_array(file, array);
    if (!one) return bad_input(array + ": " + one.error().message);
    all.frames += one->frames;
    all.lost = all.lost.value_or(0) + one->lost.value_or(0);
    all.duration_s = std::max(all.duration_s, one->duration_s);
    all.doubts.insert(all.doubts.end(), one->doubts.begin(), one->doubts.end());
    bytes::recordings::RecordedArrayInfo& listed = all.arrays.emplace_back();
    listed.name = array;
    listed.shape = one->shape;
    listed.frames = one->frames;
    listed.lost = one->lost.value_or(0);
  }
  return all;
}

/// The same for bytes that a layout describes.
Status print_info(const InfoOptions& options, const DescribedFile& file) {
  const Result<std::vector<std::string>> arrays = file.arrays();
  if (!arrays) return arrays.error();
  const Result<FrameFileInfo> info =
      arrays->size() == 1 ? info_of_array(file, arrays->front()) : info_of_arrays(file, *arrays);
  if (!info) return info.error();
  const char* const what = live::fleet::is_stream_address(options.file) ? "frames of a stream"
                           : live::buses::is_bus_address(options.file)  ? "a log of a bus"
                                                                        : "bytes of a layout";
  print(options, what, *info);
  return Done{};
}

Status print_info(const InfoOptions& options) {
  const Result<std::optional<FrameShape>> shape = options.shape.shape();
  if (!shape) return shape.error();
  const DescribedFile file{.name = options.file, .layout = options.layout, .shape = *shape};
  if (file.is_described()) return print_info(options, file);
  const Result<std::optional<Described>> described = read_described(options.file);
  if (!described) return described.error();
  if (*described) {
    print_described(options, **described);
    return Done{};
  }
  const Result<FrameFileInfo> info = bytes::recordings::frame_file_info(options.file, *shape);
  if (!info) return with_look(info.error(), options.file);
  print(options, bytes::recordings::to_string(info->format), *info, other_look(options.file, *info));
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
  command.input_file("file", options->file, "A file of frames (docs/frame-files.md), a model file, or array.toml")
      .required();
  command.input_file("--layout", options->layout, "layout.toml, which describes the bytes of a file (docs/layouts.md)");
  options->shape.add(command);
  command.flag("--json", options->json, "As JSON");
  command.action([options] { return print_info(*options); });
  Command recover = command.subcommand("recover", "Repair a cut or damaged recording, and say what is lost");
  add_recover(recover);
}

}  // namespace dermis::app
