// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "calibration/press_hold.hpp"
#include "calibration/touch_sense.hpp"
#include "dermis/calibration/guided_calibration.hpp"
#include "dermis/core/frames.hpp"

namespace dermis::calibration {

/// What a press is on: one taxel, or two at the same time.
struct TaxelsOfPress {
  std::size_t taxel = 0;
  std::optional<std::size_t> together_with = {};

  [[nodiscard]] bool has(std::size_t other) const { return other == taxel || other == together_with; }
};

/// Recognises in the frames of an array that the taxel which is asked for is pressed, held and released, and hints at
/// what the person does instead.
class PressRecogniser {
 public:
  enum class Event : std::uint8_t { none, held, released };

  PressRecogniser(TouchSense sense, Nanos hold_time);

  /// A press is asked for. The material may still show the `last` one for a while.
  void expect(const TaxelsOfPress& asked, const std::optional<TaxelsOfPress>& last);
  /// Nothing is asked for.
  void rest();

  /// `ratio` is what the conditioner made of the frame, `seconds` the time since the frame before.
  Event feed(const RawFrame& raw, std::span<const double> ratio, double seconds);

  /// After Event::held: means of the hold in `count` pieces. From now on the release is waited for.
  std::vector<RawFrame> keep_hold(std::size_t count);

  [[nodiscard]] GuideHint hint() const noexcept { return hint_; }
  /// Of the taxel that is asked for (of two, the first), over that of the unloaded taxel.
  [[nodiscard]] double reading() const noexcept { return reading_; }
  /// Of the hold that is done.
  [[nodiscard]] double share(Nanos now) const noexcept;
  /// As GuideState::pressed_taxel.
  [[nodiscard]] std::optional<std::size_t> pressed_taxel() const noexcept;

 private:
  [[nodiscard]] bool is_foreign(std::optional<std::size_t> taxel) const;
  [[nodiscard]] bool is_pressed_as_asked(std::span<const double> ratio) const;
  void wait_for_press(const RawFrame& raw, std::span<const double> ratio, double seconds);
  void follow_hold(const RawFrame& raw, std::span<const double> ratio);
  [[nodiscard]] bool is_released(std::span<const double> ratio, std::size_t taxel) const;
  [[nodiscard]] bool is_memory(std::span<const double> ratio) const;

  TouchSense sense_;
  PressHold hold_;
  GuideHint hint_ = GuideHint::none;
  TaxelsOfPress asked_;
  std::optional<TaxelsOfPress> last_;
  double kept_excess_ = 0.0;  // of the last hold that was kept
  Touch touch_;
  double reading_ = 1.0;
  double other_seconds_ = 0.0;  // that another taxel is pressed
};

}  // namespace dermis::calibration
