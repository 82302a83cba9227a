// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "dermis/touch/frames/frames.hpp"
#include "touch/compensation/faults/untouched.hpp"

namespace dermis::touch::compensation {

inline constexpr double kComparedSigmas = 50.0;  // readings whose equality means something
inline constexpr double kEqualSigmas = 3.0;
inline constexpr double kDifferentSigmas = 5.0;
inline constexpr double kEqualShare = 0.01;     // drivers and ADC channels are alike to this
inline constexpr double kStandsOut = 2.0;       // times what others read
inline constexpr std::size_t kSlide = 1;        // taxels from one frame to the next
inline constexpr double kPressEvidence = 18.0;  // log-likelihood ratio that decides: a false alarm in 6e7 tries

/// Presses on a line that are evidence for a short, since the last one against it. A press counts once, however long it
/// lasts and wherever it slides: until nothing is pressed any more near the place where it was last. Its evidence is
/// that of its clearest frame.
struct PressCount {
  double evidence = 0.0;
  int against = 0;  // frames in a row
  std::size_t first_frame = 0;
  Nanos first_time{};
  std::size_t least_place = 0;  // of those that were counted
  std::size_t most_place = 0;
  std::optional<std::size_t> held_place;  // where the press that was counted is now
  double held_evidence = 0.0;             // its evidence so far

  /// Call it in every frame, before add(). `is_pressed(place)`: whether the line is pressed there in this frame.
  template <typename IsPressed>
  void follow(std::size_t places, const IsPressed& is_pressed) {
    if (!held_place) return;
    const std::size_t held = *held_place;
    held_place.reset();
    for (std::size_t step = 0; step <= kSlide && !held_place; ++step) {
      if (held + step < places && is_pressed(held + step)) {
        held_place = held + step;
      } else if (step <= held && is_pressed(held - step)) {
        held_place = held - step;
      }
    }
  }

  /// A press at this place, which may be the one that lasts.
  void add(std::size_t place, double of_press, std::size_t frame, Nanos time) {
    if (held_place) {
      evidence += std::max(of_press - held_evidence, 0.0);
      held_evidence = std::max(of_press, held_evidence);
      return;
    }
    if (evidence == 0.0) {
      first_frame = frame;
      first_time = time;
      least_place = most_place = place;
    }
    held_place = place;
    held_evidence = of_press;
    evidence += of_press;
    least_place = std::min(least_place, place);
    most_place = std::max(most_place, place);
  }

  /// Presses at one place may all come from one tool, so they do not suffice.
  [[nodiscard]] bool decides() const { return evidence >= kPressEvidence && most_place - least_place >= kContactReach; }

  /// There is half the evidence that decides.
  [[nodiscard]] bool is_suspicious() const { return 2.0 * evidence >= kPressEvidence; }
};

}  // namespace dermis::touch::compensation
