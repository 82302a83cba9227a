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

/// What is known of frames that are to be written.
struct FrameOutput {
  std::string path;
  const ArrayDescription* array = nullptr;  ///< Goes into a recording.
  const pipeline::Model* model = nullptr;   ///< Not null: the forces are computed and written as well, and
  std::string model_path;                   ///< where the model is from.
  recordings::FrameNotes notes;             ///< What the source says, where array and model do not.
};

/// What the file of frames that `source` reads from says of them; nothing of a device.
[[nodiscard]] recordings::FrameNotes notes_of_source(const FrameSource& source, const std::string& from);

/// What create_recording() would find wrong with the path whatever the frames are: to be told before a device is waited
/// for.
[[nodiscard]] Status check_output(const FrameOutput& output);

/// The file that frames of `shape` are recorded in: .mcap, with the forces of the model, or any other format of frames,
/// which cannot hold forces.
[[nodiscard]] Result<std::unique_ptr<FrameSink>> create_recording(const FrameOutput& output, const FrameShape& shape);

/// The forces of the model alone, as forces.csv.
[[nodiscard]] Result<std::unique_ptr<FrameSink>> create_forces(const FrameOutput& output);

}  // namespace dermis::operation
