// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>

#include "dermis/core/array_description.hpp"
#include "dermis/core/frame_source.hpp"
#include "dermis/core/result.hpp"
#include "dermis/pipeline/model.hpp"
#include "dermis/pipeline/pipeline.hpp"

namespace dermis::app {

/// Where frames come from, for --from and --in: the URI of a device or of the simulator, or a file of frames. Given an
/// array, the frames must have its shape. Sources end where stop_flag() is set; what a user should know goes to stderr.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_source(const std::string& from, const ArrayDescription* array);

/// True where the source is a device, or a simulated one, that sends as time goes by.
[[nodiscard]] bool is_live(const std::string& from);

/// True where it is a device, or bytes of one: it gives what it has received before it ends by stop_flag().
[[nodiscard]] bool is_device(const std::string& from);

/// A model at work on a source.
struct Operation {
  pipeline::Model model;
  pipeline::Pipeline pipeline;
  std::unique_ptr<FrameSource> frames;
};
[[nodiscard]] Result<std::unique_ptr<Operation>> open_operation(const std::string& model, const std::string& from);

}  // namespace dermis::app
