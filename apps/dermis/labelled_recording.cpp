// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "labelled_recording.hpp"

#include <utility>

#include "dermis/files/loads_csv.hpp"
#include "source_options.hpp"

namespace dermis::app {

Result<LabelledRecording> LabelledRecording::read(const std::string& model, const std::string& frames,
                                                  const std::string& loads) {
  Result<pipeline::Model> of_array = pipeline::read_model(model);
  if (!of_array) return of_array.error();
  Result<std::vector<RawFrame>> recorded = sources::read_frames(frames, source_options(&of_array->array));
  if (!recorded) return recorded.error();
  Result<std::vector<Load>> known = files::read_loads(loads, of_array->array, recorded->size());
  if (!known) return known.error();
  return LabelledRecording{*std::move(of_array), *std::move(recorded), *std::move(known)};
}

}  // namespace dermis::app
