// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/shapes.hpp"

#include <algorithm>

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kMostChoices = 2;
constexpr std::size_t kMostArrays = 16;

}  // namespace

bool is_known(const FrameShape& shape, const Known& known) {
  return shape.rows == known.rows.value_or(shape.rows) && shape.cols == known.cols.value_or(shape.cols);
}

std::vector<std::vector<FrameShape>> shapes_of(const std::vector<std::size_t>& sizes, const Readings& frames,
                                               const Known& known) {
  const std::size_t taxels = known.rows.value_or(0) * known.cols.value_or(0);
  const bool are_side_by_side = sizes.size() == 1 && taxels > 0 && sizes.front() % taxels == 0 &&
                                sizes.front() / taxels > 1 && sizes.front() / taxels <= kMostArrays;
  if (are_side_by_side) {
    return {std::vector(sizes.front() / taxels, FrameShape{*known.rows, *known.cols})};
  }
  std::vector<std::vector<FrameShape>> choices;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    // Only the first array's readings are at hand; the others are as smooth as any.
    const bool is_same = sizes[k] == sizes.front();
    const std::vector<FrameShape> likely =
        likely_shapes(is_same ? frames : Readings(), sizes[k], k == 0 || is_same ? known : Known());
    if (likely.empty()) return {};
    if (k == 0) choices.resize(std::min(likely.size(), kMostChoices));
    for (std::size_t i = 0; i < choices.size(); ++i) choices[i].push_back(likely[std::min(i, likely.size() - 1)]);
  }
  return choices;
}

}  // namespace dermis::bytes::proposals
