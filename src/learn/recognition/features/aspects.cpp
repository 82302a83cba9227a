// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/features/aspects.hpp"

#include <array>
#include <cstddef>

namespace dermis::learn::recognition {
namespace {

constexpr std::array kNames{"place", "force", "area", "shape", "time", "the further readings"};  // of FeatureAspect

}  // namespace

std::vector<ExpertColumns> aspect_columns(const Layout& layout, bool moving) {
  std::vector<ExpertColumns> aspects;
  for (const char* name : kNames) aspects.push_back({name, {}});
  std::size_t column = 0;
  for (const BlockColumns& block : feature_columns(layout, moving).blocks) {
    for (const FeatureGroup& group : block.groups) {
      std::vector<std::size_t>& columns = aspects[static_cast<std::size_t>(group.aspect)].columns;
      for (const std::size_t end = column + group.size; column < end; ++column) columns.push_back(column);
    }
  }
  std::erase_if(aspects, [](const ExpertColumns& aspect) { return aspect.columns.empty(); });
  return aspects;
}

}  // namespace dermis::learn::recognition
