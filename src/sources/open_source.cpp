// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/sources/open_source.hpp"

#include <optional>

#include "dermis/acquisition/device_source.hpp"
#include "dermis/recordings/frame_files.hpp"
#include "sources/simulated_source.hpp"

namespace dermis::sources {
namespace {

std::optional<FrameShape> shape_of(const ArrayDescription* array) {
  if (array == nullptr) return std::nullopt;
  return FrameShape{array->rows, array->cols};
}

}  // namespace

Result<std::unique_ptr<FrameSource>> open_source(const std::string& from, const SourceOptions& options) {
  if (!acquisition::is_source_uri(from)) return recordings::open_frames(from, {.shape = shape_of(options.array)});
  const Result<acquisition::SourceUri> uri = acquisition::parse_source_uri(from);
  if (!uri) return uri.error();
  return open_source(*uri, options);
}

Result<std::unique_ptr<FrameSource>> open_source(const acquisition::SourceUri& uri, const SourceOptions& options) {
  if (uri.transport == acquisition::Transport::simulation) return open_simulation(uri, options);
  return acquisition::open_device(uri, {shape_of(options.array), options.stop, options.notice});
}

}  // namespace dermis::sources
