// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/suit/model_or_array.hpp"

#include <utility>

#include "dermis/calibration/uncalibrated_model.hpp"
#include "dermis/files/array_toml.hpp"
#include "dermis/recordings/frame_files.hpp"

namespace dermis::serve {

namespace {

Result<ModelOrArray> uncalibrated(Result<ArrayDescription> array) {
  if (!array) return array.error();
  return ModelOrArray{calibration::uncalibrated_model(*array), *std::move(array)};
}

}  // namespace

Result<ModelOrArray> read_model_or_array(const std::string& path) {
  if (path.ends_with(".toml")) return uncalibrated(files::read_array(path));
  Result<pipeline::Model> model = pipeline::read_model(path);
  if (!model) return model.error();
  ArrayDescription array = model->array;
  return ModelOrArray{*std::move(model), std::move(array)};
}

Result<ModelOrArray> read_recorded_array(const std::string& recording) {
  const Result<recordings::FrameNotes> notes = recordings::read_frame_notes(recording);
  if (!notes) return notes.error();
  if (notes->array_toml.empty()) return bad_input(recording + ": does not describe its array; name the model of it");
  return uncalibrated(files::array_from_toml(notes->array_toml, recording));
}

}  // namespace dermis::serve
