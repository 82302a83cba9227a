// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recording/recorded_arrays.hpp"

#include <memory>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/files/content_hash.hpp"

namespace dermis::out::serve {

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
    const Result<std::string> hash = bytes::files::content_hash(array.model_path);
    if (hash && !models.is_new(k)) one.model_hash = *hash;
  }
  return recorded;
}

}  // namespace dermis::out::serve
