// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>

#include "dermis/core/array_description.hpp"
#include "dermis/core/frame_sink.hpp"
#include "dermis/core/frame_source.hpp"
#include "dermis/core/result.hpp"
#include "dermis/pipeline/model.hpp"
#include "dermis/recordings/frame_files.hpp"

namespace dermis::operation {

/// The notes on frames that are to be written.
struct FrameOutput {
  std::string path;
  const ArrayDescription* array = nullptr;  ///< Goes into a recording.
  const pipeline::Model* model = nullptr;   ///< Not null: the forces are computed and written as well, and
  std::string model_path;                   ///< where the model is from.
  recordings::FrameNotes notes;             ///< Notes by the source, where array and model have none.
};

/// The errors of create_recording() that depend on the path alone, to be reported before waiting for a device.
[[nodiscard]] Status check_output(const FrameOutput& output);

/// The file in which frames of `shape` are recorded: .mcap with the forces of the model, or another format of frames
/// without forces.
[[nodiscard]] Result<std::unique_ptr<FrameSink>> create_recording(const FrameOutput& output, const FrameShape& shape);

/// The forces of the model alone, as forces.csv.
[[nodiscard]] Result<std::unique_ptr<FrameSink>> create_forces(const FrameOutput& output);

}  // namespace dermis::operation
