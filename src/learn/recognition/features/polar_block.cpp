// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/features/polar_block.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "learn/recognition/matrix.hpp"

namespace dermis::learn::recognition {
namespace {

constexpr double kOuterRadius = 2.5;  // of the contact's radius

/// Bilinear; `row` and `col` count taxels. Outside of the array there is 0.
double sample(const Lattice& lattice, std::span<const double> image, double row, double col) {
  const auto rows = static_cast<std::ptrdiff_t>(lattice.rows);
  const auto cols = static_cast<std::ptrdiff_t>(lattice.cols);
  const bool is_near = row > -1.0 && col > -1.0 && row < static_cast<double>(rows) && col < static_cast<double>(cols);
  if (!is_near) return 0.0;
  const auto above = static_cast<std::ptrdiff_t>(row + 1.0) - 1;
  const auto left = static_cast<std::ptrdiff_t>(col + 1.0) - 1;
  const double down = row - static_cast<double>(above);
  const double right = col - static_cast<double>(left);
  const auto between = [&](std::ptrdiff_t line) {
    if (line < 0 || line >= rows) return 0.0;
    const double* const values = image.data() + line * cols;
    return (left >= 0 ? (1.0 - right) * values[left] : 0.0) + (left + 1 < cols ? right * values[left + 1] : 0.0);
  };
  return (1.0 - down) * between(above) + down * between(above + 1);
}

}  // namespace

PolarBlock::PolarBlock() {
  for (std::size_t harmonic = 0; harmonic < kHarmonics; ++harmonic) {
    const double scale = (harmonic > 0 ? std::numbers::sqrt2 : 1.0) / static_cast<double>(kAngles);
    for (std::size_t i = 0; i < kAngles; ++i) {
      real_(index(harmonic), index(i)) = scale * angles_.cosine(harmonic * i);
      imaginary_(index(harmonic), index(i)) = scale * angles_.sine(harmonic * i);
    }
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
      ring_[index(i)] = sample(lattice, analysis.root(), (moments.row + radius * angles_.sine(i)) / lattice.row_step,
                               (moments.col + radius * angles_.cosine(i)) / lattice.col_step);
    }
    Eigen::Map<Eigen::Array<double, kHarmonics, 1>> sizes(out.data() + ring * kHarmonics);
    sizes = ((real_ * ring_).array().square() + (imaginary_ * ring_).array().square()).sqrt();
  }
}

}  // namespace dermis::learn::recognition
