// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace dermis::learn::recognition {

/// The taxels of an array and how far apart they are, as multiples of the geometric mean of both pitches: lengths count
/// such means.
struct Lattice {
  std::size_t rows = 1;
  std::size_t cols = 1;
  double row_step = 1.0;
  double col_step = 1.0;

  [[nodiscard]] std::size_t taxels() const noexcept { return rows * cols; }
};

/// Moments of an image taken as a distribution; all 0 but the sizes where the image is empty.
struct Moments {
  double sum = 0.0;
  double peak = 0.0;
  double row = 0.0;       ///< Centre, in lengths from r0c0.
  double col = 0.0;       ///< The same along the columns.
  double major = 0.0;     ///< Standard deviation along the major axis + 0.3.
  double minor = 0.0;     ///< Standard deviation across it + 0.3.
  double radius = 0.0;    ///< Root of the sum of both variances + 0.3.
  double axis_row = 0.0;  ///< Unit vector of the major axis.
  double axis_col = 1.0;
};

[[nodiscard]] Moments moments_of(const Lattice& lattice, std::span<const double> image);

/// Convolution with a Gaussian, mirrored at the edges.
class GaussianBlur {
 public:
  GaussianBlur(const Lattice& lattice, double sigma);

  /// `out` must not be `image`. Not thread-safe.
  void apply(std::span<const double> image, std::span<double> out);

 private:
  std::size_t rows_;
  std::size_t cols_;
  std::vector<double> row_kernel_;  ///< Odd, symmetric, sums to 1.
  std::vector<double> col_kernel_;
  std::vector<std::size_t> row_places_;  ///< Rows from the reach of the kernel above the first on, mirrored.
  std::vector<std::size_t> col_places_;
  std::vector<double> between_;  ///< A row, blurred across the rows.
  std::vector<double> padded_;   ///< The same, mirrored at both ends.
};

/// One image and what several blocks of features are computed from. Allocates only when made. Not thread-safe.
class ImageAnalysis {
 public:
  explicit ImageAnalysis(const Lattice& lattice);

  /// `image`: [rows, cols], at least 0.
  void analyse(std::span<const double> image);

  [[nodiscard]] const Lattice& lattice() const noexcept { return lattice_; }
  [[nodiscard]] const Moments& moments() const noexcept { return moments_; }
  [[nodiscard]] std::span<const double> image() const noexcept { return image_; }
  [[nodiscard]] std::span<const double> root() const noexcept { return root_; }          ///< Over its largest: 0 ... 1.
  [[nodiscard]] std::span<const double> normalised() const noexcept { return normal_; }  ///< Root with an RMS of 1.
  [[nodiscard]] std::span<const double> smooth() const noexcept { return smooth_; }  ///< Normalised, blurred by 0.7.
  /// Size of the gradient of smooth().
  [[nodiscard]] std::span<const double> steepness() const noexcept { return steepness_; }
  /// Direction of the gradient of smooth() without sign, 0 ... 1 for 0 ... pi.
  [[nodiscard]] std::span<const double> direction() const noexcept { return direction_; }

 private:
  void differentiate();

  Lattice lattice_;
  Moments moments_;
  GaussianBlur blur_;
  std::vector<double> image_;
  std::vector<double> root_;
  std::vector<double> normal_;
  std::vector<double> smooth_;
  std::vector<double> steepness_;
  std::vector<double> direction_;
};

}  // namespace dermis::learn::recognition
