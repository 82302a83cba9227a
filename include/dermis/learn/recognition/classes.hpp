// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dermis/learn/recognition/segment.hpp"
#include "dermis/learn/recognition/touch_finder.hpp"
#include "dermis/touch/frames/result.hpp"

/// The learned classes; docs/reasons/recognition.md has the equations.
namespace dermis::learn::recognition {

inline constexpr std::size_t kMostClasses = 1000;

/// A linear discriminant on some of the features: y = axes z, z = clip((x - mean) scale, +- 4). y is in the space that
/// the means of the classes span, where the covariance within the classes is 1. Or, with centres, a kernel regression:
/// the score of class k is the sum of influences[c, k] exp(-width |z - centre c|^2).
struct Expert {
  std::string name{};
  double weight = 0.0;                  ///< Weight of its scores in the answer, 0 ... 1e12.
  std::vector<std::int64_t> columns{};  ///< Of the features, rising.
  std::vector<float> mean{};            ///< [columns]
  std::vector<float> scale{};           ///< [columns]
  std::size_t rank = 0;                 ///< Number of axes, at most the classes and at most the columns.
  std::vector<float> axes{};            ///< [rank, columns], at most 1e12 in size
  std::vector<float> class_means{};     ///< [classes, rank], at most 1e12 in size
  std::vector<float> distances{};       ///< Rising: of examples that it had not learned from, to the class answered.
  double width = 0.0;                   ///< Of the kernel, 0 ... 1e12.
  std::vector<float> centres{};         ///< [centres, columns], at most 1e12 in size
  std::vector<float> influences{};      ///< [centres, classes], at most 1e12 in size
  double unknown_weight = 0.0;          ///< Weight of the distance's rank in the unknown score, 0 ... 1e12.

  bool operator==(const Expert&) const = default;
};

struct Classes {
  Layout layout;                       ///< Of the examples.
  bool moving = false;                 ///< Whether time counts: some example has more than one frame.
  std::vector<std::string> names;      ///< Sorted; UTF-8 without control characters, and not "unknown".
  std::vector<std::int64_t> examples;  ///< [classes]
  std::vector<Expert> experts;         ///< At least one.
  std::vector<float> doubts;           ///< Rising: 1 - largest probability, of examples that were not learned from.
  double doubt_weight = 0.0;           ///< Weight of the doubt's rank in the unknown score, 0 ... 1e12.
  double unknown_from = 0.0;           ///< The unknown score from which on the answer is "unknown".
  /// Where touches begin and end, as the labels have it; empty where they leave no frame without a touch.
  std::optional<TouchLimits> touches{};

  /// The first contradiction in it; names no file.
  [[nodiscard]] Status validate() const;
  bool operator==(const Classes&) const = default;
};

}  // namespace dermis::learn::recognition
