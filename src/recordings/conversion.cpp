// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/recordings/conversion.hpp"

#include <memory>

#include "dermis/files/array_toml.hpp"
#include "dermis/recordings/recording.hpp"

namespace dermis::recordings {
namespace {

/// What the frames of a file have besides their counts, and the format that is written may have no place for.
struct Extras {
  bool is_timed = false;
  bool has_temperature = false;
  bool has_supply = false;
  bool has_acquisition = false;

  void add(const RawFrame& frame) {
    has_temperature = has_temperature || frame.temperature_celsius;
    has_supply = has_supply || frame.supply_v;
    has_acquisition = has_acquisition || frame.acquisition != Acquisition{};
  }
};

std::vector<std::string> left_out(const Extras& extras, bool has_forces, const FrameNotes& notes, FrameFormat format) {
  std::vector<std::string> names;
  const bool holds_all = format == FrameFormat::mcap || format == FrameFormat::hdf5;
  const bool holds_temperature = holds_all || format == FrameFormat::csv;
  if (extras.is_timed && !has_times(format)) names.emplace_back("times");
  if (extras.has_temperature && !holds_temperature) names.emplace_back("temperature");
  if (extras.has_supply && !holds_temperature) names.emplace_back("supply");
  if (extras.has_acquisition && !holds_all) names.emplace_back("numbers, device times and arrivals of the frames");
  if (!notes.array_toml.empty() && !holds_all) names.emplace_back("the description of the array");
  if (has_forces) names.emplace_back("forces ('dermis run' gives them again)");
  return names;
}

Result<bool> holds_forces(const std::string& path, const ConversionOptions& options) {
  const RecordingPlace place = recording_place(path);
  if (const auto format = frame_format(place.path); !format || *format != FrameFormat::mcap) return false;
  const Result<RecordingInfo> info = recording_info(place.path);
  if (!info) return info.error();
  if (!info->complete && options.notice) {
    options.notice(path + ": was not written to its end; the frames that are there are converted");
  }
  for (const RecordingTopic& topic : info->topics) {
    if (topic.type == messages::grid_type().name && topic.messages > 0) return true;
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

/// All frames of `source`, of which `frame` is the first if there is one.
Status copy(FrameSource& source, RawFrame& frame, bool has_frame, FrameSink& sink, const std::atomic<bool>* stop,
            Extras& extras) {
  while (has_frame) {
    if (stop != nullptr && stop->load()) return failed("stopped; nothing is written");
    extras.add(frame);
    if (Status written = sink.write(frame); !written) return written;
    const Result<bool> more = source.next(frame);
    if (!more) return more.error();
    has_frame = *more;
  }
  return sink.commit();
}

}  // namespace

Result<std::vector<std::string>> convert_frames(const std::string& in, const std::string& out,
                                                const ConversionOptions& options) {
  const Result<FrameFormat> format = output_format(out);
  if (!format) return format.error();
  FrameFileInput input = options.input;
  input.notice = options.notice;
  const Result<std::unique_ptr<FrameSource>> source = open_frames(in, input);
  if (!source) return source.error();
  const Result<FrameNotes> notes = notes_of(in, options.array);
  if (!notes) return notes.error();
  const Result<bool> has_forces = holds_forces(in, options);
  if (!has_forces) return has_forces.error();

  RawFrame frame;
  const Result<bool> has_frame = (*source)->next(frame);
  if (!has_frame) return has_frame.error();
  const std::optional<FrameShape> shape = (*source)->shape();
  if (!shape) return bad_input(in + ": has no frames, so that their shape is not known");
  const Result<std::unique_ptr<FrameSink>> sink = create_frames(out, *shape, *notes);
  if (!sink) return sink.error();
  Extras extras;
  extras.is_timed = !options.input.rate_hz;
  if (Status copied = copy(**source, frame, *has_frame, **sink, options.stop, extras); !copied) return copied.error();
  return left_out(extras, *has_forces, *notes, *format);
}

}  // namespace dermis::recordings
