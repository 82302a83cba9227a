// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "labelled_recording.hpp"

#include <utility>

#include "dermis/bytes/files/loads_csv.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "source_options.hpp"
#include "status_line.hpp"

namespace dermis::app {

Result<std::vector<Load>> read_told_loads(const std::string& path, const ArrayDescription& array,
                                          std::size_t frame_count) {
  std::string taken;
  Result<std::vector<Load>> loads = bytes::files::read_loads(path, array, frame_count, &taken);
  if (!taken.empty()) print_notice(path + ": " + taken);
  return loads;
}

Result<LabelledRecording> LabelledRecording::read(const std::string& model, const std::string& frames,
                                                  const std::string& loads) {
  Result<touch::pipeline::Model> of_array = bytes::models::read_model(model);
  if (!of_array) return of_array.error();
  Result<std::vector<RawFrame>> recorded = live::sources::read_frames(frames, source_options(&of_array->array));
  if (!recorded) return recorded.error();
  Result<std::vector<Load>> known = read_told_loads(loads, of_array->array, recorded->size());
  if (!known) return known.error();
  return LabelledRecording{*std::move(of_array), *std::move(recorded), *std::move(known)};
}

}  // namespace dermis::app
