// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/labels/place_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <map>

namespace dermis::calibration {
namespace {

constexpr std::size_t kLeastTaxels = 3;  // that show it

/// Frames in which the taxel alone is loaded.
struct Answers {
  std::size_t frames = 0;
  std::size_t of_mirrored = 0;  // the taxel with row and column exchanged rises most

  [[nodiscard]] bool is_exchanged() const noexcept { return 4 * of_mirrored > 3 * frames; }
};

/// The taxel with row and column exchanged, where there is another of that name.
std::optional<std::size_t> mirrored(const ArrayDescription& array, const TaxelRegion& taxel) {
  const bool is_inside = taxel.first_col < array.rows && taxel.first_row < array.cols;
  if (taxel.taxel_count() != 1 || taxel.first_row == taxel.first_col || !is_inside) return std::nullopt;
  return taxel.first_col * array.cols + taxel.first_row;
}

/// By the taxels that are named.
std::map<std::size_t, Answers> answers_of(const ArrayDescription& array, std::span<const FrameSum> sums,
                                          std::span<const Load> loads) {
  std::map<std::size_t, const FrameSum*> sum_of;
  for (const FrameSum& sum : sums) sum_of[sum.frame] = &sum;
  std::map<std::size_t, Answers> answers;
  for (const Load& load : loads) {
    const std::optional<std::size_t> other = mirrored(array, load.where);
    const auto found = sum_of.find(load.frame);
    if (!other || found == sum_of.end() || load.kind != LoadKind::force) continue;
    if (load.value <= 0.0 || load.value < found->second->newtons) continue;
    Answers& taxel = answers[load.where.first_row * array.cols + load.where.first_col];
    ++taxel.frames;
    taxel.of_mirrored += found->second->strongest == *other ? 1 : 0;
  }
  return answers;
}

}  // namespace

std::optional<std::string> find_exchange(const ArrayDescription& array, std::span<const FrameSum> sums,
                                         std::span<const Load> loads) {
  const std::map<std::size_t, Answers> answers = answers_of(array, sums, loads);
  const auto is_exchanged = [](const auto& taxel) { return taxel.second.is_exchanged(); };
  const auto exchanged = static_cast<std::size_t>(std::count_if(answers.begin(), answers.end(), is_exchanged));
  if (exchanged < kLeastTaxels || 4 * exchanged <= 3 * answers.size()) return std::nullopt;
  const std::size_t named = std::find_if(answers.begin(), answers.end(), is_exchanged)->first;
  const std::size_t other = named % array.cols * array.cols + named / array.cols;
  return fmt::format(
      "the loads exchange rows and columns: {} answers where they name {}, as in {} of {} taxels that tell; exchange "
      "them in loads.csv, or turn the frames (transpose=1)",
      array.taxel_name(other), array.taxel_name(named), exchanged, answers.size());
}

}  // namespace dermis::calibration
