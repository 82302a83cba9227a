// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/setup/setup_json.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "out/serve/requests/json_request.hpp"
#include "out/serve/setup/layout_proposals.hpp"

namespace dermis::out::serve {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostShown = 256;  // bytes of which no frame was made

}  // namespace

std::string setup_json(const std::optional<live::sources::SourceName>& name, const FirstLook& found,
                       const std::string& layout) {
  ordered_json json;
  json["name"] = "";
  json["arrays"] = ordered_json::array();
  ordered_json& setup = json["setup"];
  setup["from"] = name ? name->text : "";
  setup["turnable"] = name && name->kind != live::sources::SourceKind::recording;
  setup["readable"] = found.has_frames;
  setup["rows"] = found.shape ? ordered_json(found.shape->rows) : ordered_json();
  setup["cols"] = found.shape ? ordered_json(found.shape->cols) : ordered_json();
  setup["message"] = found.message;
  setup["layout"] = layout;
  setup["bytes"] = hex_of(std::span(found.bytes).first(std::min(found.bytes.size(), kMostShown)));
  return json_text(json);
}

ordered_json counts_json(const std::vector<float>& counts) {
  ordered_json json = ordered_json::array();
  for (const float count : counts) json.push_back(std::isfinite(count) ? ordered_json(count) : ordered_json());
  return json;
}

}  // namespace dermis::out::serve
