// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dermis/learn/recognition/segment.hpp"
#include "learn/recognition/features/feature_group.hpp"

namespace dermis::learn::recognition {

enum class Block { hog, pose, polar, form, time, changed_form, share, extra, pattern, course };

/// Where a block of features stands among all.
struct BlockColumns {
  Block block = Block::hog;
  std::size_t array = 0;  ///< 0 also for what is of all arrays.
  std::size_t begin = 0;
  std::size_t size = 0;
  std::vector<FeatureGroup> groups{};  ///< Of these features, in their order.
};

/// All features of a segment, in their order.
struct FeatureColumns {
  std::vector<BlockColumns> blocks;  ///< Blocks of the first array, of the second ..., then those of all arrays.
  std::size_t count = 0;
};

/// Whether features tell of each taxel: where there are fewer than an image needs, in which all cells have two lines.
[[nodiscard]] bool tells_of_taxels(const Layout& layout);

/// Cells of the histograms along one axis of an array of so many lines.
[[nodiscard]] std::size_t hog_cells(std::size_t lines);

/// `moving`: whether time counts.
[[nodiscard]] FeatureColumns feature_columns(const Layout& layout, bool moving);

/// How an expert learns from its features.
enum class Estimator { discriminant, kernel };

/// The features of one expert.
struct ExpertColumns {
  std::string name;
  std::vector<std::size_t> columns;  ///< Rising.
  Estimator estimator = Estimator::discriminant;
};

/// The experts: place, form, motion (where time counts), all, and state (where there are further readings). Where
/// features tell of each taxel, also taxels, and by kernels pattern and course.
[[nodiscard]] std::vector<ExpertColumns> expert_columns(const Layout& layout, bool moving);

}  // namespace dermis::learn::recognition
