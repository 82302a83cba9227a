// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recognition/features/polar_block.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dermis::recognition {
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
  const Eigen::Index angles = ring_.size();
  for (Eigen::Index i = 0; i < angles; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(angles);
    cosine_[i] = std::cos(angle);
    sine_[i] = std::sin(angle);
  }
  for (Eigen::Index harmonic = 0; harmonic < real_.rows(); ++harmonic) {
    const double scale = (harmonic > 0 ? std::numbers::sqrt2 : 1.0) / static_cast<double>(angles);
    for (Eigen::Index i = 0; i < angles; ++i) {
      real_(harmonic, i) = scale * cosine_[harmonic * i % angles];
      imaginary_(harmonic, i) = scale * sine_[harmonic * i % angles];
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
    for (Eigen::Index i = 0; i < ring_.size(); ++i) {
      ring_[i] = sample(lattice, analysis.root(), (moments.row + radius * sine_[i]) / lattice.row_step,
                        (moments.col + radius * cosine_[i]) / lattice.col_step);
    }
    Eigen::Map<Eigen::Array<double, kHarmonics, 1>> sizes(out.data() + ring * kHarmonics);
    sizes = ((real_ * ring_).array().square() + (imaginary_ * ring_).array().square()).sqrt();
  }
}

}  // namespace dermis::recognition
