// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "commands.hpp"
#include "dermis/bytes/devices/recorder.hpp"
#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/live/forces/frame_output.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "seconds.hpp"
#include "source_options.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"
#include "typed_marks.hpp"
#include "unread_bytes.hpp"

namespace dermis::app {
namespace {

struct RecordOptions {
  std::string from;
  std::string out;
  std::string array;
  std::string model;
  std::optional<std::uint64_t> frames;
  std::optional<double> seconds;
};

/// The array of the frames and what computes their forces, as far as they were given.
struct Known {
  std::optional<ArrayDescription> array;
  std::optional<touch::pipeline::Model> model;
};

Result<Known> read_known(const RecordOptions& options) {
  Known known;
  if (!options.array.empty()) {
    Result<ArrayDescription> array = bytes::files::read_array(options.array);
    if (!array) return array.error();
    known.array = std::move(*array);
  }
  if (!options.model.empty()) {
    Result<touch::pipeline::Model> model = bytes::models::read_model(options.model);
    if (!model) return model.error();
    if (known.array && (known.array->rows != model->array.rows || known.array->cols != model->array.cols)) {
      return bad_input(fmt::format("{}: is for {}x{} taxels, {} has {}x{}", options.model, model->array.rows,
                                   model->array.cols, options.array, known.array->rows, known.array->cols));
    }
    if (!known.array) known.array = model->array;
    known.model = std::move(*model);
  }
  return known;
}

std::string with_queue(const bytes::devices::RecorderProgress& progress) {
  std::string text = summary(progress.frames, progress.source) + fmt::format(", queue {}", progress.queue.depth);
  if (progress.queue.waits > 0) text += fmt::format(", waited {} times", progress.queue.waits);
  return text;
}

/// Why nothing is recorded, and what the bytes look like.
Error without_frames(const std::string& from, const Status& recorded, std::span<const std::uint8_t> bytes) {
  if (!recorded && recorded.error().kind == ErrorKind::failed) return recorded.error();
  Error error = recorded ? failed("'" + from + "': not a single frame came: nothing is recorded") : recorded.error();
  const std::string look = look_of_unread(bytes);
  if (look.empty()) return error;
  if (recorded) error.message += ". " + look;
  if (error.message.ends_with(look)) error.message += more_by_describe(from);
  return error;
}

std::string sum_of(const RecordOptions& options, const bytes::devices::RecorderProgress& last, bool has_model) {
  std::string sum = options.out + ": " + summary(last.frames, last.source);
  if (last.queue.waits == 0) return sum;
  return sum + fmt::format("; the device waited {} times, at most {:.0f} ms, for the {}", last.queue.waits,
                           1e3 * std::chrono::duration<double>(last.queue.longest_wait).count(),
                           has_model ? "model or the disk" : "disk");
}

Result<bytes::devices::RecorderOptions> recorder_options(const RecordOptions& options) {
  bytes::devices::RecorderOptions recorder;
  recorder.frames = options.frames;
  recorder.stop = &stop_flag();
  if (!options.seconds) return recorder;
  const Result<Nanos> duration = nanos_from_seconds(*options.seconds, "--seconds");
  if (!duration) return duration.error();
  recorder.duration = *duration;
  return recorder;
}

Status record(const RecordOptions& options) {
  Result<bytes::devices::RecorderOptions> recorder = recorder_options(options);
  if (!recorder) return recorder.error();
  const Result<Known> known = read_known(options);
  if (!known) return known.error();
  const ArrayDescription* array = known->array ? &*known->array : nullptr;
  live::forces::FrameOutput output{options.out, array, known->model ? &*known->model : nullptr, options.model, {}};
  if (Status possible = live::forces::check_output(output); !possible) return possible;
  LiveLine line;
  live::sources::SourceOptions source_is = source_options(array);
  source_is.simulated = [&](double share) { line.show(fmt::format("simulating the scene: {:.0f} %", 100.0 * share)); };
  FirstBytes first;
  source_is.received = [&](std::span<const std::uint8_t> bytes) { first.add(bytes); };
  Result<std::unique_ptr<FrameSource>> source = live::sources::open_source(options.from, source_is);
  if (!source) return source.error();
  output.notes = live::sources::notes_of_source(**source, options.from);
  recorder->source_stops = (*source)->is_live();

  recorder->progress = [&](const bytes::devices::RecorderProgress& progress) { line.show(with_queue(progress)); };
  bytes::devices::RecorderProgress last;
  TypedMarks marks(options.out);
  const auto begin = [&](const FrameShape& shape) {
    marks.begin();
    return live::forces::create_kept_recording(output, shape);
  };
  Status recorded = bytes::devices::record(**source, begin, *recorder, last);
  line.end();
  if (last.frames > 0) {
    print_notice(sum_of(options, last, known->model.has_value()));
    if (options.from.starts_with("file:") && (*source)->is_live()) {
      print_notice("the file has no times, so the recording has those of this reading: give rate=");
    }
  }
  return last.frames > 0 ? recorded : without_frames(options.from, recorded, first.bytes());
}

}  // namespace

void add_record(Command& command) {
  auto options = std::make_shared<RecordOptions>();
  command.input("--from", options->from, "URI of a device or of the simulator (docs/devices.md), or a file").required();
  command.output("--out", options->out, "Recording to write: .mcap, or another format of frames").required();
  command.outputs_beside("--out", [options] {
    const std::string beside = live::forces::recording_beside(options->out);
    return beside.empty() ? std::vector<std::string>() : std::vector{beside};
  });
  command.input("--array", options->array, "array.toml, to keep with the frames");
  command.input_file("--model", options->model,
                     "Record the forces, too: of this model, or array.toml where readings are forces");
  const Option frames = command.option("--frames", options->frames, "Stop after this many frames");
  command
      .option("--seconds", options->seconds,
              "Stop this long after the first frame, or after the start if none comes [s]")
      .excludes(frames);
  command.action([options] { return record(*options); });
}

}  // namespace dermis::app
