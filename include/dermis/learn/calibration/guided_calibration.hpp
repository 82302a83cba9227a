// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/learn/calibration/calibrate.hpp"
#include "dermis/learn/calibration/calibration_plan.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::calibration {

enum class GuideStage : std::uint8_t { none, unloaded, pressing, fitting, done, failed };

/// The advice to the person besides the wanted press.
enum class GuideHint : std::uint8_t {
  none,
  press,        ///< Put the weight on.
  hold,         ///< It is on: hold still.
  release,      ///< The press is kept: take the weight off.
  other_taxel,  ///< GuideState::pressed_taxel is pressed instead; of two, in the place of one or of both.
  unsteady,     ///< The reading moves: the hold began anew.
  too_short,    ///< The weight was taken off before the hold was over.
  several,      ///< GuideState::pressed_taxel is pressed, too.
  one_of_two,   ///< GuideState::pressed_taxel is pressed; GuideState::missing_taxel is still to be.
};

/// The state of a guided calibration as a person sees it. Many members: clients show each of them.
struct GuideState {
  GuideStage stage = GuideStage::none;
  GuideHint hint = GuideHint::none;
  std::string message;                       ///< For a person: the next action, the result or the problem.
  std::size_t taxel = 0;                     ///< To be pressed, row-major.
  double weight_n = 0.0;                     ///< With.
  std::optional<std::size_t> together_with;  ///< Another taxel, to be pressed at the same time with as much.
  double reading = 1.0;                      ///< Reading of `taxel` now over the unloaded one: 1 unloaded, rising.
  std::optional<double> together_reading;    ///< The same of `together_with`.
  double hold_share = 0.0;                   ///< Done share of the quiet time, the hold or the last fit, 0 ... 1.
  std::optional<std::size_t> pressed_taxel;  ///< The one that is pressed though it should not; else that feels most.
  std::optional<std::size_t> missing_taxel;  ///< The one of two that is not pressed while the other is.
  std::size_t presses_done = 0;
  std::size_t presses_total = 0;                   ///< Skipped ones left out.
  std::optional<double> median_relative_error;     ///< Error of the fit so far on presses it did not see.
  std::optional<double> unpressed_relative_error;  ///< The same on taxels of which it saw no press.
  std::vector<std::uint8_t> taxel_presses;         ///< Kept presses of each taxel.
};

/// Everything that was measured, as frames.csv and loads.csv have it.
struct GuidedData {
  std::vector<RawFrame> frames;
  std::vector<Load> loads;
};

/// Walks a person through the calibration of one live array: unloaded first, then press after press, each recognised
/// from the frames. While the person works, what is there is fitted on a thread of its own and judged by presses that
/// were left out. Where they do not determine the circuit, the pairs of taxels that would are asked for after the last
/// press, once. Thread-safe.
class GuidedCalibration {
 public:
  /// Errors: those of CalibrationPlan::validate(); an array that is not valid.
  [[nodiscard]] static Result<std::unique_ptr<GuidedCalibration>> create(ArrayDescription array, CalibrationPlan plan);
  GuidedCalibration(const GuidedCalibration&) = delete;
  GuidedCalibration& operator=(const GuidedCalibration&) = delete;
  /// Waits for a fit that is going on.
  ~GuidedCalibration();

  /// The next frame of the array; quick. Frames that cannot be used are passed over.
  void feed(const RawFrame& raw);

  /// Leaves the present press out. Errors: not pressing.
  [[nodiscard]] Status skip();
  /// Forgets the last press and asks for it again; also after a fit that failed. Errors: no press yet; fitting; done.
  [[nodiscard]] Status repeat();
  /// Fits with the presses that are there. Errors: no press yet; not pressing.
  [[nodiscard]] Status finish();

  [[nodiscard]] GuideState state() const;

  /// The result of stage `done`; null before.
  [[nodiscard]] std::shared_ptr<const Calibration> calibration() const;
  [[nodiscard]] GuidedData data() const;

 private:
  class Implementation;
  explicit GuidedCalibration(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::learn::calibration
