// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>

#include "dermis/bytes/models/model_file.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"

namespace dermis::live::forces {

/// A model and the pipeline that computes forces by it.
struct ModelAtWork {
  touch::pipeline::Model model;
  touch::pipeline::Pipeline pipeline;

  [[nodiscard]] static Result<ModelAtWork> create(touch::pipeline::Model model);
  /// `path`: as for bytes::models::read_model().
  [[nodiscard]] static Result<ModelAtWork> read(const std::string& path);
  /// The model that a recording holds. Fails where `from` is none, or holds none.
  [[nodiscard]] static Result<ModelAtWork> read_recorded(const std::string& from);
};

/// A model at work on a source. Not thread-safe.
struct Operation : ModelAtWork {
  std::unique_ptr<FrameSource> frames;
  std::string from;  ///< What was opened.
};

/// `model`: empty for that of the recording. `from` and `options`: as for sources::open_source(), but the array is that
/// of the model. Fails where bytes::models::read_model() or sources::open_source() do.
[[nodiscard]] Result<std::unique_ptr<Operation>> open_operation(const std::string& model, const std::string& from,
                                                                sources::SourceOptions options = {});

}  // namespace dermis::live::forces
