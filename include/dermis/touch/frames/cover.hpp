// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace dermis {

struct ArrayDescription;

/// The share of a force that a cover hands on to a taxel some rows and columns away.
struct CoverShare {
  std::size_t rows = 0;
  std::size_t cols = 0;
  double share = 0.0;  ///< 0 ... 1

  bool operator==(const CoverShare&) const = default;
};

/// Foam, cloth or silicone over the taxels: it spreads a force over the taxels around, alike in all four directions,
/// before they feel it. Forces on the cover are those of the surface, [rows, cols] like the taxels. Shares that would
/// fall beyond the outermost taxels are lost. Without `shares` it is a Gaussian, integrated over a pitch each way.
struct Cover {
  /// Standard deviation of the Gaussian, along rows and columns alike [m]; NaN: calibration is to find the cover.
  double spread_m = std::numeric_limits<double>::quiet_NaN();
  std::vector<CoverShare> shares;  ///< One quadrant of them, with {0, 0}; those that are not named are 0.

  [[nodiscard]] bool is_unknown() const noexcept;
};

/// The shares of an array's cover.
class CoverKernel {
 public:
  /// The cover of `array` must be known; none is a cover that spreads nothing.
  explicit CoverKernel(const ArrayDescription& array);

  /// Most rows and columns to which it spreads.
  [[nodiscard]] std::size_t row_reach() const noexcept { return quadrant_rows_ - 1; }
  [[nodiscard]] std::size_t col_reach() const noexcept { return quadrant_cols_ - 1; }
  /// The share of a force so many rows and columns away.
  [[nodiscard]] double share(std::size_t rows, std::size_t cols) const noexcept {
    return rows < quadrant_rows_ && cols < quadrant_cols_ ? shares_[rows * quadrant_cols_ + cols] : 0.0;
  }
  /// Standard deviation of a Gaussian that keeps as much on a line of taxels, from row to row and from column to
  /// column.
  [[nodiscard]] double row_spread_m() const noexcept { return row_spread_m_; }
  [[nodiscard]] double col_spread_m() const noexcept { return col_spread_m_; }

  /// The forces that the taxels feel of those on the surface [rows, cols], which are other memory. Allocates nothing.
  template <typename Number>
  void spread(std::span<const Number> surface, std::span<Number> felt) const noexcept;

 private:
  void set_gaussian(const ArrayDescription& array);
  void set_shares(const ArrayDescription& array);

  std::size_t rows_;
  std::size_t cols_;
  std::size_t quadrant_rows_ = 1;
  std::size_t quadrant_cols_ = 1;
  std::vector<double> shares_{1.0};  // [quadrant rows, quadrant cols]
  double row_spread_m_ = 0.0;
  double col_spread_m_ = 0.0;
};

/// Share of a Gaussian of this standard deviation, integrated over a pitch, so many pitches away.
[[nodiscard]] double gaussian_share(double spread_pitches, std::size_t pitches) noexcept;

/// The standard deviation of the Gaussian that has this share at its centre, 0.02 ... 1.
[[nodiscard]] double gaussian_spread(double centre_share) noexcept;

}  // namespace dermis
