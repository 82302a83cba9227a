// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "touch/compensation/sensed_line.hpp"

namespace dermis::touch::compensation {

/// The lines of an array as its readout scans them, the driven ones counted first, then the sensed ones. Each has a
/// resistance rho at its head: the driver, or what stands between the line and the node that the amplifier holds. While
/// it is not scanned a line stays tied to its rho, or floats.
class ScannedLines {
 public:
  explicit ScannedLines(const ArrayDescription& array);

  /// Replaces the resistances of the drivers and loads [ohm].
  void set_resistors(std::span<const double> drive_ohm, std::span<const double> load_ohm);

  /// The film of an array that has one, at first an unloaded one. Allocates nothing.
  void set_film(const FilmConductances& film) noexcept { film_ = film; }
  [[nodiscard]] const FilmConductances& film() const noexcept { return film_; }
  [[nodiscard]] bool has_film() const noexcept { return array_.readout.film.has_value(); }

  [[nodiscard]] const ArrayDescription& array() const noexcept { return array_; }
  [[nodiscard]] std::size_t taxels() const noexcept { return array_.taxel_count(); }
  [[nodiscard]] std::size_t driven() const noexcept { return driven_; }
  [[nodiscard]] std::size_t sensed() const noexcept { return rho_.size() - driven_; }
  [[nodiscard]] std::size_t count() const noexcept { return rho_.size(); }

  [[nodiscard]] bool driven_are_tied() const noexcept { return driven_are_tied_; }
  [[nodiscard]] bool sensed_are_tied() const noexcept { return sensed_are_tied_; }
  [[nodiscard]] bool is_tied(std::size_t line) const noexcept {
    return line < driven_ ? driven_are_tied_ : sensed_are_tied_;
  }
  /// Tied without resistance: its head is at a given potential.
  [[nodiscard]] bool is_held(std::size_t line) const noexcept { return is_tied(line) && rho_[line] == 0.0; }
  [[nodiscard]] std::vector<bool> held() const;  // [lines]

  [[nodiscard]] double rho(std::size_t line) const noexcept { return rho_[line]; }
  [[nodiscard]] const SensedLine& sensed_head(std::size_t sensed) const noexcept { return sensed_head_[sensed]; }

  /// Resistance of the supply, which the current of the driven line lowers; 0 where it is part of rho.
  [[nodiscard]] double supply_ohm() const noexcept { return supply_ohm_; }

  [[nodiscard]] bool is_row(std::size_t line) const noexcept { return (line < driven_) != columns_are_driven_; }
  /// The row or column that the line is.
  [[nodiscard]] std::size_t number(std::size_t line) const noexcept { return line < driven_ ? line : line - driven_; }
  /// From one taxel of the line to the next.
  [[nodiscard]] double segment_ohm(std::size_t line) const noexcept;
  [[nodiscard]] std::size_t row_line(std::size_t row) const noexcept {
    return columns_are_driven_ ? driven_ + row : row;
  }
  [[nodiscard]] std::size_t column_line(std::size_t col) const noexcept {
    return columns_are_driven_ ? col : driven_ + col;
  }

  /// Where the reading of a driven and a sensed line stands.
  [[nodiscard]] std::size_t reading(std::size_t driven, std::size_t sensed) const noexcept {
    return columns_are_driven_ ? array_.index(sensed, driven) : array_.index(driven, sensed);
  }

  /// visit(driven, sensed, reading) for all readings.
  template <typename Visit>
  void for_each_reading(const Visit& visit) const {
    for (std::size_t d = 0; d < driven(); ++d) {
      for (std::size_t s = 0; s < sensed(); ++s) visit(d, s, reading(d, s));
    }
  }

 private:
  void read_resistors();

  ArrayDescription array_;
  FilmConductances film_;
  bool columns_are_driven_;
  bool driven_are_tied_;
  bool sensed_are_tied_;
  std::size_t driven_;
  double series_ohm_;  // of the supply, in rho of the driven lines
  double supply_ohm_;
  std::vector<double> rho_;              // [lines]
  std::vector<SensedLine> sensed_head_;  // [sensed]
};

}  // namespace dermis::touch::compensation
