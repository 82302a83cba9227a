// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/conversion.hpp"

#include <algorithm>
#include <memory>

#include "bytes/recordings/described_sensors.hpp"
#include "bytes/recordings/format_rows.hpp"
#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/recordings/recording.hpp"

namespace dermis::bytes::recordings {
namespace {

/// The data of a file's frames besides their counts, for which the written format may have no place.
struct Extras {
  bool is_timed = false;
  bool has_temperature = false;
  std::size_t kept_sensors = 0;  ///< Those of the first frame, or as many as the array is said to have.
  std::size_t most_sensors = 0;
  bool has_supply = false;
  bool has_acquisition = false;

  void add(const RawFrame& frame) {
    has_temperature = has_temperature || frame.temperature_celsius;
    most_sensors = std::max(most_sensors, frame.sensor_celsius.size());
    has_supply = has_supply || frame.supply_v;
    has_acquisition = has_acquisition || frame.acquisition != Acquisition{};
  }
};

std::vector<std::string> left_out(const Extras& extras, bool has_forces, const FrameNotes& notes, FrameFormat format) {
  std::vector<std::string> names;
  const Holds holds = row_of(format).holds;
  const bool holds_all = holds == Holds::all;
  const bool holds_temperature = holds != Holds::counts;
  if (extras.is_timed && !has_times(format)) names.emplace_back("times");
  if (extras.has_temperature && !holds_temperature) names.emplace_back("temperature");
  if (extras.most_sensors > 0 && !holds_temperature) names.emplace_back("temperatures of several sensors");
  if (extras.most_sensors > extras.kept_sensors && format == FrameFormat::csv) {
    names.emplace_back("temperatures of the sensors that the first frame lacks");
  }
  if (extras.has_supply && !holds_temperature) names.emplace_back("supply");
  if (extras.has_acquisition && !holds_all) names.emplace_back("numbers, device times and arrivals of the frames");
  if (!notes.array_toml.empty() && !holds_all) names.emplace_back("the description of the array");
  if (has_forces) names.emplace_back("forces (the model gives them again)");
  return names;
}

Result<bool> holds_forces(const std::string& path) {
  const RecordingPlace place = recording_place(path);
  if (const auto format = frame_format(place.path); !format || *format != FrameFormat::mcap) return false;
  const Result<RecordingInfo> info = recording_info(place.path);
  if (!info) return info.error();
  for (const RecordingTopic& topic : info->topics) {
    if (topic.type == ros_messages::grid_type().name && topic.messages > 0) return true;
  }
  return false;
}

Result<FrameNotes> notes_of(const std::string& path, const ArrayDescription* array) {
  Result<FrameNotes> notes = read_frame_notes(path);
  if (!notes || array == nullptr) return notes;
  notes->name = array->name;
  notes->array_toml = files::array_to_toml(*array);
  return notes;
}

/// How the frames are read: no rate is asked for that is written nowhere.
FrameFileInput input_of(const ConversionOptions& options, FrameFormat in, FrameFormat out) {
  FrameFileInput input = options.input;
  if (!has_times(in) && !has_times(out) && !input.rate_hz) input.rate_hz = 1.0;
  return input;
}

/// All frames of `source`, of which `frame` is the first.
Status copy(FrameSource& source, RawFrame& frame, FrameSink& sink, const std::atomic<bool>* stop, Extras& extras) {
  for (;;) {
    if (stop != nullptr && stop->load()) return failed("stopped; nothing is written");
    extras.add(frame);
    if (Status written = sink.write(frame); !written) return written;
    const Result<bool> more = source.next(frame);
    if (!more) return more.error();
    if (!*more) return sink.commit();
  }
}

Status write_all(FrameSource& source, const std::string& out, const FrameNotes& notes, const std::atomic<bool>* stop,
                 Extras& extras) {
  RawFrame frame;
  const Result<bool> has_frame = source.next(frame);
  if (!has_frame) return has_frame.error();
  if (!*has_frame) return failed("stopped; nothing is written");
  extras.kept_sensors = std::max(described_sensors(notes), frame.sensor_celsius.size());
  const Result<std::unique_ptr<FrameSink>> sink = create_frames(out, *source.shape(), notes);
  if (!sink) return sink.error();
  return copy(source, frame, **sink, stop, extras);
}

}  // namespace

Result<std::vector<std::string>> convert_frames(const std::string& in, const std::string& out,
                                                const ConversionOptions& options) {
  const Result<FrameFormat> format = output_format(out);
  if (!format) return format.error();
  const Result<FrameFormat> in_format = recognise_frames(in);
  if (!in_format) return in_format.error();
  const Result<std::unique_ptr<FrameSource>> source = open_frames(in, input_of(options, *in_format, *format));
  if (!source) return source.error();
  const Result<FrameNotes> notes = notes_of(in, options.array);
  if (!notes) return notes.error();
  const Result<bool> has_forces = holds_forces(in);
  if (!has_forces) return has_forces.error();

  Extras extras;
  extras.is_timed = has_times(*in_format);
  if (Status copied = write_all(**source, out, *notes, options.stop, extras); !copied) return copied.error();
  return left_out(extras, *has_forces, *notes, *format);
}

Result<std::vector<std::string>> convert_frames(FrameSource& source, bool is_timed, const std::string& out,
                                                const ConversionOptions& options) {
  const Result<FrameFormat> format = output_format(out);
  if (!format) return format.error();
  if (!is_timed && has_times(*format)) return bad_input("the frames have no times: give a rate");
  FrameNotes notes;
  if (options.array != nullptr) notes = {options.array->name, files::array_to_toml(*options.array)};
  Extras extras;
  extras.is_timed = is_timed;
  if (Status copied = write_all(source, out, notes, options.stop, extras); !copied) return copied.error();
  return left_out(extras, false, notes, *format);
}

}  // namespace dermis::bytes::recordings
