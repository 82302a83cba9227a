// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/features/image_analysis.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace dermis::learn::recognition {
namespace {

constexpr double kSmoothing = 0.7;    // lengths
constexpr double kLeastSpread = 0.3;  // lengths: that of a contact on a single taxel
constexpr double kKernelReach = 3.0;  // standard deviations

/// For lines of so many taxels; of a very wide one the tails, which fold back on all of them, are left out.
std::vector<double> gaussian_kernel(double sigma, std::size_t lines) {
  const double most = 2.0 * static_cast<double>(lines);
  const auto reach = static_cast<std::ptrdiff_t>(std::min(std::ceil(kKernelReach * sigma), most));
  std::vector<double> kernel;
  for (std::ptrdiff_t place = -reach; place <= reach; ++place) {
    const double distance = static_cast<double>(place) / sigma;
    kernel.push_back(std::exp(-0.5 * distance * distance));
  }
  const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
  for (double& weight : kernel) weight /= sum;
  return kernel;
}

/// The place among `count` that lies `place` steps from the first, mirrored at both ends.
std::size_t mirrored(std::ptrdiff_t place, std::size_t count) {
  const auto period = static_cast<std::ptrdiff_t>(2 * count);
  const auto within = static_cast<std::size_t>(((place % period) + period) % period);
  return within < count ? within : 2 * count - 1 - within;
}

/// All places that a kernel of so many taps reaches.
std::vector<std::size_t> mirrored_places(std::size_t count, std::size_t taps) {
  std::vector<std::size_t> places;
  const auto reach = static_cast<std::ptrdiff_t>(taps / 2);
  for (std::size_t i = 0; i + 1 < count + taps; ++i) {
    places.push_back(mirrored(static_cast<std::ptrdiff_t>(i) - reach, count));
  }
  return places;
}

/// out = sum of kernel[tap] line_at(tap), [count]. Lines that weigh the same are added first: the kernel is symmetric.
template <typename LineAt>
void blend(std::span<const double> kernel, const LineAt& line_at, std::size_t count, double* out) {
  const auto length = static_cast<Eigen::Index>(count);
  const auto line = [&](std::size_t tap) { return Eigen::Map<const Eigen::ArrayXd>(line_at(tap), length); };
  const std::size_t middle = kernel.size() / 2;
  Eigen::Map<Eigen::ArrayXd> sums(out, length);
  sums = kernel[middle] * line(middle);
  for (std::size_t tap = 0; tap < middle; ++tap) sums += kernel[tap] * (line(tap) + line(kernel.size() - 1 - tap));
}

/// Slope of a line of `count` values `stride` apart, at `place`: central, one-sided at the ends.
double slope(std::span<const double> values, std::size_t at, std::size_t place, std::size_t count, std::size_t stride) {
  if (count < 2) return 0.0;
  const std::size_t before = place > 0 ? at - stride : at;
  const std::size_t after = place + 1 < count ? at + stride : at;
  const double steps = place > 0 && place + 1 < count ? 2.0 : 1.0;
  return (values[after] - values[before]) / steps;
}

struct SecondMoments {
  double rows = 0.0;
  double cols = 0.0;
  double both = 0.0;
};

SecondMoments second_moments(const Lattice& lattice, std::span<const double> image, const Moments& moments) {
  SecondMoments second;
  for (std::size_t row = 0, taxel = 0; row < lattice.rows; ++row) {
    const double y = static_cast<double>(row) * lattice.row_step - moments.row;
    for (std::size_t col = 0; col < lattice.cols; ++col, ++taxel) {
      const double x = static_cast<double>(col) * lattice.col_step - moments.col;
      second.rows += image[taxel] * y * y;
      second.cols += image[taxel] * x * x;
      second.both += image[taxel] * y * x;
    }
  }
  return {second.rows / moments.sum, second.cols / moments.sum, second.both / moments.sum};
}

void set_axes(Moments& moments, const SecondMoments& second) {
  const double mean = 0.5 * (second.rows + second.cols);
  const double half = std::hypot(0.5 * (second.cols - second.rows), second.both);
  const double angle = 0.5 * std::atan2(2.0 * second.both, second.cols - second.rows);  // from the columns' direction
  moments.axis_col = std::cos(angle);
  moments.axis_row = std::sin(angle);
  moments.major = std::sqrt(std::max(mean + half, 0.0)) + kLeastSpread;
  moments.minor = std::sqrt(std::max(mean - half, 0.0)) + kLeastSpread;
  moments.radius = std::sqrt(std::max(2.0 * mean, 0.0)) + kLeastSpread;
}

}  // namespace

Moments moments_of(const Lattice& lattice, std::span<const double> image) {
  Moments moments{.major = kLeastSpread, .minor = kLeastSpread, .radius = kLeastSpread};
  for (std::size_t row = 0, taxel = 0; row < lattice.rows; ++row) {
    for (std::size_t col = 0; col < lattice.cols; ++col, ++taxel) {
      const double value = image[taxel];
      moments.sum += value;
      moments.row += value * static_cast<double>(row);
      moments.col += value * static_cast<double>(col);
      moments.peak = std::max(moments.peak, value);
    }
  }
  if (!(moments.sum > 0.0)) return moments;
  moments.row *= lattice.row_step / moments.sum;
  moments.col *= lattice.col_step / moments.sum;
  set_axes(moments, second_moments(lattice, image, moments));
  return moments;
}

GaussianBlur::GaussianBlur(const Lattice& lattice, double sigma)
    : rows_(lattice.rows),
      cols_(lattice.cols),
      row_kernel_(gaussian_kernel(sigma / lattice.row_step, lattice.rows)),
      col_kernel_(gaussian_kernel(sigma / lattice.col_step, lattice.cols)),
      row_places_(mirrored_places(rows_, row_kernel_.size())),
      col_places_(mirrored_places(cols_, col_kernel_.size())),
      between_(cols_),
      padded_(col_places_.size()) {}

void GaussianBlur::apply(std::span<const double> image, std::span<double> out) {
  for (std::size_t row = 0; row < rows_; ++row) {
    const auto row_at = [&](std::size_t tap) { return image.data() + row_places_[row + tap] * cols_; };
    blend(row_kernel_, row_at, cols_, between_.data());
    for (std::size_t place = 0; place < padded_.size(); ++place) padded_[place] = between_[col_places_[place]];
    const auto shifted = [&](std::size_t tap) { return padded_.data() + tap; };
    blend(col_kernel_, shifted, cols_, out.data() + row * cols_);
  }
}

ImageAnalysis::ImageAnalysis(const Lattice& lattice)
    : lattice_(lattice),
      blur_(lattice, kSmoothing),
      image_(lattice.taxels()),
      root_(lattice.taxels()),
      normal_(lattice.taxels()),
      smooth_(lattice.taxels()),
      steepness_(lattice.taxels()),
      direction_(lattice.taxels()) {}

void ImageAnalysis::analyse(std::span<const double> image) {
  std::copy(image.begin(), image.end(), image_.begin());
  moments_ = moments_of(lattice_, image_);
  const double of_root = moments_.peak > 0.0 ? 1.0 / std::sqrt(moments_.peak) : 0.0;
  const double of_normal = moments_.sum > 0.0 ? std::sqrt(static_cast<double>(lattice_.taxels()) / moments_.sum) : 0.0;
  for (std::size_t taxel = 0; taxel < image_.size(); ++taxel) {
    const double root = std::sqrt(image_[taxel]);
    root_[taxel] = root * of_root;
    normal_[taxel] = root * of_normal;
  }
  blur_.apply(normal_, smooth_);
  differentiate();
}

void ImageAnalysis::differentiate() {
  for (std::size_t row = 0, taxel = 0; row < lattice_.rows; ++row) {
    for (std::size_t col = 0; col < lattice_.cols; ++col, ++taxel) {
      const double along_rows = slope(smooth_, taxel, row, lattice_.rows, lattice_.cols) / lattice_.row_step;
      const double along_cols = slope(smooth_, taxel, col, lattice_.cols, 1) / lattice_.col_step;
      const double size = std::sqrt(along_rows * along_rows + along_cols * along_cols);
      const double angle = size > 0.0 ? std::atan2(along_rows, along_cols) / std::numbers::pi : 0.0;  // -1 ... 1
      steepness_[taxel] = size;
      direction_[taxel] = angle < 0.0 ? angle + 1.0 : angle;
    }
  }
}

}  // namespace dermis::learn::recognition
