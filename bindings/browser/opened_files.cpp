// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bindings/browser/opened_files.hpp"

#include <memory>
#include <utility>
#include <vector>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/files/frames_csv.hpp"
#include "dermis/bytes/files/npy.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/learn/calibration/uncalibrated_model.hpp"
#include "dermis/live/suits/playback.hpp"
#include "out/serve/session/open_playback.hpp"
#include "out/serve/session/topic_name.hpp"

namespace dermis::browser {
namespace {

using bytes::recordings::RecordedArray;
using out::serve::ServedArray;
using out::serve::ServedSuit;

constexpr double kNpyHz = 100.0;  // a .npy has no times

FrameShape shape_of(const ArrayDescription& array) {
  return {array.rows, array.cols};
}

OpenedArray uncalibrated(const std::string& path, const ArrayDescription& array) {
  return {path, learn::calibration::uncalibrated_model(array), array};
}

Result<OpenedArray> calibrated(const std::string& path, Result<touch::pipeline::Model> model) {
  if (!model) return model.error();
  ArrayDescription array = model->array;
  return OpenedArray{path, *std::move(model), std::move(array)};
}

/// That the recording holds.
Result<OpenedArray> recorded_array(const std::string& path, const RecordedArray& recorded) {
  if (!recorded.model_file.empty()) {
    return calibrated("", bytes::models::model_from_bytes(recorded.model_file, path + ": its model"));
  }
  if (recorded.array_toml.empty()) {
    return bad_input(path + ": does not say what array it is of; open its model or array.toml first");
  }
  Result<ArrayDescription> array = bytes::files::array_from_toml(recorded.array_toml, path);
  if (!array) return array.error();
  return uncalibrated("", *array);
}

Result<ServedArray> served(const std::string& name, const OpenedArray& array) {
  Result<ArraySurface> surface = ArraySurface::create(array.model.array);
  if (!surface) return surface.error();
  return ServedArray{.name = out::serve::topic_name(name.empty() ? array.description.name : name),
                     .source = nullptr,
                     .model = std::make_shared<const touch::pipeline::Model>(array.model),
                     .surface = *std::move(surface),
                     .description = array.description,
                     .model_path = array.path};
}

Result<std::unique_ptr<FrameSource>> open_table(const std::string& path, FrameShape shape) {
  if (path.ends_with(".npy")) {
    auto reader = bytes::files::NpyReader::open(path, {.rate_hz = kNpyHz, .shape = shape});
    if (!reader) return reader.error();
    return std::unique_ptr<FrameSource>(*std::move(reader));
  }
  auto reader = bytes::files::FramesCsvReader::open(path, shape);
  if (!reader) return reader.error();
  return std::unique_ptr<FrameSource>(*std::move(reader));
}

Status copy_frames(FrameSource& from, bytes::recordings::SuitRecordingWriter& to) {
  RawFrame frame;
  while (true) {
    const Result<bool> more = from.next(frame);
    if (!more) return more.error();
    if (!*more) return to.commit();
    if (Status written = to.write(0, frame); !written) return written;
  }
}

/// Damage, and a compression that cannot be read, show with the first frame.
Status check_first_frame(const std::string& path) {
  const auto reader = bytes::recordings::SuitRecordingReader::open(path);
  if (!reader) return reader.error();
  std::size_t array = 0;
  RawFrame frame;
  const Result<bool> read = (*reader)->next(array, frame);
  return read ? Status(Done{}) : read.error();
}

/// Writes the recording of a table; its path.
Result<std::string> recording_of_table(const std::string& path, const ArrayDescription& array) {
  Result<std::unique_ptr<FrameSource>> frames = open_table(path, shape_of(array));
  if (!frames) return frames.error();
  RecordedArray recorded;
  recorded.name = array.name;
  recorded.shape = shape_of(array);
  recorded.array_toml = bytes::files::array_to_toml(array);
  recorded.pitch = {array.row_pitch_m, array.col_pitch_m};
  const std::string made = path + ".mcap";
  const auto writer = bytes::recordings::SuitRecordingWriter::create(made, {recorded}, {.live = false});
  if (!writer) return writer.error();
  if (Status copied = copy_frames(**frames, **writer); !copied) return copied.error();
  return made;
}

}  // namespace

bool is_recording(const std::string& path) {
  return path.ends_with(".mcap") || path.ends_with(".csv") || path.ends_with(".npy");
}

Result<OpenedArray> open_array(const std::string& path) {
  if (!path.ends_with(".toml")) return calibrated(path, bytes::models::read_model(path));
  const Result<ArrayDescription> array = bytes::files::read_array(path);
  if (!array) return array.error();
  return uncalibrated(path, *array);
}

Result<ServedSuit> open_recording(const std::string& path, const std::optional<OpenedArray>& array) {
  if (!path.ends_with(".mcap")) {
    if (!array) return bad_input(path + ": does not say what array it is of; open its model or array.toml first");
    const Result<std::string> made = recording_of_table(path, array->description);
    if (!made) return made.error();
    return open_recording(*made, array);
  }
  if (Status readable = check_first_frame(path); !readable) return readable.error();
  const auto playback = live::suits::Playback::open(path);
  if (!playback) return playback.error();
  ServedSuit suit;
  for (const RecordedArray& recorded : (*playback)->arrays()) {
    const bool fits = array && array->shape() == recorded.shape;
    const Result<OpenedArray> known = fits ? Result<OpenedArray>(*array) : recorded_array(path, recorded);
    if (!known) return known.error();
    Result<ServedArray> one = served(recorded.name, *known);
    if (!one) return one.error();
    suit.arrays.push_back(*std::move(one));
  }
  if (Status opened = out::serve::open_playback(path, suit); !opened) return opened.error();
  return suit;
}

}  // namespace dermis::browser
