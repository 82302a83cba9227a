// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "dermis/touch/compensation/circuit_model.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "learn/calibration/sheet/single_presses.hpp"
#include "learn/calibration/sheet/taxel_curves.hpp"

namespace dermis::learn::calibration {

/// Presses of single taxels under films that are tried, without an inversion. The circuit reads what is expected: idle
/// taxels, the pressed one as its own reading tells it, those around it as the cover has it. Any other reading
/// becomes a conductance of its own taxel. It is right where the film is, and never fails where it is not.
class PredictedPresses {
 public:
  /// `curves`: of the taxels about as with the films, which bend that of the sheet alone; refers to them. Empty: no
  /// frames, or a circuit that cannot be solved.
  static std::optional<PredictedPresses> create(const ArrayDescription& array, const LabelledPresses& presses,
                                                const TaxelCurves& curves);

  /// A cover that the array does not name follows, from `start` on, from the taxels across the corners of presses.
  [[nodiscard]] SinglePresses under(const Film& film, const std::optional<Cover>& start);

  /// That of the last film; empty: none.
  [[nodiscard]] const std::optional<Cover>& cover() const noexcept { return cover_; }
  /// Those of the last film.
  [[nodiscard]] const TaxelCurves& curves() const noexcept { return curves_; }

 private:
  PredictedPresses(const ArrayDescription& array, const LabelledPresses& presses, const TaxelCurves& curves);

  void find_idle();
  [[nodiscard]] SinglePresses predict();
  [[nodiscard]] std::vector<double> predict(touch::compensation::CircuitModel& model, const LabelledFrame& press) const;
  void follow_cover(const SinglePresses& single);

  ArrayDescription array_;
  std::shared_ptr<const CircuitFrames> frames_;
  std::vector<LabelledFrame> idle_frames_;
  std::vector<LabelledFrame> presses_;
  std::vector<touch::compensation::CircuitModel> models_;  // one for each task
  std::vector<double> idle_;                               // [taxels] [S]
  std::vector<SinglePress> idle_presses_;
  std::optional<Cover> cover_;
  const TaxelCurves& near_film_;
  TaxelCurves curves_;
};

}  // namespace dermis::learn::calibration
