// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/suit/model_or_array.hpp"

#include <utility>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/calibration/uncalibrated_model.hpp"
#include "dermis/live/sources/simulated_calibration.hpp"

namespace dermis::out::serve {

namespace {

Result<ModelOrArray> uncalibrated(Result<ArrayDescription> array) {
  if (!array) return array.error();
  return ModelOrArray{learn::calibration::uncalibrated_model(*array), *std::move(array)};
}

Result<ModelOrArray> calibrated(Result<touch::pipeline::Model> model) {
  if (!model) return model.error();
  ArrayDescription array = model->array;
  return ModelOrArray{*std::move(model), std::move(array)};
}

}  // namespace

Result<ModelOrArray> read_model_or_array(const std::string& path) {
  if (path.ends_with(".toml")) return uncalibrated(bytes::files::read_array(path));
  return calibrated(bytes::models::read_model(path));
}

Result<ModelOrArray> read_recorded_array(const std::string& recording) {
  const Result<bytes::recordings::FrameNotes> notes = bytes::recordings::read_frame_notes(recording);
  if (!notes) return notes.error();
  if (!notes->model_file.empty()) {
    return calibrated(bytes::models::model_from_bytes(notes->model_file, recording + ": its model"));
  }
  if (notes->array_toml.empty()) return bad_input(recording + ": does not describe its array; name the model of it");
  return uncalibrated(bytes::files::array_from_toml(notes->array_toml, recording));
}

Result<ModelOrArray> calibrate_simulated_array(const bytes::devices::SourceUri& uri) {
  const Result<live::sources::SimulatedCalibration> rig = live::sources::simulate_calibration(uri);
  if (!rig) return rig.error();
  Result<learn::calibration::Calibration> made = learn::calibration::calibrate(rig->array, rig->frames, rig->loads);
  if (!made) return bad_input("'" + uri.text + "': " + made.error().message);
  return calibrated(std::move(made->model));
}

}  // namespace dermis::out::serve
