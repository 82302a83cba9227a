// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recording/recorded_arrays.hpp"

#include <memory>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/files/content_hash.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/bytes/recordings/frame_notes.hpp"
#include "dermis/learn/calibration/uncalibrated_model.hpp"

namespace dermis::out::serve {

namespace {

/// `path`: of the file from which it was read; empty: it is in none, or in one that the user has not named.
void add_model(const touch::pipeline::Model& model, const std::string& path, bytes::recordings::RecordedArray& array) {
  const Result<std::string> hash = bytes::files::content_hash(path);
  if (hash) array.model_hash = *hash;
  if (learn::calibration::is_uncalibrated(model)) return;
  Result<std::string> file = bytes::models::model_to_bytes(model);
  if (!file) return;
  if (!hash) {
    bytes::files::ContentHash of_file;
    of_file.add(*file);
    array.model_hash = of_file.text();
  }
  if (file->size() <= bytes::recordings::kMostModelBytes) array.model_file = *std::move(file);
}

}  // namespace

std::vector<bytes::recordings::RecordedArray> recorded_arrays(const ServedSuit& suit, const ModelsInUse& models) {
  std::vector<bytes::recordings::RecordedArray> recorded;
  for (std::size_t k = 0; k < suit.arrays.size(); ++k) {
    const ServedArray& array = suit.arrays[k];
    const std::shared_ptr<const touch::pipeline::Model> model = models.of(k);
    const ArrayDescription& description = model->array;
    bytes::recordings::RecordedArray& one = recorded.emplace_back();
    one.name = array.name;
    one.shape = {description.rows, description.cols};
    one.array_toml = bytes::files::array_to_toml(description);
    one.pitch = {description.row_pitch_m, description.col_pitch_m};
    one.simulation = array.simulation;
    add_model(*model, models.is_new(k) ? "" : array.model_path, one);
  }
  return recorded;
}

}  // namespace dermis::out::serve
