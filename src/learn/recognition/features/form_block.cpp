// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/features/form_block.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

namespace dermis::learn::recognition {
namespace {

constexpr double kMediumBlur = 1.4;  // lengths
constexpr double kCoarseBlur = 2.8;

using Out = std::span<double>;

double log_peak_over_sum(const Moments& moments, double least) {
  return std::log(moments.peak + least) - std::log(moments.sum + least);
}

/// E(u^3), E(v^3), E(u^4), E(v^4), E(u^2 v), E(u v^2), E(u^2 v^2) along the principal axes.
void put_principal_moments(const ImageAnalysis& analysis, std::span<double> out) {
  const Lattice& lattice = analysis.lattice();
  const Moments& moments = analysis.moments();
  std::fill(out.begin(), out.end(), 0.0);
  if (!(moments.sum > 0.0)) return;
  for (std::size_t row = 0, taxel = 0; row < lattice.rows; ++row) {
    const double y = static_cast<double>(row) * lattice.row_step - moments.row;
    for (std::size_t col = 0; col < lattice.cols; ++col, ++taxel) {
      const double weight = analysis.image()[taxel] / moments.sum;
      if (weight == 0.0) continue;
      const double x = static_cast<double>(col) * lattice.col_step - moments.col;
      const double u = (x * moments.axis_col + y * moments.axis_row) / moments.major;
      const double v = (y * moments.axis_col - x * moments.axis_row) / moments.minor;
      out[0] += weight * u * u * u;
      out[1] += weight * v * v * v;
      out[2] += weight * u * u * u * u;
      out[3] += weight * v * v * v * v;
      out[4] += weight * u * u * v;
      out[5] += weight * u * v * v;
      out[6] += weight * u * u * v * v;
    }
  }
  if (out[0] >= 0.0) return;
  for (const std::size_t odd : std::array<std::size_t, 4>{0, 1, 4, 5}) out[odd] = -out[odd];  // turned by half a turn
}

/// |c20| |c30| |c21| |c40| |c31| c22 |c50| |c41| |c32| of c_pq = E(z^p conj(z)^q).
void put_complex_moments(const ImageAnalysis& analysis, std::span<double> out) {
  const Lattice& lattice = analysis.lattice();
  const Moments& moments = analysis.moments();
  std::array<std::complex<double>, 9> sums{};
  for (std::size_t row = 0, taxel = 0; row < lattice.rows; ++row) {
    const double y = (static_cast<double>(row) * lattice.row_step - moments.row) / moments.radius;
    for (std::size_t col = 0; col < lattice.cols; ++col, ++taxel) {
      const double weight = analysis.image()[taxel];
      if (weight == 0.0) continue;
      const double x = (static_cast<double>(col) * lattice.col_step - moments.col) / moments.radius;
      const double square = x * x + y * y;  // |z|^2 = z conj(z)
      const double re2 = x * x - y * y;     // z^2
      const double im2 = 2.0 * x * y;
      const double re3 = re2 * x - im2 * y;
      const double im3 = re2 * y + im2 * x;
      sums[0] += std::complex(weight * re2, weight * im2);
      sums[1] += std::complex(weight * re3, weight * im3);
      sums[2] += std::complex(weight * square * x, weight * square * y);
      sums[3] += std::complex(weight * (re2 * re2 - im2 * im2), weight * 2.0 * re2 * im2);
      sums[4] += std::complex(weight * square * re2, weight * square * im2);
      sums[5] += weight * square * square;
      sums[6] += std::complex(weight * (re3 * re2 - im3 * im2), weight * (re3 * im2 + im3 * re2));
      sums[7] += std::complex(weight * square * re3, weight * square * im3);
      sums[8] += std::complex(weight * square * square * x, weight * square * square * y);
    }
  }
  const double scale = moments.sum > 0.0 ? 1.0 / moments.sum : 0.0;
  for (std::size_t i = 0; i < sums.size(); ++i) out[i] = scale * std::abs(sums[i]);
}

/// Root of the share of taxels above some levels. Levels are of the readings, `root` is their root.
void put_level_shares(std::span<const double> root, std::span<double> out) {
  constexpr std::array kLevels{0.05, 0.1, 0.2, 0.4, 0.6, 0.8};
  for (std::size_t i = 0; i < kLevels.size(); ++i) {
    const double level = std::sqrt(kLevels[i]);
    const auto above = std::count_if(root.begin(), root.end(), [&](double value) { return value > level; });
    out[i] = std::sqrt(static_cast<double>(above) / static_cast<double>(root.size()));
  }
}

double root_mean_square_difference(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace

FormBlock::FormBlock(const Lattice& lattice, double least_reading)
    : least_reading_(least_reading),
      areas_(lattice),
      medium_(lattice, kMediumBlur),
      coarse_(lattice, kCoarseBlur),
      sorted_(lattice.taxels()),
      blurred_(lattice.taxels()),
      blurred_more_(lattice.taxels()) {}

constexpr std::array<FeatureRow<FormBlock, ImageAnalysis>, 11> FormBlock::kRows{{
    {{"force and peak", FeatureAspect::force, 2},
     [](FormBlock& block, const ImageAnalysis& analysis, Out out) {
       out[0] = std::log(analysis.moments().sum + block.least_reading_);
       out[1] = std::log(analysis.moments().peak + block.least_reading_);
     }},
    {{"peak over force", FeatureAspect::shape, 1},
     [](FormBlock& block, const ImageAnalysis& analysis, Out out) {
       out[0] = log_peak_over_sum(analysis.moments(), block.least_reading_);
     }},
    {{"axes", FeatureAspect::area, 2},
     [](FormBlock&, const ImageAnalysis& analysis, Out out) {
       out[0] = std::log(analysis.moments().major);
       out[1] = std::log(analysis.moments().minor);
     }},
    {{"elongation", FeatureAspect::shape, 1},
     [](FormBlock&, const ImageAnalysis& analysis, Out out) {
       out[0] = analysis.moments().minor / analysis.moments().major;
     }},
    {{"moments along the axes", FeatureAspect::shape, 7},
     [](FormBlock&, const ImageAnalysis& analysis, Out out) { put_principal_moments(analysis, out); }},
    {{"moments of any direction", FeatureAspect::shape, 9},
     [](FormBlock&, const ImageAnalysis& analysis, Out out) { put_complex_moments(analysis, out); }},
    {{"taxels above levels", FeatureAspect::area, 6},
     [](FormBlock&, const ImageAnalysis& analysis, Out out) { put_level_shares(analysis.root(), out); }},
    {{"connected areas", FeatureAspect::area, 4},
     [](FormBlock& block, const ImageAnalysis& analysis, Out out) { block.put_areas(analysis, out); }},
    {{"quantiles", FeatureAspect::shape, 5},
     [](FormBlock& block, const ImageAnalysis& analysis, Out out) { block.put_quantiles(analysis.root(), out); }},
    {{"directions of edges", FeatureAspect::shape, 6},
     [](FormBlock& block, const ImageAnalysis& analysis, Out out) { block.put_directions(analysis, out); }},
    {{"textures", FeatureAspect::shape, 3},
     [](FormBlock& block, const ImageAnalysis& analysis, Out out) { block.put_textures(analysis, out); }},
}};

std::vector<FeatureGroup> FormBlock::groups() {
  return groups_of(kRows);
}

void FormBlock::write(const ImageAnalysis& analysis, std::span<double> out) {
  write_rows(kRows, *this, analysis, out);
}

void FormBlock::put_areas(const ImageAnalysis& analysis, std::span<double> out) {
  const double low = std::sqrt(0.15);  // of the peak of the readings
  const double high = std::sqrt(0.5);
  const AreaCount above_low = areas_.count(analysis.root(), low);
  const AreaCount above_high = areas_.count(analysis.root(), high);
  const auto taxels = static_cast<double>(analysis.lattice().taxels());
  out[0] = std::sqrt(static_cast<double>(above_low.count));
  out[1] = std::sqrt(static_cast<double>(above_high.count));
  out[2] = static_cast<double>(above_low.largest) / taxels;
  out[3] = static_cast<double>(above_low.second) / taxels;
}

void FormBlock::put_quantiles(std::span<const double> root, std::span<double> out) {
  constexpr std::array kShares{0.25, 0.5, 0.75, 0.9, 0.97};
  std::copy(root.begin(), root.end(), sorted_.begin());
  auto begin = sorted_.begin();  // what is below is done with
  for (std::size_t i = 0; i < kShares.size(); ++i) {
    const double place = kShares[i] * static_cast<double>(sorted_.size() - 1);
    const auto below = sorted_.begin() + static_cast<std::ptrdiff_t>(place);
    std::nth_element(begin, below, sorted_.end());
    const double above = below + 1 < sorted_.end() ? *std::min_element(below + 1, sorted_.end()) : *below;
    out[i] = *below + (place - std::floor(place)) * (above - *below);
    begin = below;
  }
}

/// Sizes of the Fourier components of the histogram of directions.
void FormBlock::put_directions(const ImageAnalysis& analysis, std::span<double> out) const {
  std::array<double, kDirections> histogram{};
  double sum = 0.0;
  for (std::size_t taxel = 0; taxel < analysis.lattice().taxels(); ++taxel) {
    const double size = analysis.steepness()[taxel];
    const double place = analysis.direction()[taxel] * static_cast<double>(kDirections);
    const auto below = static_cast<std::size_t>(place);
    const double upper = size * (place - static_cast<double>(below));
    histogram[below % kDirections] += size - upper;
    histogram[(below + 1) % kDirections] += upper;
    sum += size;
  }
  const double scale = sum > 0.0 ? 1.0 / sum : 0.0;
  for (std::size_t harmonic = 1; harmonic <= out.size(); ++harmonic) {
    out[harmonic - 1] = scale * std::sqrt(directions_.power(histogram, harmonic));
  }
}

/// Writes the detail that is finer than each blur.
void FormBlock::put_textures(const ImageAnalysis& analysis, std::span<double> out) {
  medium_.apply(analysis.normalised(), blurred_);
  coarse_.apply(analysis.normalised(), blurred_more_);
  out[0] = root_mean_square_difference(analysis.normalised(), analysis.smooth());
  out[1] = root_mean_square_difference(analysis.smooth(), blurred_);
  out[2] = root_mean_square_difference(blurred_, blurred_more_);
}

}  // namespace dermis::learn::recognition
