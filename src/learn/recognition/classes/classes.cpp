// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/classes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "learn/recognition/features/feature_columns.hpp"
#include "learn/recognition/names.hpp"

namespace dermis::learn::recognition {
namespace {

constexpr std::size_t kMostExperts = 8;
constexpr double kMostMagnitude = 1e12;  // of axes and means: their products stay within a float

bool are_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

bool are_moderate(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](float value) { return std::abs(static_cast<double>(value)) <= kMostMagnitude; });
}

bool is_weight(double value) {
  return value >= 0.0 && value <= kMostMagnitude;
}

bool are_ranks(const std::vector<float>& values) {
  return !values.empty() && are_finite(values) && std::is_sorted(values.begin(), values.end()) &&
         values.front() >= 0.0F;
}

Status check_columns(const Expert& expert, std::size_t feature_count) {
  const bool rise =
      std::adjacent_find(expert.columns.begin(), expert.columns.end(), std::greater_equal<>()) == expert.columns.end();
  const bool fit = expert.columns.empty() ||
                   (expert.columns.front() >= 0 && expert.columns.back() < static_cast<std::int64_t>(feature_count));
  if (!rise || !fit) return bad_input("expert '" + expert.name + "' names features that do not exist");
  return Done{};
}

Status check_expert(const Expert& expert, std::size_t feature_count, std::size_t class_count) {
  if (!is_plain_text(expert.name)) return bad_input("the name of an expert must be UTF-8 without control characters");
  const std::size_t columns = expert.columns.size();
  if (Status checked = check_columns(expert, feature_count); !checked) return checked;
  const bool has_sizes = expert.mean.size() == columns && expert.scale.size() == columns &&
                         expert.rank <= std::min(class_count, columns) && expert.axes.size() == expert.rank * columns &&
                         expert.class_means.size() == class_count * expert.rank &&
                         expert.centres.size() * class_count == expert.influences.size() * columns;
  if (!has_sizes) return bad_input("expert '" + expert.name + "' has tables of the wrong size");
  const bool has_numbers = are_finite(expert.mean) && are_finite(expert.scale) && are_moderate(expert.axes) &&
                           are_moderate(expert.class_means) && are_moderate(expert.centres) &&
                           are_moderate(expert.influences) && are_ranks(expert.distances);
  if (!has_numbers || !is_weight(expert.weight) || !is_weight(expert.width) || !is_weight(expert.unknown_weight)) {
    return bad_input("expert '" + expert.name + "' holds values out of range");
  }
  return Done{};
}

}  // namespace

Status Classes::validate() const {
  if (Status checked = layout.validate(); !checked) return checked;
  if (names.size() < 2 || names.size() > kMostClasses) return bad_input("there must be 2 to 1000 classes");
  const bool are_distinct = std::adjacent_find(names.begin(), names.end(), std::greater_equal<>()) == names.end();
  if (!are_distinct || names.front().empty()) return bad_input("the names of the classes must be sorted and distinct");
  for (const std::string& name : names) {
    if (Status checked = check_class_name(name); !checked) return checked;
  }
  const bool has_counts = examples.size() == names.size() &&
                          std::all_of(examples.begin(), examples.end(), [](std::int64_t count) { return count > 0; });
  if (!has_counts) return bad_input("each class must have examples");
  if (experts.empty() || experts.size() > kMostExperts) return bad_input("there must be 1 to 8 experts");
  const std::size_t feature_count = feature_columns(layout, moving).count;
  for (const Expert& expert : experts) {
    if (Status checked = check_expert(expert, feature_count, names.size()); !checked) return checked;
  }
  if (!are_ranks(doubts) || !is_weight(doubt_weight) || !std::isfinite(unknown_from))
    return bad_input("the unknown score is out of range");
  return touches ? touches->validate() : Done{};
}

}  // namespace dermis::learn::recognition
