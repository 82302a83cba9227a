// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/forces/operation.hpp"

#include <utility>

#include "dermis/bytes/models/model_file.hpp"

namespace dermis::live::forces {

Result<ModelAtWork> ModelAtWork::create(touch::pipeline::Model model) {
  Result<touch::pipeline::Pipeline> pipeline = touch::pipeline::Pipeline::create(model);
  if (!pipeline) return pipeline.error();
  return ModelAtWork{std::move(model), *std::move(pipeline)};
}

Result<ModelAtWork> ModelAtWork::read(const std::string& path) {
  Result<touch::pipeline::Model> model = bytes::models::read_model(path);
  if (!model) return model.error();
  return create(*std::move(model));
}

Result<std::unique_ptr<Operation>> open_operation(const std::string& model, const std::string& from,
                                                  sources::SourceOptions options) {
  Result<ModelAtWork> work = ModelAtWork::read(model);
  if (!work) return work.error();
  options.array = &work->model.array;
  Result<std::unique_ptr<FrameSource>> frames = sources::open_source(from, options);
  if (!frames) return frames.error();
  return std::make_unique<Operation>(Operation{*std::move(work), *std::move(frames), from});
}

}  // namespace dermis::live::forces
