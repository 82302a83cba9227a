// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "open_source.hpp"

#include <fmt/core.h>

#include <optional>
#include <utility>

#include "dermis/acquisition/device_source.hpp"
#include "dermis/acquisition/source_uri.hpp"
#include "dermis/recordings/frame_files.hpp"
#include "simulated_device.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

std::optional<FrameShape> shape_of(const ArrayDescription* array) {
  if (array == nullptr) return std::nullopt;
  return FrameShape{array->rows, array->cols};
}

}  // namespace

Result<std::unique_ptr<FrameSource>> open_source(const std::string& from, const ArrayDescription* array) {
  const std::optional<FrameShape> shape = shape_of(array);
  if (!acquisition::is_source_uri(from)) return recordings::open_frames(from, {.shape = shape});
  const Result<acquisition::SourceUri> uri = acquisition::parse_source_uri(from);
  if (!uri) return uri.error();
  if (uri->transport == acquisition::Transport::simulation) {
    Result<std::unique_ptr<FrameSource>> simulated = open_simulation(*uri, array, &stop_flag());
    if (simulated && shape && *(*simulated)->shape() != *shape) {
      return bad_input(fmt::format("'{}': has {}x{} taxels, the array {}x{}", from, (*simulated)->shape()->rows,
                                   (*simulated)->shape()->cols, shape->rows, shape->cols));
    }
    return simulated;
  }
  acquisition::DeviceOptions options;
  options.shape = shape;
  options.stop = &stop_flag();
  options.notice = say;
  return acquisition::open_device(from, options);
}

bool is_live(const std::string& from) {
  return acquisition::is_source_uri(from);
}

bool is_device(const std::string& from) {
  return is_live(from) && !from.starts_with("sim:");
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
