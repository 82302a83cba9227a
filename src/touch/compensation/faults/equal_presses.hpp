// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

namespace dermis::touch::compensation {

/// A press that reads the same on two lines at one place: how the lines compare at its other places.
struct PressComparison {
  int equal = 0;  // places
  int more = 0;   // on the first line, beyond the noise
  int less = 0;

  [[nodiscard]] int places() const { return equal + more + less; }
};

/// How improbable equal readings of healthy lines are, as the lines of this array show. Two lines may be pressed alike
/// at one place by chance. Taxels that scatter then differ at the others, some up and some down. Where all taxels are
/// the same, or the shape of the presses alone makes them differ, lines that are equal once are equal everywhere.
class EqualPresses {
 public:
  void add(const PressComparison& press);

  [[nodiscard]] EqualPresses without(const EqualPresses& others) const;

  /// Minus logarithm of the chance that so many more places are equal; 0 until taxels have been seen to scatter.
  [[nodiscard]] double evidence(int places) const;

 private:
  [[nodiscard]] double chance_of_place() const;

  double presses_ = 0.0;    // with two other places at least
  double all_equal_ = 0.0;  // of these,
  double expected_ = 0.0;   // and how many would be, were places independent
  double scattered_ = 0.0;  // of these: with places both ways
  double places_ = 0.0;     // of all presses
  double equal_places_ = 0.0;
};

}  // namespace dermis::touch::compensation
