// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/operation/frame_output.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <utility>

#include "dermis/files/array_toml.hpp"
#include "dermis/files/content_hash.hpp"
#include "dermis/files/forces_csv.hpp"
#include "dermis/pipeline/pipeline.hpp"
#include "dermis/recordings/frame_files.hpp"
#include "dermis/recordings/recording.hpp"

namespace dermis::operation {
namespace {

/// Frames into a recording, each with its forces.
class RecordingWithForces final : public FrameSink {
 public:
  RecordingWithForces(pipeline::Pipeline pipeline, std::unique_ptr<recordings::RecordingWriter> recording)
      : pipeline_(std::move(pipeline)), recording_(std::move(recording)) {}

  Status write(const RawFrame& frame) override {
    pipeline_.process(frame, force_);
    return recording_->write(frame, force_);
  }
  Status commit() override { return recording_->commit(); }

 private:
  pipeline::Pipeline pipeline_;
  std::unique_ptr<recordings::RecordingWriter> recording_;
  ForceFrame force_;
};

class ForcesOnly final : public FrameSink {
 public:
  ForcesOnly(pipeline::Pipeline pipeline, files::ForcesCsvWriter forces)
      : pipeline_(std::move(pipeline)), forces_(std::move(forces)) {}

  Status write(const RawFrame& frame) override {
    pipeline_.process(frame, force_);
    return forces_.write(force_);
  }
  Status commit() override { return forces_.commit(); }

 private:
  pipeline::Pipeline pipeline_;
  files::ForcesCsvWriter forces_;
  ForceFrame force_;
};

Result<recordings::FrameNotes> notes_of(const FrameOutput& output) {
  recordings::FrameNotes notes = output.notes;
  if (output.array != nullptr) {
    notes.name = output.array->name;
    notes.array_toml = files::array_to_toml(*output.array);
  }
  if (output.model != nullptr) {
    const Result<std::string> hash = files::content_hash(output.model_path);
    if (!hash) return hash.error();
    notes.model_hash = *hash;
  }
  return notes;
}

/// A recording that is whole at each moment, whatever happens to the process.
Result<std::unique_ptr<FrameSink>> create_live_recording(const FrameOutput& output, const FrameShape& shape,
                                                         const recordings::FrameNotes& notes) {
  recordings::RecordingOptions options;
  if (!notes.name.empty()) options.name = notes.name;
  options.array_toml = notes.array_toml;
  options.model_hash = notes.model_hash;
  if (output.array != nullptr) options.pitch = {output.array->row_pitch_m, output.array->col_pitch_m};
  std::optional<pipeline::Pipeline> pipeline;
  if (output.model != nullptr) {
    Result<pipeline::Pipeline> created = pipeline::Pipeline::create(*output.model);
    if (!created) return created.error();
    pipeline.emplace(std::move(*created));
  }
  Result<std::unique_ptr<recordings::RecordingWriter>> recording =
      recordings::RecordingWriter::create(output.path, shape, options);
  if (!recording) return recording.error();
  if (!pipeline) return std::unique_ptr<FrameSink>(std::move(*recording));
  return std::unique_ptr<FrameSink>(std::make_unique<RecordingWithForces>(std::move(*pipeline), std::move(*recording)));
}

}  // namespace

recordings::FrameNotes notes_of_source(const FrameSource& source, const std::string& from) {
  if (source.is_live()) return {};
  const Result<recordings::FrameNotes> notes = recordings::read_frame_notes(from);
  return notes ? *notes : recordings::FrameNotes{};
}

Status check_output(const FrameOutput& output) {
  const Result<recordings::FrameFormat> format = recordings::output_format(output.path);
  if (!format) return format.error();
  if (output.model != nullptr && *format != recordings::FrameFormat::mcap) {
    return bad_input("'" + output.path + "': has no place for forces; a recording has: end it in .mcap");
  }
  if (::access(output.path.c_str(), F_OK) == 0) return Done{};
  const std::string folder = std::filesystem::path(output.path).parent_path().string();
  if (::access(folder.empty() ? "." : folder.c_str(), W_OK) == 0) return Done{};
  return failed("cannot write '" + output.path + "': " + std::strerror(errno));
}

Result<std::unique_ptr<FrameSink>> create_recording(const FrameOutput& output, const FrameShape& shape) {
  if (const Status possible = check_output(output); !possible) return possible.error();
  const Result<recordings::FrameNotes> notes = notes_of(output);
  if (!notes) return notes.error();
  if (*recordings::frame_format(output.path) == recordings::FrameFormat::mcap) {
    return create_live_recording(output, shape, *notes);
  }
  return recordings::create_frames(output.path, shape, *notes);
}

Result<std::unique_ptr<FrameSink>> create_forces(const FrameOutput& output) {
  Result<pipeline::Pipeline> pipeline = pipeline::Pipeline::create(*output.model);
  if (!pipeline) return pipeline.error();
  Result<files::ForcesCsvWriter> forces =
      files::ForcesCsvWriter::create(output.path, output.model->array.rows, output.model->array.cols);
  if (!forces) return forces.error();
  return std::unique_ptr<FrameSink>(std::make_unique<ForcesOnly>(std::move(*pipeline), std::move(*forces)));
}

}  // namespace dermis::operation
