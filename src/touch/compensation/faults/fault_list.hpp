// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dermis/touch/compensation/line_fault.hpp"
#include "dermis/touch/frames/axis.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "touch/compensation/joined_lines.hpp"

namespace dermis::touch::compensation {

/// Why the reading of a taxel is not its own.
inline constexpr std::uint8_t kRowCause = 1;
inline constexpr std::uint8_t kColumnCause = 2;
inline constexpr std::uint8_t kStuckCause = 4;
inline constexpr std::uint8_t kDeadCause = 8;
inline constexpr std::uint8_t kPairCause = 16;

inline constexpr PerAxis<std::uint8_t> kLineCause{.row = kRowCause, .column = kColumnCause};

/// The faults found so far, and the taxels that they mask.
class FaultList {
 public:
  explicit FaultList(const ArrayDescription& array);

  /// In the order in which they were found.
  [[nodiscard]] std::span<const LineFault> all() const noexcept { return faults_; }
  [[nodiscard]] std::span<LineFault> all() noexcept { return faults_; }

  [[nodiscard]] bool contains(LineFaultKind kind, std::size_t place) const noexcept {
    return std::any_of(faults_.begin(), faults_.end(),
                       [&](const LineFault& fault) { return fault.kind == kind && fault.place == place; });
  }
  [[nodiscard]] bool contains(LineFaultKind kind) const noexcept {
    return std::any_of(faults_.begin(), faults_.end(), [&](const LineFault& fault) { return fault.kind == kind; });
  }

  /// Does nothing when the list is full: there are more faults than a repair would look at.
  void add(const LineFault& fault) noexcept;
  void remove(LineFaultKind kind, std::size_t place) noexcept;

  /// Readings that are not the taxels' own in this frame, found or not: `taxel_of` each of `suspects`.
  template <typename Suspects, typename TaxelOf>
  void suspect(const Suspects& suspects, const TaxelOf& taxel_of) noexcept {
    const auto is_same = [&](std::size_t taxel, const auto& suspect) { return taxel == taxel_of(suspect); };
    if (std::equal(suspected_.begin(), suspected_.end(), suspects.begin(), suspects.end(), is_same)) return;
    suspected_.clear();
    for (const auto& suspect : suspects) suspected_.push_back(taxel_of(suspect));
    mask_taxels();
  }

  /// Counts how often the list has changed.
  [[nodiscard]] std::size_t changes() const noexcept { return changes_; }
  void count_change() noexcept { ++changes_; }

  /// Bits of kRowCause ... kPairCause; 0: the reading is the taxel's own.
  [[nodiscard]] std::uint8_t causes(std::size_t taxel) const noexcept { return causes_[taxel]; }

  /// 1 where the taxel is evidence on its line. 0 where another fault than that of the line masks it, or it is dead.
  [[nodiscard]] std::span<const float> witnesses(Axis axis) const noexcept { return witnesses_[axis]; }

 private:
  void forget_dead_taxels(const LineFault& line) noexcept;
  void mask_taxels() noexcept;
  void mark_joined_lines() noexcept;

  const ArrayDescription& array_;
  std::vector<LineFault> faults_;
  JoinedLines lines_;
  std::vector<std::uint8_t> causes_;       // [taxels]
  PerAxis<std::vector<float>> witnesses_;  // [taxels]
  std::vector<std::size_t> suspected_;     // taxels
  std::size_t changes_ = 0;
};

}  // namespace dermis::touch::compensation
