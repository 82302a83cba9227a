// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/suit/suit_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "dermis/learn/calibration/uncalibrated_model.hpp"
#include "out/serve/requests/json_request.hpp"

namespace dermis::out::serve {
namespace {

constexpr double kUnknownFullScaleN = 50.0;

double full_scale_newtons(const touch::fusion::ForceNetworks& networks) {
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

nlohmann::ordered_json json_of(const Pose& pose) {
  const Quaternion& turn = pose.rotation;
  return {{"position", json_of(pose.translation)}, {"rotation", {turn.x, turn.y, turn.z, turn.w}}};
}

/// "mesh" has a file where the server gives it.
nlohmann::ordered_json json_of(const BodyVisual& visual, const std::vector<BodyFile>& files) {
  nlohmann::ordered_json json = {{"pose", json_of(visual.link_from_visual)}};
  if (const auto* const box = std::get_if<BoxSolid>(&visual.solid)) {
    json["solid"] = "box";
    json["size"] = json_of(box->size);
  } else if (const auto* const cylinder = std::get_if<CylinderSolid>(&visual.solid)) {
    json["solid"] = "cylinder";
    json["size"] = {cylinder->radius_m, cylinder->length_m};
  } else if (const auto* const sphere = std::get_if<SphereSolid>(&visual.solid)) {
    json["solid"] = "sphere";
    json["size"] = nlohmann::ordered_json::array({sphere->radius_m});
  } else if (const auto* const mesh = std::get_if<MeshSolid>(&visual.solid)) {
    json["solid"] = "mesh";
    json["size"] = json_of(mesh->scale);
    json["name"] = mesh->file;
    const auto file =
        std::find_if(files.begin(), files.end(), [&](const BodyFile& one) { return one.name == mesh->file; });
    if (file != files.end()) json["file"] = file->path.substr(1);
  }
  if (visual.rgba) json["rgba"] = *visual.rgba;
  return json;
}

/// The links at rest; /tf has their present places.
nlohmann::ordered_json json_of(const WornBody& worn) {
  const Body& body = worn.body();
  nlohmann::ordered_json json = {{"name", body.name}, {"links", nlohmann::ordered_json::array()}};
  for (std::size_t k = 0; k < body.links.size(); ++k) {
    nlohmann::ordered_json& link = json["links"].emplace_back();
    link = {
        {"name", body.links[k].name}, {"pose", json_of(worn.rest()[k])}, {"visuals", nlohmann::ordered_json::array()}};
    for (const BodyVisual& visual : body.links[k].visuals) link["visuals"].push_back(json_of(visual, worn.files()));
  }
  json["joints"] = nlohmann::ordered_json::array();
  for (const BodyJoint& joint : body.joints) {
    if (joint.kind != BodyJoint::Kind::fixed) json["joints"].push_back(joint.name);
  }
  return json;
}

/// The limits that hold for the array; `zone` null: everywhere.
nlohmann::ordered_json limits_of(const ServedArray& array, const live::threats::ThreatLimits& limits) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const live::threats::ThreatLimit& limit : limits.limits) {
    const live::threats::Zone* const zone = limit.zone.empty() ? nullptr : limits.zone(limit.zone);
    if (zone != nullptr && zone->array != array.name) continue;
    nlohmann::ordered_json& one = json.emplace_back();
    one["name"] = limit.name;
    one["quantity"] = live::threats::threat_quantity_names()[static_cast<std::size_t>(limit.quantity)];
    one["limit"] = limit.limit;
    one["unit"] = live::threats::unit_of(limit.quantity);
    one["zone"] = nullptr;
    if (zone == nullptr) continue;
    one["zone"] = {
        {"name", zone->name}, {"rows", {zone->first_row, zone->last_row}}, {"cols", {zone->first_col, zone->last_col}}};
  }
  return json;
}

nlohmann::ordered_json json_of(const ServedArray& array, const touch::pipeline::Model& model) {
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
  json["calibrated"] = !learn::calibration::is_uncalibrated(model);
  if (array.classes) json["classes"] = array.classes->names;
  json["pose"] = json_of(array.suit_from_array);
  for (const SurfacePoint& taxel : array.surface.taxels()) {
    json["positions"].push_back(json_of(taxel.position));
    json["normals"].push_back(json_of(taxel.normal));
  }
  for (const auto& [x, y, radius] : array.places) json["places"].push_back({x, y, radius});
  return json;
}

}  // namespace

std::string suit_json(const ServedSuit& suit, const ModelsInUse& models) {
  nlohmann::ordered_json json;
  json["name"] = suit.name;
  if (suit.classes) json["classes"] = suit.classes->names;
  if (suit.body) json["body"] = json_of(*suit.body);
  json["arrays"] = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < suit.arrays.size(); ++k) {
    nlohmann::ordered_json array = json_of(suit.arrays[k], *models.of(k));
    if (suit.threats) array["limits"] = limits_of(suit.arrays[k], *suit.threats);
    if (suit.body) array["link"] = suit.body->link_of(k);
    json["arrays"].push_back(std::move(array));
  }
  return json_text(json);
}

}  // namespace dermis::out::serve
