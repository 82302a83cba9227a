// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/model_or_array.hpp"

#include <utility>

#include "dermis/calibration/uncalibrated_model.hpp"
#include "dermis/files/array_toml.hpp"

namespace dermis::serve {

Result<ModelOrArray> read_model_or_array(const std::string& path) {
  if (!path.ends_with(".toml")) {
    Result<pipeline::Model> model = pipeline::read_model(path);
    if (!model) return model.error();
    ArrayDescription array = model->array;
    return ModelOrArray{*std::move(model), std::move(array)};
  }
  Result<ArrayDescription> array = files::read_array(path);
  if (!array) return array.error();
  return ModelOrArray{calibration::uncalibrated_model(*array), *std::move(array)};
}

}  // namespace dermis::serve
