// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>

#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frame_sink.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::live::forces {

/// The notes on frames that are to be written.
struct FrameOutput {
  std::string path;
  const ArrayDescription* array = nullptr;        ///< Goes into a recording.
  const touch::pipeline::Model* model = nullptr;  ///< Not null: the forces are computed and written as well, and
  std::string model_path;                         ///< where the model is from.
  bytes::recordings::FrameNotes notes;            ///< Notes by the source, where array and model have none.
};

/// The errors of create_recording() that depend on the path alone, to be reported before waiting for a device.
[[nodiscard]] Status check_output(const FrameOutput& output);

/// The file in which frames of `shape` are recorded: .mcap with the forces of the model, or another format of frames
/// without forces.
[[nodiscard]] Result<std::unique_ptr<FrameSink>> create_recording(const FrameOutput& output, const FrameShape& shape);

/// The recording that keeps the frames of a table while it is written: "frames.csv.mcap" beside "frames.csv". Empty
/// where the output is a recording itself, or no file.
[[nodiscard]] std::string recording_beside(const std::string& path);

/// The same for frames that do not come again. Those of a table are kept by recording_beside() until it is complete,
/// even if the process dies.
[[nodiscard]] Result<std::unique_ptr<FrameSink>> create_kept_recording(const FrameOutput& output,
                                                                       const FrameShape& shape);

/// The forces of the model alone, as forces.csv.
[[nodiscard]] Result<std::unique_ptr<FrameSink>> create_forces(const FrameOutput& output);

}  // namespace dermis::live::forces
