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

/// sources::open_source() for --from and --in: live sources end where stop_flag() is set, and what a user should know
/// goes to stderr.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_source(const std::string& from, const ArrayDescription* array);

/// A model at work on a source.
struct Operation {
  pipeline::Model model;
  pipeline::Pipeline pipeline;
  std::unique_ptr<FrameSource> frames;
};
[[nodiscard]] Result<std::unique_ptr<Operation>> open_operation(const std::string& model, const std::string& from);

}  // namespace dermis::app
