// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recognition/features/polar_block.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dermis::recognition {
namespace {

constexpr double kOuterRadius = 2.5;  // of the contact's radius

/// 0 outside of the array.
double taxel_or_nothing(const Lattice& lattice, std::span<const double> image, double row, double col) {
  const bool is_inside =
      row >= 0.0 && col >= 0.0 && row < static_cast<double>(lattice.rows) && col < static_cast<double>(lattice.cols);
  return is_inside ? image[static_cast<std::size_t>(row) * lattice.cols + static_cast<std::size_t>(col)] : 0.0;
}

/// Bilinear; `row` and `col` count taxels.
double sample(const Lattice& lattice, std::span<const double> image, double row, double col) {
  const double above = std::floor(row);
  const double left = std::floor(col);
  const double down = row - above;
  const double right = col - left;
  return (1.0 - down) * ((1.0 - right) * taxel_or_nothing(lattice, image, above, left) +
                         right * taxel_or_nothing(lattice, image, above, left + 1.0)) +
         down * ((1.0 - right) * taxel_or_nothing(lattice, image, above + 1.0, left) +
                 right * taxel_or_nothing(lattice, image, above + 1.0, left + 1.0));
}

}  // namespace

PolarBlock::PolarBlock() {
  for (std::size_t i = 0; i < kAngles; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(kAngles);
    cosine_[i] = std::cos(angle);
    sine_[i] = std::sin(angle);
  }
}

void PolarBlock::write(const ImageAnalysis& analysis, std::span<double> out) {
  const Lattice& lattice = analysis.lattice();
  const Moments& moments = analysis.moments();
  if (!(moments.sum > 0.0)) return std::fill(out.begin(), out.end(), 0.0);
  for (std::size_t ring = 0; ring < kRings; ++ring) {
    const double share = (static_cast<double>(ring) + 0.5) / static_cast<double>(kRings);
    const double radius = share * kOuterRadius * moments.radius;
    for (std::size_t i = 0; i < kAngles; ++i) {
      ring_[i] = sample(lattice, analysis.root(), (moments.row + radius * sine_[i]) / lattice.row_step,
                        (moments.col + radius * cosine_[i]) / lattice.col_step);
    }
    for (std::size_t harmonic = 0; harmonic < kHarmonics; ++harmonic) {
      double real = 0.0;
      double imaginary = 0.0;
      for (std::size_t i = 0; i < kAngles; ++i) {
        real += ring_[i] * cosine_[harmonic * i % kAngles];
        imaginary += ring_[i] * sine_[harmonic * i % kAngles];
      }
      const double scale = (harmonic > 0 ? std::numbers::sqrt2 : 1.0) / static_cast<double>(kAngles);
      out[ring * kHarmonics + harmonic] = scale * std::sqrt(real * real + imaginary * imaginary);
    }
  }
}

}  // namespace dermis::recognition
