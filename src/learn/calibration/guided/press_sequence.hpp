// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "dermis/learn/calibration/calibration_plan.hpp"
#include "dermis/learn/calibration/circuit_fit.hpp"
#include "learn/calibration/guided/held_out_presses.hpp"
#include "learn/calibration/guided/press_order.hpp"

namespace dermis::learn::calibration {

/// The presses of a plan, and pairs beyond it, one of which is asked for: which are kept, which are skipped.
class PressSequence {
 public:
  /// Begins with the first one; `cols` of the array.
  PressSequence(const CalibrationPlan& plan, std::size_t cols);

  /// The press that is asked for.
  [[nodiscard]] std::size_t taxel() const { return pair() ? pair()->first : planned_[step_].taxel; }
  [[nodiscard]] double weight_n() const { return pair() ? pair()->newtons : planned_[step_].weight_n; }
  /// Another taxel, with as much.
  [[nodiscard]] std::optional<std::size_t> together_with() const;
  /// The one or both.
  [[nodiscard]] std::vector<std::size_t> taxels() const;

  /// Asks for these, too, after the others.
  void ask_for(std::vector<PressPair> pairs);
  [[nodiscard]] bool has_pairs() const noexcept { return !pairs_.empty(); }
  /// One is neither kept nor skipped.
  [[nodiscard]] bool has_open() const noexcept {
    return std::find(steps_.begin(), steps_.end(), Step::open) != steps_.end();
  }

  void keep(std::vector<RawFrame> frames);
  void skip() { steps_[step_] = Step::skipped; }
  void skip_rest() { std::replace(steps_.begin(), steps_.end(), Step::open, Step::skipped); }
  /// Asks for the first press that is neither kept nor skipped; false where there is none.
  bool advance();
  /// Asks for the last kept press again; there must be one.
  void repeat();

  [[nodiscard]] const GuidedPresses& kept() const noexcept { return kept_; }
  /// Skipped ones left out.
  [[nodiscard]] std::size_t count() const;

 private:
  enum class Step : std::uint8_t { open, kept, skipped };

  [[nodiscard]] const PressPair* pair() const;

  std::vector<PlannedPress> planned_;
  std::vector<PressPair> pairs_;
  std::vector<Step> steps_;  // of the plan, then of the pairs
  std::size_t step_ = 0;
  GuidedPresses kept_;
  std::vector<std::size_t> kept_steps_;
};

}  // namespace dermis::learn::calibration
