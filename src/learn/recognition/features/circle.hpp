// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

namespace dermis::learn::recognition {

/// Angles that part a circle evenly, and the Fourier components of what has a value at each.
template <std::size_t Angles>
class Circle {
 public:
  Circle() {
    for (std::size_t i = 0; i < Angles; ++i) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(Angles);
      cosine_[i] = std::cos(angle);
      sine_[i] = std::sin(angle);
    }
  }

  /// Cosine of the i-th angle; it may go round more than once.
  [[nodiscard]] double cosine(std::size_t i) const noexcept { return cosine_[i % Angles]; }
  [[nodiscard]] double sine(std::size_t i) const noexcept { return sine_[i % Angles]; }

  /// The squared size of a component of `values`, of which those that are missing at the end are 0.
  [[nodiscard]] double power(std::span<const double> values, std::size_t harmonic) const noexcept {
    double real = 0.0;
    double imaginary = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      real += values[i] * cosine(harmonic * i);
      imaginary += values[i] * sine(harmonic * i);
    }
    return real * real + imaginary * imaginary;
  }

 private:
  std::array<double, Angles> cosine_{};
  std::array<double, Angles> sine_{};
};

}  // namespace dermis::learn::recognition
