// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <memory>
#include <optional>
#include <string>

#include "commands.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/live/forces/frame_output.hpp"
#include "dermis/live/sources/pacer.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "source_options.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

using live::forces::FrameOutput;

struct ReplayOptions {
  std::string recording;
  double speed = 1.0;
  std::string model;
  std::string out = kStandardOutput;
};

Result<std::unique_ptr<FrameSink>> create_sink(const FrameOutput& output, const FrameShape& shape) {
  const Result<bytes::recordings::FrameFormat> format = bytes::recordings::output_format(output.path);
  if (!format) return format.error();
  const bool is_table = *format == bytes::recordings::FrameFormat::csv;
  return output.model != nullptr && is_table ? live::forces::create_forces(output)
                                             : live::forces::create_recording(output, shape);
}

/// Frame times of the recording -> moments of the replay.
class Tempo {
 public:
  Tempo(double speed, Nanos first_time, const std::atomic<bool>* stop)
      : speed_(speed), first_time_(first_time), pacer_(stop), stop_(stop) {}

  /// False where it is to stop.
  bool wait_for(Nanos time) {
    if (!(speed_ > 0.0)) return !stop_->load();
    return pacer_.wait_until(live::sources::due_after(first_time_, time, speed_));
  }

 private:
  double speed_;
  Nanos first_time_;
  live::sources::Pacer pacer_;
  const std::atomic<bool>* stop_;
};

Status replay(const ReplayOptions& options) {
  const bool is_pace = options.speed >= 1e-3 && options.speed <= 1e6;
  if (!is_pace && options.speed != 0.0) {
    return bad_input("--speed: must be 0 (as fast as it goes), or 0.001 to 1e6 times the recorded one");
  }
  std::optional<touch::pipeline::Model> model;
  if (!options.model.empty()) {
    Result<touch::pipeline::Model> read = bytes::models::read_model(options.model);
    if (!read) return read.error();
    model = std::move(*read);
  }
  const ArrayDescription* array = model ? &model->array : nullptr;
  Result<std::unique_ptr<FrameSource>> source = live::sources::open_source(options.recording, source_options(array));
  if (!source) return source.error();
  RawFrame frame;
  Result<bool> more = (*source)->next(frame);
  if (!more) return more.error();
  if (!*more) return bad_input("'" + options.recording + "': has no frame to replay");

  const FrameOutput output{options.out, array, model ? &*model : nullptr, options.model,
                           live::sources::notes_of_source(**source, options.recording)};
  Result<std::unique_ptr<FrameSink>> sink = create_sink(output, *(*source)->shape());
  if (!sink) return sink.error();
  Tempo tempo(options.speed, frame.time, &stop_flag());
  while (more && *more && tempo.wait_for(frame.time)) {
    if (Status written = (*sink)->write(frame); !written) return written;
    more = (*source)->next(frame);
  }
  if (!more) return more.error();
  return (*sink)->commit();
}

}  // namespace

void add_replay(Command& command) {
  auto options = std::make_shared<ReplayOptions>();
  command.input("recording", options->recording, "Recording (.mcap) or another file of frames").required();
  command.option("--speed", options->speed, "Factor on the recorded pace; 0: as fast as possible").shows_default();
  command.input_file("--model", options->model,
                     "Model file, or array.toml where readings are forces: replays the forces");
  command.output("--out", options->out, "frames.csv, or forces.csv with --model; or .mcap").shows_default();
  command.action([options] { return replay(*options); });
}

}  // namespace dermis::app
