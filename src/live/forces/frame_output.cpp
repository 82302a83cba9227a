// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/forces/frame_output.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/files/content_hash.hpp"
#include "dermis/bytes/files/forces_csv.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/bytes/recordings/recording.hpp"
#include "dermis/touch/pipeline/frame_troubles.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"

namespace dermis::live::forces {
namespace {

/// Writes frames with the forces that a pipeline makes of them. Complete frames are kept though most may have none, but
/// commit() then fails.
class ForceSink : public FrameSink {
 public:
  ForceSink(const FrameOutput& output, touch::pipeline::Pipeline pipeline)
      : pipeline_(std::move(pipeline)), troubles_(output.model->array, output.path) {}

  Status write(const RawFrame& frame) final {
    pipeline_.process(frame, force_);
    troubles_.add(frame, force_, pipeline_);
    return write(frame, force_);
  }
  Status commit() final {
    if (Status committed = commit_all(); !committed) return committed;
    return troubles_.verdict();
  }

 private:
  virtual Status write(const RawFrame& frame, const ForceFrame& force) = 0;
  virtual Status commit_all() = 0;

  touch::pipeline::Pipeline pipeline_;
  touch::pipeline::FrameTroubles troubles_;
  ForceFrame force_;
};

class RecordingWithForces final : public ForceSink {
 public:
  RecordingWithForces(const FrameOutput& output, touch::pipeline::Pipeline pipeline,
                      std::unique_ptr<bytes::recordings::RecordingWriter> recording)
      : ForceSink(output, std::move(pipeline)), recording_(std::move(recording)) {}

 private:
  Status write(const RawFrame& frame, const ForceFrame& force) override { return recording_->write(frame, force); }
  Status commit_all() override { return recording_->commit(); }

  std::unique_ptr<bytes::recordings::RecordingWriter> recording_;
};

class ForcesOnly final : public ForceSink {
 public:
  ForcesOnly(const FrameOutput& output, touch::pipeline::Pipeline pipeline, bytes::files::ForcesCsvWriter forces)
      : ForceSink(output, std::move(pipeline)), forces_(std::move(forces)) {}

 private:
  Status write(const RawFrame& /*frame*/, const ForceFrame& force) override { return forces_.write(force); }
  Status commit_all() override { return forces_.commit(); }

  bytes::files::ForcesCsvWriter forces_;
};

class KeptTable final : public FrameSink {
 public:
  KeptTable(std::unique_ptr<FrameSink> table, std::unique_ptr<FrameSink> recording, std::string recording_path)
      : table_(std::move(table)), recording_(std::move(recording)), recording_path_(std::move(recording_path)) {}

  Status write(const RawFrame& frame) override {
    const Status kept = recording_->write(frame);
    return kept ? table_->write(frame) : kept;
  }

  Status commit() override {
    Status written = table_->commit();
    const Status kept = recording_->commit();
    if (!written && kept) return failed(written.error().message + "; the frames are in '" + recording_path_ + "'");
    if (written && kept) std::remove(recording_path_.c_str());
    return written ? kept : written;
  }

 private:
  std::unique_ptr<FrameSink> table_;
  std::unique_ptr<FrameSink> recording_;
  std::string recording_path_;
};

Result<bytes::recordings::FrameNotes> notes_of(const FrameOutput& output) {
  bytes::recordings::FrameNotes notes = output.notes;
  if (output.array != nullptr) {
    notes.name = output.array->name;
    notes.array_toml = bytes::files::array_to_toml(*output.array);
  }
  if (output.model != nullptr) {
    const Result<std::string> hash = bytes::files::content_hash(output.model_path);
    if (!hash) return hash.error();
    notes.model_hash = *hash;
    Result<std::string> file = bytes::models::model_to_bytes(*output.model);
    if (file && file->size() <= bytes::recordings::kMostModelBytes) notes.model_file = *std::move(file);
  }
  return notes;
}

/// A recording that is whole at each moment, whatever happens to the process.
Result<std::unique_ptr<FrameSink>> create_live_recording(const FrameOutput& output, const FrameShape& shape,
                                                         const bytes::recordings::FrameNotes& notes) {
  bytes::recordings::RecordingOptions options;
  if (!notes.name.empty()) options.name = notes.name;
  options.array_toml = notes.array_toml;
  options.model_hash = notes.model_hash;
  options.simulation = notes.simulation;
  options.model_file = notes.model_file;
  if (output.array != nullptr) options.pitch = {output.array->row_pitch_m, output.array->col_pitch_m};
  std::optional<touch::pipeline::Pipeline> pipeline;
  if (output.model != nullptr) {
    Result<touch::pipeline::Pipeline> created = touch::pipeline::Pipeline::create(*output.model);
    if (!created) return created.error();
    pipeline.emplace(std::move(*created));
  }
  Result<std::unique_ptr<bytes::recordings::RecordingWriter>> recording =
      bytes::recordings::RecordingWriter::create(output.path, shape, options);
  if (!recording) return recording.error();
  if (!pipeline) return std::unique_ptr<FrameSink>(std::move(*recording));
  return std::unique_ptr<FrameSink>(
      std::make_unique<RecordingWithForces>(output, std::move(*pipeline), std::move(*recording)));
}

}  // namespace

Status check_output(const FrameOutput& output) {
  const Result<bytes::recordings::FrameFormat> format = bytes::recordings::output_format(output.path);
  if (!format) return format.error();
  if (output.model != nullptr && *format != bytes::recordings::FrameFormat::mcap) {
    return bad_input("'" + output.path + "': has no place for forces; a recording has: end it in .mcap");
  }
  if (::access(output.path.c_str(), F_OK) == 0) return Done{};
  const std::string folder = std::filesystem::path(output.path).parent_path().string();
  if (::access(folder.empty() ? "." : folder.c_str(), W_OK) == 0) return Done{};
  return failed("cannot write '" + output.path + "': " + std::strerror(errno));
}

Result<std::unique_ptr<FrameSink>> create_recording(const FrameOutput& output, const FrameShape& shape) {
  if (const Status possible = check_output(output); !possible) return possible.error();
  const Result<bytes::recordings::FrameNotes> notes = notes_of(output);
  if (!notes) return notes.error();
  if (*bytes::recordings::frame_format(output.path) == bytes::recordings::FrameFormat::mcap) {
    return create_live_recording(output, shape, *notes);
  }
  return bytes::recordings::create_frames(output.path, shape, *notes);
}

std::string recording_beside(const std::string& path) {
  const Result<bytes::recordings::FrameFormat> format = bytes::recordings::output_format(path);
  std::error_code error;
  const bool is_stream = std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error);
  const bool needs_none = !format || *format == bytes::recordings::FrameFormat::mcap || is_stream;
  return needs_none ? std::string() : path + ".mcap";
}

Result<std::unique_ptr<FrameSink>> create_kept_recording(const FrameOutput& output, const FrameShape& shape) {
  Result<std::unique_ptr<FrameSink>> table = create_recording(output, shape);
  FrameOutput beside = output;
  beside.path = recording_beside(output.path);
  if (!table || beside.path.empty()) return table;
  Result<std::unique_ptr<FrameSink>> recording = create_recording(beside, shape);
  if (!recording) return recording;
  return std::unique_ptr<FrameSink>(std::make_unique<KeptTable>(*std::move(table), *std::move(recording), beside.path));
}

Result<std::unique_ptr<FrameSink>> create_forces(const FrameOutput& output) {
  Result<touch::pipeline::Pipeline> pipeline = touch::pipeline::Pipeline::create(*output.model);
  if (!pipeline) return pipeline.error();
  Result<bytes::files::ForcesCsvWriter> forces =
      bytes::files::ForcesCsvWriter::create(output.path, output.model->array.rows, output.model->array.cols);
  if (!forces) return forces.error();
  return std::unique_ptr<FrameSink>(std::make_unique<ForcesOnly>(output, std::move(*pipeline), std::move(*forces)));
}

}  // namespace dermis::live::forces
