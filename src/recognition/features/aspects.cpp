// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recognition/features/aspects.hpp"

#include <algorithm>
#include <array>

#include "recognition/features/form_block.hpp"
#include "recognition/features/time_block.hpp"

namespace dermis::recognition {
namespace {

enum class AspectKind { place, force, area, shape, time, further };
constexpr std::array kNames{"place", "force", "area", "shape", "time", "the further readings"};  // in that order

/// Of a feature by its place in its block.
AspectKind aspect_of(Block block, std::size_t place) {
  const auto is_among = [place](const auto& places) {
    return std::find(places.begin(), places.end(), place) != places.end();
  };
  switch (block) {
    case Block::hog:
    case Block::pose:
    case Block::share: return AspectKind::place;
    case Block::extra: return AspectKind::further;
    case Block::polar: return AspectKind::shape;
    case Block::changed_form: return AspectKind::time;
    case Block::form:
      if (is_among(FormBlock::kForcePlaces)) return AspectKind::force;
      return is_among(FormBlock::kAreaPlaces) ? AspectKind::area : AspectKind::shape;
    default:
      if (is_among(TimeBlock::kForcePlaces)) return AspectKind::force;
      return is_among(TimeBlock::kAreaPlaces) ? AspectKind::area : AspectKind::time;
  }
}

}  // namespace

std::vector<ExpertColumns> aspect_columns(const Layout& layout, bool moving) {
  std::vector<ExpertColumns> aspects;
  for (const char* name : kNames) aspects.push_back({name, {}});
  for (const BlockColumns& block : feature_columns(layout, moving).blocks) {
    for (std::size_t place = 0; place < block.size; ++place) {
      aspects[static_cast<std::size_t>(aspect_of(block.block, place))].columns.push_back(block.begin + place);
    }
  }
  std::erase_if(aspects, [](const ExpertColumns& aspect) { return aspect.columns.empty(); });
  return aspects;
}

}  // namespace dermis::recognition
