// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "dermis/files/array_toml.hpp"
#include "dermis/recordings/frame_files.hpp"
#include "dermis/recordings/recording.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

using recordings::FrameFormat;

struct ConvertOptions {
  std::string in;
  std::string out;
  std::string array;
  std::optional<double> rate_hz;
  std::optional<std::size_t> rows;
  std::optional<std::size_t> cols;
};

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

/// What a conversion leaves out.
std::vector<std::string> left_out(const Extras& extras, bool has_forces, const recordings::FrameNotes& notes,
                                  FrameFormat format) {
  std::vector<std::string> names;
  const bool holds_all = format == FrameFormat::mcap || format == FrameFormat::hdf5;
  const bool holds_temperature = holds_all || format == FrameFormat::csv;
  if (extras.is_timed && format == FrameFormat::npy) names.emplace_back("times");
  if (extras.has_temperature && !holds_temperature) names.emplace_back("temperature");
  if (extras.has_supply && !holds_temperature) names.emplace_back("supply");
  if (extras.has_acquisition && !holds_all) names.emplace_back("numbers, device times and arrivals of the frames");
  if (!notes.array_toml.empty() && !holds_all) names.emplace_back("the description of the array");
  if (has_forces) names.emplace_back("forces ('dermis run' gives them again)");
  return names;
}

Result<bool> holds_forces(const std::string& path) {
  const recordings::RecordingPlace place = recordings::recording_place(path);
  if (const auto format = recordings::frame_format(place.path); !format || *format != FrameFormat::mcap) return false;
  const Result<recordings::RecordingInfo> info = recordings::recording_info(place.path);
  if (!info) return info.error();
  if (!info->complete) {
    fmt::print(stderr, "{}: was not written to its end; the frames that are there are converted\n", path);
  }
  for (const recordings::RecordingTopic& topic : info->topics) {
    if (topic.type == messages::grid_type().name && topic.messages > 0) return true;
  }
  return false;
}

Result<recordings::FrameNotes> notes_of(const ConvertOptions& options, const std::optional<ArrayDescription>& array) {
  Result<recordings::FrameNotes> notes = recordings::read_frame_notes(options.in);
  if (!notes || !array) return notes;
  notes->name = array->name;
  notes->array_toml = files::array_to_toml(*array);
  return notes;
}

Status check(const ConvertOptions& options) {
  const Result<FrameFormat> in = recordings::frame_format(recordings::recording_place(options.in).path);
  if (!in) return in.error();
  const Result<FrameFormat> out = recordings::frame_format(options.out);
  if (!out) return out.error();
  if (options.rate_hz && *in != FrameFormat::npy) {
    return bad_input(fmt::format("--rate: '{}' has times of its own; leave --rate out", options.in));
  }
  if (options.rate_hz && !(*options.rate_hz > 0.0 && *options.rate_hz <= 1e9)) {
    return bad_input("--rate: must be more than 0 and at most 1e9 frames a second");
  }
  const bool is_shape_wrong = (options.rows && (*options.rows < 1 || *options.rows > kMaxLines)) ||
                              (options.cols && (*options.cols < 1 || *options.cols > kMaxLines));
  if (is_shape_wrong) return bad_input(fmt::format("--rows, --cols: must be 1 to {}", kMaxLines));
  return Done{};
}

/// The shape that the frames must have, where one is given.
Result<std::optional<FrameShape>> wanted_shape(const ConvertOptions& options,
                                               const std::optional<ArrayDescription>& array) {
  std::optional<FrameShape> shape;
  if (options.rows) shape = FrameShape{*options.rows, *options.cols};
  if (!array) return shape;
  const FrameShape of_array{array->rows, array->cols};
  if (shape && *shape != of_array) {
    return bad_input(fmt::format("--rows, --cols: {} has {}x{} taxels", options.array, array->rows, array->cols));
  }
  return std::optional(of_array);
}

Result<std::optional<ArrayDescription>> read_array(const ConvertOptions& options) {
  if (options.array.empty()) return std::optional<ArrayDescription>();
  Result<ArrayDescription> array = files::read_array(options.array);
  if (!array) return array.error();
  return std::optional(std::move(*array));
}

/// All frames of `source`, of which `frame` is the first if there is one.
Status copy(FrameSource& source, RawFrame& frame, bool has_frame, FrameSink& sink, Extras& extras) {
  while (has_frame) {
    if (stop_flag()) return failed("stopped; nothing is written");
    extras.add(frame);
    if (Status written = sink.write(frame); !written) return written;
    const Result<bool> more = source.next(frame);
    if (!more) return more.error();
    has_frame = *more;
  }
  return sink.commit();
}

Status convert(const ConvertOptions& options) {
  static_cast<void>(stop_flag());
  if (Status checked = check(options); !checked) return checked;
  const Result<std::optional<ArrayDescription>> array = read_array(options);
  if (!array) return array.error();
  const Result<std::optional<FrameShape>> wanted = wanted_shape(options, *array);
  if (!wanted) return wanted.error();
  const Result<std::unique_ptr<FrameSource>> source =
      recordings::open_frames(options.in, {.shape = *wanted, .rate_hz = options.rate_hz});
  if (!source) return source.error();
  const Result<recordings::FrameNotes> notes = notes_of(options, *array);
  if (!notes) return notes.error();
  const Result<bool> has_forces = holds_forces(options.in);
  if (!has_forces) return has_forces.error();

  RawFrame frame;
  const Result<bool> has_frame = (*source)->next(frame);
  if (!has_frame) return has_frame.error();
  const std::optional<FrameShape> shape = (*source)->shape();
  if (!shape) return bad_input(options.in + ": has no frames, so that their shape is not known");
  const Result<std::unique_ptr<FrameSink>> sink = recordings::create_frames(options.out, *shape, *notes);
  if (!sink) return sink.error();
  Extras extras;
  extras.is_timed = !options.rate_hz;
  if (Status copied = copy(**source, frame, *has_frame, **sink, extras); !copied) return copied;
  const std::vector<std::string> names = left_out(extras, *has_forces, *notes, *recordings::frame_format(options.out));
  if (!names.empty()) fmt::print(stderr, "{}: left out: {}\n", options.out, fmt::join(names, ", "));
  return Done{};
}

}  // namespace

void add_convert(Command& command) {
  auto options = std::make_shared<ConvertOptions>();
  command.option("in", options->in, ".csv, .mcap, .h5, .hdf5 (of dermis or WiReSens) or .npy").required();
  command.option("out", options->out, "The same, or .wiresens.hdf5").required();
  command.option("--array", options->array, "array.toml, to keep with the frames (.mcap, .h5)");
  command.option("--rate", options->rate_hz, "Frames a second of a .npy file, which has no times [Hz]");
  const Option rows =
      command
          .option("--rows", options->rows, "Rows of the frames: checked, and needed for a .npy file of two dimensions")
          .not_negative();
  const Option cols = command.option("--cols", options->cols, "Columns of the frames").not_negative().needs(rows);
  rows.needs(cols);
  command.action([options] { return convert(*options); });
}

}  // namespace dermis::app
