// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/forces/operation.hpp"

#include <utility>

#include "dermis/bytes/models/model_file.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"

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

Result<ModelAtWork> ModelAtWork::read_recorded(const std::string& from) {
  const Result<sources::SourceName> name = sources::SourceName::parse(from);
  if (!name) return name.error();
  if (name->kind != sources::SourceKind::recording)
    return bad_input("'" + from + "': is no recording, which may hold its model: name one");
  const Result<bytes::recordings::FrameNotes> notes = bytes::recordings::read_frame_notes(from);
  if (!notes) return notes.error();
  if (notes->model_file.empty()) return bad_input("'" + from + "': was recorded without a model: name one");
  Result<touch::pipeline::Model> model = bytes::models::model_from_bytes(notes->model_file, from + ": its model");
  if (!model) return model.error();
  return create(*std::move(model));
}

Result<std::unique_ptr<Operation>> open_operation(const std::string& model, const std::string& from,
                                                  sources::SourceOptions options) {
  Result<ModelAtWork> work = model.empty() ? ModelAtWork::read_recorded(from) : ModelAtWork::read(model);
  if (!work) return work.error();
  options.array = &work->model.array;
  Result<std::unique_ptr<FrameSource>> frames = sources::open_source(from, options);
  if (!frames) return frames.error();
  return std::make_unique<Operation>(Operation{*std::move(work), *std::move(frames), from});
}

}  // namespace dermis::live::forces
