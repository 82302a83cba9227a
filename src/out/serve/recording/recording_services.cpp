// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recording/recording_services.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "dermis/learn/calibration/uncalibrated_model.hpp"
#include "out/serve/parts/part_makers.hpp"
#include "out/serve/recording/recorded_arrays.hpp"
#include "out/serve/recording/saved_minute.hpp"

namespace dermis::out::serve {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostFileName = 255;
constexpr const char* kMilliseconds = "a whole number of milliseconds since 1970";
constexpr std::uint64_t kMostMilliseconds = 9'000'000'000'000;  // the year 2255; Nanos end soon after

/// {"from_ms", "to_ms"}; a missing one sets no bound.
Result<Selection> selection_of(const JsonRequest& request) {
  Selection selection{Nanos::min(), Nanos::max()};
  for (const auto& [field, end] : {std::pair("from_ms", &selection.first), std::pair("to_ms", &selection.last)}) {
    const auto time = request.number(field, kMilliseconds);
    if (!time) return time.error();
    if (!*time) continue;
    if (**time > kMostMilliseconds) return bad_field(field, std::string("must be ") + kMilliseconds);
    *end = std::chrono::milliseconds(**time);
  }
  return selection;
}

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

}  // namespace

RecordingServices::RecordingServices(const ServedSuit& suit, const SessionOptions& options, SuitRecorder::Arrays arrays,
                                     const ModelsInUse& models, SuitRecorder& recorder, websocket::Server& server,
                                     std::optional<PlayedRecording::PlayedSuit> played)
    : folder_(options.record.empty() ? options.recordings : options.record),
      arrays_(std::move(arrays)),
      models_(models),
      recorder_(recorder),
      server_(server),
      last_minute_(suit.arrays.size()) {
  if (played) player_.emplace(options, *std::move(played));
}

std::vector<websocket::Service> RecordingServices::services() {
  std::vector<websocket::Service> services = {service("/recordings/begin", *this, &RecordingServices::begin),
                                              service("/recordings/list", *this, &RecordingServices::list),
                                              service("/recordings/save", *this, &RecordingServices::save)};
  if (player_) services.push_back(service("/recordings/play", *this, &RecordingServices::play));
  return services;
}

std::vector<LiveParameter> RecordingServices::parameters() {
  return {{.name = "/recording",
           .value = [this] { return recorder_.recording(); },
           .set_switch = [this](bool on, const std::string&) { return switch_recorder(on); }},
          {.name = "/recording/file", .value = [this] { return recorder_.path(); }}};
}

Status RecordingServices::switch_recorder(bool on) {
  if (!on) recorder_.stop();
  if (!on || recorder_.recording()) return Done{};
  return recorder_.begin();
}

void RecordingServices::keep(std::size_t array, const RawFrame& frame) {
  recorder_.write(array, frame);
  last_minute_.keep(array, frame);
}

Result<std::string> RecordingServices::begin(const JsonRequest& request) {
  const Result<std::string> name = request.file_name("name");
  if (!name) return name.error();
  const Result<std::string> path = folder_.new_path(*name, ".mcap");
  if (!path) return path.error();
  if (Status begun = recorder_.begin(*path); !begun) return begun.error();
  server_.parameters_changed();
  return json_text(ordered_json{{"file", file_name(*path)}});
}

/// From now on, clients may also save what it names.
Result<std::string> RecordingServices::list(const JsonRequest& /*request*/) {
  ordered_json answer;
  answer["folder"] = absolute_path(folder_.path());
  answer["recording"] = recorder_.recording() ? file_name(recorder_.path()) : "";
  answer["files"] = ordered_json::array();
  for (const SavedFile& file : folder_.recordings()) {
    answer["files"].push_back({{"name", file.name}, {"bytes", file.bytes}, {"changed_s", file.changed_s}});
    give((std::filesystem::path(folder_.path()) / file.name).string());
  }
  return json_text(answer);
}

void RecordingServices::give(const std::string& path) {
  server_.set_file("/recordings/" + file_name(path), path);
}

Result<std::string> RecordingServices::play(const JsonRequest& request) {
  const Result<std::string> name = request.text("name", kMostFileName);
  if (!name) return name.error();
  const Result<std::string> path = folder_.recording(*name);
  if (!path) return path.error();
  const Result<std::uint16_t> port = player_->play(*path);
  if (!port) return port.error();
  return json_text(ordered_json{{"port", *port}});
}

/// {"array": "chest"} is a frames.csv of that array, and its forces where it is calibrated; without it all are in a
/// recording.
Result<std::string> RecordingServices::save(const JsonRequest& request) {
  const Result<Selection> selection = selection_of(request);
  if (!selection) return selection.error();
  const Result<std::string> name = request.text("array");
  if (!name) return name.error();
  const std::vector<bytes::recordings::RecordedArray> arrays = arrays_();
  if (name->empty()) {
    const std::string path = path_of("cut.mcap");
    const Result<std::size_t> frames = save_recording(last_minute_, arrays, *selection, path);
    if (!frames) return frames.error();
    give(path);
    return json_text(ordered_json{{"file", file_name(path)}, {"frames", *frames}});
  }
  const auto array = std::ranges::find(arrays, *name, &bytes::recordings::RecordedArray::name);
  if (array == arrays.end()) return bad_field("array", "there is none of that name");
  return save_array(static_cast<std::size_t>(array - arrays.begin()), *array, *selection);
}

/// Forces that cannot be written leave the counts saved.
Result<std::string> RecordingServices::save_array(std::size_t array, const bytes::recordings::RecordedArray& recorded,
                                                  const Selection& selection) {
  const Result<std::vector<RawFrame>> frames = selected_frames(last_minute_, array, selection);
  if (!frames) return frames.error();
  const std::string path = path_of(recorded.name + ".csv");
  if (Status saved = save_csv(*frames, recorded.shape, path); !saved) return saved.error();
  give(path);
  ordered_json answer{{"file", file_name(path)}, {"frames", frames->size()}};
  const std::shared_ptr<const touch::pipeline::Model> model = models_.of(array);
  if (learn::calibration::is_uncalibrated(*model)) return json_text(answer);
  const std::string forces = std::filesystem::path(path).replace_extension().string() + "-newtons.csv";
  if (Status saved = save_forces(*frames, *model, forces); !saved) {
    answer["forces_error"] = saved.error().message;
    return json_text(answer);
  }
  give(forces);
  answer["forces"] = file_name(forces);
  return json_text(answer);
}

/// A new one in the folder of the recordings.
std::string RecordingServices::path_of(const std::string& wanted) const {
  return recording_name((std::filesystem::path(folder_.path()) / wanted).string(), false,
                        std::chrono::system_clock::now());
}

Result<std::unique_ptr<Part>> make_recording(Host& host) {
  const auto arrays = [&host] { return recorded_arrays(host.suit, host.models); };
  const auto played = [&host](const std::string& recording) -> Result<ServedSuit> {
    Result<ServedSuit> suit = played_suit(host.suit, recording);
    if (!suit) return suit;
    for (std::size_t k = 0; k < suit->arrays.size(); ++k) {
      if (!suit->arrays[k].played) suit->arrays[k].model = host.models.of(k);
    }
    return suit;
  };
  // A played recording cannot play another one.
  std::optional<PlayedRecording::PlayedSuit> player;
  if (!host.suit.playback) player = played;
  return std::unique_ptr<Part>(std::make_unique<RecordingServices>(host.suit, host.options, arrays, host.models,
                                                                   host.recorder, host.server, std::move(player)));
}

}  // namespace dermis::out::serve
