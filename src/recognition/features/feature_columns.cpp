// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recognition/features/feature_columns.hpp"

#include <algorithm>
#include <initializer_list>
#include <numeric>

#include "recognition/features/form_block.hpp"
#include "recognition/features/hog_block.hpp"
#include "recognition/features/polar_block.hpp"
#include "recognition/features/pose_block.hpp"
#include "recognition/features/time_block.hpp"

namespace dermis::recognition {
namespace {

constexpr std::size_t kMostCells = 6;

void add(FeatureColumns& columns, Block block, std::size_t size) {
  if (size == 0) return;
  columns.blocks.push_back({block, columns.count, size});
  columns.count += size;
}

ExpertColumns expert_of(const std::string& name, const FeatureColumns& all, std::initializer_list<Block> blocks) {
  ExpertColumns expert{name, {}};
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

FeatureColumns feature_columns(const Layout& layout, bool moving) {
  FeatureColumns columns;
  for (const SensedArray& array : layout.arrays) {
    add(columns, Block::hog, HogBlock::kOrientations * hog_cells(array.rows) * hog_cells(array.cols));
    add(columns, Block::pose, kPoseSize);
    add(columns, Block::polar, PolarBlock::kSize);
    add(columns, Block::form, FormBlock::kSize);
    if (!moving) continue;
    add(columns, Block::time, TimeBlock::kSize);
    add(columns, Block::changed_form, FormBlock::kSize);
  }
  if (layout.arrays.size() > 1) add(columns, Block::share, layout.arrays.size());
  add(columns, Block::extra, 2 * layout.extras);
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
  return experts;
}

}  // namespace dermis::recognition
