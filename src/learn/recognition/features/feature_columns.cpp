// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/features/feature_columns.hpp"

#include <algorithm>
#include <initializer_list>
#include <numeric>
#include <utility>

#include "learn/recognition/features/form_block.hpp"
#include "learn/recognition/features/hog_block.hpp"
#include "learn/recognition/features/polar_block.hpp"
#include "learn/recognition/features/pose_block.hpp"
#include "learn/recognition/features/taxel_block.hpp"
#include "learn/recognition/features/time_block.hpp"

namespace dermis::learn::recognition {
namespace {

constexpr std::size_t kMostCells = 6;

void add(FeatureColumns& columns, Block block, std::size_t array, std::vector<FeatureGroup> groups) {
  std::size_t size = 0;
  for (const FeatureGroup& group : groups) size += group.size;
  columns.blocks.push_back({block, array, columns.count, size, std::move(groups)});
  columns.count += size;
}

/// All that changes is a feature of time.
std::vector<FeatureGroup> changed(std::vector<FeatureGroup> groups) {
  for (FeatureGroup& group : groups) group.aspect = FeatureAspect::time;
  return groups;
}

ExpertColumns expert_of(const std::string& name, const FeatureColumns& all, std::initializer_list<Block> blocks,
                        Estimator estimator = Estimator::discriminant) {
  ExpertColumns expert{name, {}, estimator};
  for (const BlockColumns& block : all.blocks) {
    if (std::find(blocks.begin(), blocks.end(), block.block) == blocks.end()) continue;
    const std::size_t before = expert.columns.size();
    expert.columns.resize(before + block.size);
    std::iota(expert.columns.begin() + static_cast<std::ptrdiff_t>(before), expert.columns.end(), block.begin);
  }
  return expert;
}

}  // namespace

std::size_t hog_cells(std::size_t lines) {
  return std::clamp<std::size_t>(lines / 2, 1, kMostCells);
}

bool tells_of_taxels(const Layout& layout) {
  constexpr std::size_t kLines = 2 * kMostCells;
  return taxels_of(layout) <= kLines * kLines;
}

FeatureColumns feature_columns(const Layout& layout, bool moving) {
  FeatureColumns columns;
  for (std::size_t i = 0; i < layout.arrays.size(); ++i) {
    const SensedArray& array = layout.arrays[i];
    add(columns, Block::hog, i, {HogBlock::group(hog_cells(array.rows), hog_cells(array.cols))});
    add(columns, Block::pose, i, {kPoseGroup});
    add(columns, Block::polar, i, {PolarBlock::group()});
    add(columns, Block::form, i, FormBlock::groups());
    if (!moving) continue;
    add(columns, Block::time, i, TimeBlock::groups());
    add(columns, Block::changed_form, i, changed(FormBlock::groups()));
  }
  if (layout.arrays.size() > 1) {
    add(columns, Block::share, 0, {{"shares of the force", FeatureAspect::place, layout.arrays.size()}});
  }
  if (layout.extras > 0) {
    add(columns, Block::extra, 0,
        {{"at the end", FeatureAspect::further, layout.extras},
         {"since the beginning", FeatureAspect::further, layout.extras}});
  }
  if (tells_of_taxels(layout)) {
    add(columns, Block::pattern, 0, {TaxelBlock::pattern_group(layout)});
    add(columns, Block::course, 0, TaxelBlock::course_groups(layout, moving));
  }
  return columns;
}

std::vector<ExpertColumns> expert_columns(const Layout& layout, bool moving) {
  const FeatureColumns all = feature_columns(layout, moving);
  std::vector<ExpertColumns> experts;
  experts.push_back(expert_of("place", all, {Block::hog, Block::pose}));
  experts.push_back(expert_of("form", all, {Block::form, Block::polar, Block::share}));
  if (moving) experts.push_back(expert_of("motion", all, {Block::time, Block::changed_form}));
  experts.push_back(expert_of("all", all, {Block::form, Block::time, Block::pose, Block::share, Block::extra}));
  if (layout.extras > 0) experts.push_back(expert_of("state", all, {Block::extra, Block::share, Block::pose}));
  if (tells_of_taxels(layout)) {
    experts.push_back(expert_of("taxels", all, {Block::pattern, Block::course}));
    experts.push_back(expert_of("pattern", all, {Block::pattern}, Estimator::kernel));
    experts.push_back(expert_of("course", all, {Block::course}, Estimator::kernel));
  }
  return experts;
}

}  // namespace dermis::learn::recognition
