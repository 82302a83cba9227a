// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "dermis/touch/compensation/crosstalk.hpp"

namespace dermis::touch::compensation {

/// The inversion of the same circuit with rows and columns exchanged.
class Transposed final : public CrosstalkInversion {
 public:
  /// `inversion` is for [cols, rows].
  Transposed(std::unique_ptr<CrosstalkInversion> inversion, std::size_t rows, std::size_t cols)
      : inversion_(std::move(inversion)),
        rows_(rows),
        cols_(cols),
        ratio_(rows * cols),
        values_(rows * cols),
        film_(cols, rows) {
    shorted_.reserve(rows * cols);
    broken_.reserve(3 * (rows + cols));
  }

  [[nodiscard]] InversionResult invert(std::span<const double> ratio, std::span<double> siemens) noexcept override {
    transpose(ratio, rows_, cols_, ratio_);
    transpose(siemens, rows_, cols_, values_);
    const InversionResult result = inversion_->invert(ratio_, values_);
    transpose(values_, cols_, rows_, siemens);
    return result;
  }
  [[nodiscard]] bool set_shorted(std::span<const std::size_t> taxels) noexcept override {
    shorted_.clear();
    for (const std::size_t taxel : taxels) shorted_.push_back(taxel % cols_ * rows_ + taxel / cols_);
    return inversion_->set_shorted(shorted_);
  }
  [[nodiscard]] bool set_broken(std::span<const LineFault> faults) noexcept override {
    broken_.clear();
    for (LineFault fault : faults) {
      const auto exchanged = exchange(fault.kind);
      const LineFaultScope scope = traits_of(fault.kind).scope;
      if (scope == LineFaultScope::taxel || scope == LineFaultScope::driver) continue;
      if (!exchanged || broken_.size() == broken_.capacity()) {
        static_cast<void>(inversion_->set_broken({}));
        return false;
      }
      fault.kind = *exchanged;
      broken_.push_back(fault);
    }
    return inversion_->set_broken(broken_);
  }
  void hold_film(const FilmConductances& film) noexcept override {
    film_.between_rows = film.between_cols;
    film_.between_cols = film.between_rows;
    inversion_->hold_film(film_);
  }
  bool start_frame(Nanos time) noexcept override { return inversion_->start_frame(time); }
  void start_attempt(double share) noexcept override { inversion_->start_attempt(share); }
  void forget() noexcept override { inversion_->forget(); }
  void propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept override {
    inversion_->propagate_noise(sigma_ratio, values_);
    transpose(values_, cols_, rows_, sigma_siemens);
  }
  [[nodiscard]] double siemens_per_ratio() const noexcept override { return inversion_->siemens_per_ratio(); }

 private:
  /// The same fault with rows and columns exchanged; none where a line is at the supply.
  static std::optional<LineFaultKind> exchange(LineFaultKind kind) noexcept {
    switch (kind) {
      case LineFaultKind::silent_row: return LineFaultKind::silent_column;
      case LineFaultKind::silent_column: return LineFaultKind::silent_row;
      case LineFaultKind::shorted_rows: return LineFaultKind::shorted_columns;
      case LineFaultKind::shorted_columns: return LineFaultKind::shorted_rows;
      default: return std::nullopt;
    }
  }

  static void transpose(std::span<const double> from, std::size_t rows, std::size_t cols,
                        std::span<double> to) noexcept {
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t col = 0; col < cols; ++col) to[col * rows + row] = from[row * cols + col];
    }
  }

  std::unique_ptr<CrosstalkInversion> inversion_;
  std::size_t rows_;
  std::size_t cols_;
  std::vector<double> ratio_;   // [cols, rows]
  std::vector<double> values_;  // [cols, rows]
  FilmConductances film_;       // [cols, rows]
  std::vector<std::size_t> shorted_;
  std::vector<LineFault> broken_;
};

}  // namespace dermis::touch::compensation
