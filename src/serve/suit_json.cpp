// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/suit_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace dermis::serve {
namespace {

constexpr double kUnknownFullScaleN = 50.0;

double full_scale_newtons(const fusion::ForceNetworks& networks) {
  double heaviest = 0.0;
  for (std::size_t k = 0; k < networks.taxel_count(); ++k) {
    const auto newtons = static_cast<double>(networks.heaviest_newtons[k]);
    if (networks.dead[k] == 0 && std::isfinite(newtons)) heaviest = std::max(heaviest, newtons);
  }
  return heaviest > 0.0 ? heaviest : kUnknownFullScaleN;
}

nlohmann::ordered_json json_of(const Vector3& vector) {
  return {vector.x, vector.y, vector.z};
}

nlohmann::ordered_json json_of(const ServedArray& array, const pipeline::Model& model) {
  const ArrayDescription& description = model.array;
  nlohmann::ordered_json json;
  json["name"] = array.name;
  json["rows"] = description.rows;
  json["cols"] = description.cols;
  json["pitch_m"] = {description.row_pitch_m, description.col_pitch_m};
  json["taxel_area_m2"] = nullptr;
  if (description.taxel_area_m2) json["taxel_area_m2"] = *description.taxel_area_m2;
  json["full_scale_counts"] = description.readout.full_scale_counts();
  json["full_scale_n"] = full_scale_newtons(model.networks);
  for (const SurfacePoint& taxel : array.surface.taxels()) {
    json["positions"].push_back(json_of(taxel.position));
    json["normals"].push_back(json_of(taxel.normal));
  }
  return json;
}

}  // namespace

std::string suit_json(const ServedSuit& suit, const ModelsInUse& models) {
  nlohmann::ordered_json json;
  json["name"] = suit.name;
  json["arrays"] = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < suit.arrays.size(); ++k) {
    json["arrays"].push_back(json_of(suit.arrays[k], *models.of(k)));
  }
  return json.dump();
}

}  // namespace dermis::serve
