// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "open_source.hpp"

#include <utility>

#include "dermis/acquisition/source_uri.hpp"
#include "dermis/recordings/frame_files.hpp"
#include "dermis/recordings/recording.hpp"
#include "dermis/sources/open_source.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"

namespace dermis::app {

Result<std::unique_ptr<FrameSource>> open_source(const std::string& from, const ArrayDescription* array) {
  return sources::open_source(from, {.array = array, .stop = &stop_flag(), .notice = say});
}

Result<std::vector<RawFrame>> read_frames(const std::string& from, const ArrayDescription& array) {
  const Result<std::unique_ptr<FrameSource>> source = open_source(from, &array);
  if (!source) return source.error();
  if ((*source)->is_live()) return bad_input("'" + from + "': is a device, which has no end; 'dermis record' it first");
  return recordings::read_frames(**source);
}

std::string file_of(const std::string& from) {
  const bool is_uri = acquisition::is_source_uri(from);
  const Result<acquisition::SourceUri> uri = acquisition::parse_source_uri(from);
  return recordings::recording_place(is_uri && uri ? uri->path : from).path;
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
