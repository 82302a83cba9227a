// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "open_source.hpp"

#include <utility>

#include "dermis/sources/open_source.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"

namespace dermis::app {

Result<std::unique_ptr<FrameSource>> open_source(const std::string& from, const ArrayDescription* array) {
  return sources::open_source(from, {.array = array, .stop = &stop_flag(), .notice = say});
}

Result<std::unique_ptr<Operation>> open_operation(const std::string& model_path, const std::string& from) {
  Result<pipeline::Model> model = pipeline::read_model(model_path);
  if (!model) return model.error();
  Result<pipeline::Pipeline> pipeline = pipeline::Pipeline::create(*model);
  if (!pipeline) return pipeline.error();
  Result<std::unique_ptr<FrameSource>> frames = open_source(from, &model->array);
  if (!frames) return frames.error();
  return std::make_unique<Operation>(Operation{std::move(*model), std::move(*pipeline), std::move(*frames)});
}

}  // namespace dermis::app
