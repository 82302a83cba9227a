// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::touch::compensation {

/// The precision of numbers on the way to a solution.
enum class Precision { single, full };

/// A film over the lines (Readout::film), as the loads on its taxels make it. Loads follow from the conductances of the
/// taxels and the law of the sheet. By that law all taxels have one curve, each on the scale of its own conductance
/// under one same force. Both laws are polygons. Allocates nothing but when it is made.
class FilmFollower {
 public:
  FilmFollower(const ArrayDescription& array, const ReferenceConductances& references);

  /// There is a film.
  [[nodiscard]] bool any() const noexcept { return film_.has_value(); }

  /// The film of these loads from now on.
  void hold(const FilmConductances& film) noexcept;

  /// The film of an unloaded sheet until it follows again.
  void forget() noexcept;

  /// The film of these conductances [rows, stride]; true where they tell it anew.
  bool follow(std::span<const double> siemens, std::size_t stride, Precision precision) noexcept;
  bool follow(std::span<const double> siemens) noexcept { return follow(siemens, cols_, Precision::full); }

  [[nodiscard]] const FilmConductances& film() const noexcept { return conductances_; }

 private:
  /// y = sum over the corners of change max(0, x - corner).
  struct Polygon {
    static constexpr std::size_t kCorners = 8;

    std::array<double, kCorners> x{};
    std::array<double, kCorners> change{};  // of the slope; 0 behind the last corner
  };

  /// [taxels]
  template <typename Real>
  struct Loads {
    std::vector<Real> newtons;
    std::vector<Real> pairs;  // shares of the taxels, then newtons of two
    std::vector<Real> rises;  // of the film between two
  };

  [[nodiscard]] static Polygon polygon_of(const std::vector<double>& x, const std::vector<double>& y);
  template <typename Real>
  void find_loads(std::span<const double> siemens, std::size_t stride, Loads<Real>& loads) noexcept;
  template <typename Real>
  void find_rises(std::size_t distance, Loads<Real>& loads) noexcept;
  std::optional<Film> film_;
  std::size_t rows_;
  std::size_t cols_;
  bool follows_ = false;
  Polygon loads_;                 // share -> newtons
  Polygon rise_;                  // newtons, of two taxels together -> film above the unloaded one
  std::vector<double> unloaded_;  // [taxels] [S]
  std::vector<double> scale_;     // [taxels] 1/S
  Loads<float> single_;
  Loads<double> full_;
  FilmConductances conductances_;
};

}  // namespace dermis::touch::compensation
