// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace dermis::learn::recognition {

/// The meaning of features, in plain words.
enum class FeatureAspect { place, force, area, shape, time, further };

/// Features of a block that stand side by side and mean the same.
struct FeatureGroup {
  const char* name;
  FeatureAspect aspect;
  std::size_t size;
};

/// A row of the table of a block: features, and what writes them from what the block looks at.
template <typename Block, typename Source>
struct FeatureRow {
  FeatureGroup group;
  void (*write)(Block& block, const Source& source, std::span<double> out);
};

template <typename Rows>
[[nodiscard]] std::vector<FeatureGroup> groups_of(const Rows& rows) {
  std::vector<FeatureGroup> groups;
  for (const auto& row : rows) groups.push_back(row.group);
  return groups;
}

/// Writes all rows, one behind the other.
template <typename Rows, typename Block, typename Source>
void write_rows(const Rows& rows, Block& block, const Source& source, std::span<double> out) {
  for (const auto& row : rows) {
    row.write(block, source, out.first(row.group.size));
    out = out.subspan(row.group.size);
  }
}

}  // namespace dermis::learn::recognition
