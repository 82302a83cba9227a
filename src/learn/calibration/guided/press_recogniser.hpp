// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dermis/learn/calibration/guided_calibration.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "learn/calibration/guided/press_hold.hpp"
#include "learn/calibration/guided/touch_sense.hpp"

namespace dermis::learn::calibration {

/// Recognises in the frames of an array that the wanted taxels are pressed, held and released, and hints at other
/// actions of the person.
class PressRecogniser {
 public:
  enum class Event : std::uint8_t { none, held, released };

  PressRecogniser(TouchSense sense, Nanos hold_time);

  /// A press is asked for: on one taxel, or on two at the same time.
  void expect(std::vector<std::size_t> taxels);
  /// Nothing is asked for.
  void rest();

  /// `ratio` is what the conditioner made of the frame, `seconds` the time since the frame before.
  Event feed(const RawFrame& raw, std::span<const double> ratio, double seconds);

  /// After Event::held: means of the hold in `count` pieces. From now on the release is waited for.
  std::vector<RawFrame> keep_hold(std::size_t count);

  [[nodiscard]] GuideHint hint() const noexcept { return hint_; }
  /// Reading of one of the wanted taxels, over that of the unloaded taxel.
  [[nodiscard]] double reading(std::size_t asked) const;
  /// Share of the hold that is done.
  [[nodiscard]] double share(Nanos now) const noexcept;
  /// As GuideState::pressed_taxel.
  [[nodiscard]] std::optional<std::size_t> pressed_taxel() const;
  /// As GuideState::missing_taxel.
  [[nodiscard]] std::optional<std::size_t> missing_taxel() const;

 private:
  /// The present touch of the array.
  struct Touch {
    std::optional<std::size_t> strongest;
    std::optional<std::size_t> foreign;  // the strongest one that is not asked for, if it is no mere crosstalk
    std::optional<std::size_t> missing;  // that is asked for and is not pressed
    std::size_t pressed = 0;             // of those that are asked for
  };
  [[nodiscard]] Touch feel(std::span<const double> ratio) const;
  [[nodiscard]] bool is_asked(std::size_t taxel) const;
  [[nodiscard]] bool is_as_asked() const;
  [[nodiscard]] bool is_lost(std::size_t asked) const;
  [[nodiscard]] bool is_released() const;
  [[nodiscard]] GuideHint mistake() const;
  void wait_for_press(const RawFrame& raw, std::span<const double> ratio, double seconds);
  void follow_hold(const RawFrame& raw, std::span<const double> ratio);
  Event wait_for_release(std::span<const double> ratio);

  TouchSense sense_;
  PressHold hold_;
  GuideHint hint_ = GuideHint::none;
  std::vector<std::size_t> asked_;
  std::vector<PressHold::Reading> readings_;  // of those that are asked for
  std::vector<double> relative_;              // the same, over the unloaded taxel
  std::vector<double> kept_excess_;           // the same, of the last hold that was kept
  Touch touch_;
  double wrong_seconds_ = 0.0;  // that something else is pressed
};

}  // namespace dermis::learn::calibration
