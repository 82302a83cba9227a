// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "calibration/held_out_presses.hpp"
#include "dermis/calibration/calibration_plan.hpp"

namespace dermis::calibration {

/// The presses of a plan, one of which is asked for: which are kept, which are skipped.
class PressSequence {
 public:
  /// Begins with the first one.
  explicit PressSequence(CalibrationPlan plan);

  /// The press that is asked for.
  [[nodiscard]] std::size_t taxel() const { return plan_.taxel_of(step_); }
  [[nodiscard]] double weight_n() const { return plan_.weight_of(step_); }

  void keep(std::vector<RawFrame> frames);
  void skip() { steps_[step_] = Step::skipped; }
  /// Asks for the first press that is neither kept nor skipped; false where there is none.
  bool advance();
  /// Asks for the last kept press again; there must be one.
  void repeat();

  [[nodiscard]] const GuidedPresses& kept() const noexcept { return kept_; }
  /// Of the last kept press.
  [[nodiscard]] std::optional<std::size_t> last_taxel() const;
  /// Skipped ones left out.
  [[nodiscard]] std::size_t count() const;

 private:
  enum class Step : std::uint8_t { open, kept, skipped };

  CalibrationPlan plan_;
  std::vector<Step> steps_;
  std::size_t step_ = 0;
  GuidedPresses kept_;
  std::vector<std::size_t> kept_steps_;
};

}  // namespace dermis::calibration
