// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dermis/core/array_description.hpp"
#include "dermis/core/frame_source.hpp"
#include "dermis/core/result.hpp"
#include "dermis/pipeline/model.hpp"
#include "dermis/pipeline/pipeline.hpp"

namespace dermis::app {

/// sources::open_source() for --from and --in: live sources end where stop_flag() is set, and what a user should know
/// goes to stderr.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_source(const std::string& from, const ArrayDescription* array);

/// All frames of a file, for --frames, as open_source() opens it. Fails on a device, which has no end.
[[nodiscard]] Result<std::vector<RawFrame>> read_frames(const std::string& from, const ArrayDescription& array);

/// The path of the file that --frames names: without the name of an array in it, and without what a URI says of it.
[[nodiscard]] std::string file_of(const std::string& from);

/// A model at work on a source.
struct Operation {
  pipeline::Model model;
  pipeline::Pipeline pipeline;
  std::unique_ptr<FrameSource> frames;
};
[[nodiscard]] Result<std::unique_ptr<Operation>> open_operation(const std::string& model, const std::string& from);

}  // namespace dermis::app
