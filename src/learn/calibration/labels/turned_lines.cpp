// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/labels/turned_lines.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "dermis/learn/calibration/turned_lines.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kLeastTaxels = 3;  // that show it

/// How frames may be turned, and what mends it.
struct Turn {
  bool exchanges = false;  // rows and columns
  bool flips_rows = false;
  bool flips_cols = false;
  const char* words = "";
  const char* mend = "";
};

constexpr Turn kTurns[] = {
    {true, false, false, "the loads exchange rows and columns",
     "exchange them in loads.csv, or turn the frames (transpose=1)"},
    {false, true, false, "the loads count the rows from the other end than the frames",
     "turn the frames (flip_rows=1), or count the other way in loads.csv"},
    {false, false, true, "the loads count the columns from the other end than the frames",
     "turn the frames (flip_cols=1), or count the other way in loads.csv"},
    {false, true, true, "the loads count rows and columns from the other ends than the frames",
     "turn the frames (flip_rows=1&flip_cols=1), or count the other way in loads.csv"},
};

/// Frames in which the taxel alone is loaded.
struct Answers {
  std::size_t frames = 0;
  std::size_t of_other = 0;  // the taxel rises most that has its place in turned frames

  [[nodiscard]] bool is_turned() const noexcept { return 4 * of_other > 3 * frames; }
};

/// The taxel that has this place in turned frames, where it is another one.
std::optional<std::size_t> other_taxel(const ArrayDescription& array, const TaxelRegion& taxel, const Turn& turn) {
  if (taxel.taxel_count() != 1) return std::nullopt;
  std::size_t row = turn.flips_rows ? array.rows - 1 - taxel.first_row : taxel.first_row;
  std::size_t col = turn.flips_cols ? array.cols - 1 - taxel.first_col : taxel.first_col;
  if (turn.exchanges) std::swap(row, col);
  if (row >= array.rows || col >= array.cols) return std::nullopt;
  if (row == taxel.first_row && col == taxel.first_col) return std::nullopt;
  return array.index(row, col);
}

/// By the taxels that are named.
std::map<std::size_t, Answers> answers_of(const ArrayDescription& array, std::span<const FrameSum> sums,
                                          std::span<const Load> loads, const Turn& turn) {
  std::map<std::size_t, const FrameSum*> sum_of;
  for (const FrameSum& sum : sums) sum_of[sum.frame] = &sum;
  std::map<std::size_t, Answers> answers;
  for (const Load& load : loads) {
    const std::optional<std::size_t> other = other_taxel(array, load.where, turn);
    const auto found = sum_of.find(load.frame);
    if (!other || found == sum_of.end() || load.kind != LoadKind::force) continue;
    if (load.value <= 0.0 || load.value < found->second->newtons) continue;
    Answers& taxel = answers[array.index(load.where.first_row, load.where.first_col)];
    ++taxel.frames;
    taxel.of_other += found->second->strongest == *other ? 1 : 0;
  }
  return answers;
}

std::optional<std::string> find_turn(const ArrayDescription& array, std::span<const FrameSum> sums,
                                     std::span<const Load> loads, const Turn& turn) {
  const std::map<std::size_t, Answers> answers = answers_of(array, sums, loads, turn);
  const auto is_turned = [](const auto& taxel) { return taxel.second.is_turned(); };
  const auto turned = static_cast<std::size_t>(std::count_if(answers.begin(), answers.end(), is_turned));
  if (turned < kLeastTaxels || 4 * turned <= 3 * answers.size()) return std::nullopt;
  const std::size_t named = std::find_if(answers.begin(), answers.end(), is_turned)->first;
  const TaxelRegion where{named / array.cols, named % array.cols, named / array.cols, named % array.cols};
  return fmt::format("{}: {} answers where they name {}, as in {} of {} taxels that tell; {}", turn.words,
                     array.taxel_name(*other_taxel(array, where, turn)), array.taxel_name(named), turned,
                     answers.size(), turn.mend);
}

}  // namespace

std::optional<std::string> find_turn(const ArrayDescription& array, std::span<const FrameSum> sums,
                                     std::span<const Load> loads) {
  for (const Turn& turn : kTurns) {
    if (auto found = find_turn(array, sums, loads, turn)) return found;
  }
  return std::nullopt;
}

std::optional<std::string> find_turned_lines(const ArrayDescription& array, std::span<const RawFrame> frames,
                                             std::span<const Load> loads) {
  return find_turn(array, sum_frames(array, frames, loads, Nanos{0}), loads);
}

}  // namespace dermis::learn::calibration
