// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/features/regrid.hpp"

#include <algorithm>
#include <cmath>

#include "learn/recognition/valid_reading.hpp"

namespace dermis::learn::recognition {
namespace {

std::size_t lines_at(std::size_t lines, double pitch, double wanted_pitch) {
  const double exact = std::round(static_cast<double>(lines) * pitch / wanted_pitch);
  return static_cast<std::size_t>(std::clamp(exact, 1.0, static_cast<double>(kMostLines)));
}

/// [from, to]: both divide the same length.
std::vector<double> line_shares(std::size_t from, std::size_t to) {
  const double scale = static_cast<double>(to) / static_cast<double>(from);
  std::vector<double> shares(from * to);
  for (std::size_t line = 0; line < from; ++line) {
    for (std::size_t place = 0; place < to; ++place) {
      const double begin = std::max(scale * static_cast<double>(line), static_cast<double>(place));
      const double end = std::min(scale * static_cast<double>(line + 1), static_cast<double>(place + 1));
      shares[line * to + place] = std::max(end - begin, 0.0) / scale;
    }
  }
  return shares;
}

}  // namespace

Lattice common_lattice(const SensedArray& examples, const SensedArray& source) {
  Lattice lattice{.rows = source.rows, .cols = source.cols};
  if (!examples.has_pitch()) return lattice;
  const double length = std::sqrt(examples.row_pitch_mm * examples.col_pitch_mm);
  lattice.row_step = examples.row_pitch_mm / length;
  lattice.col_step = examples.col_pitch_mm / length;
  if (!source.has_pitch()) return lattice;
  lattice.rows = lines_at(source.rows, source.row_pitch_mm, examples.row_pitch_mm);
  lattice.cols = lines_at(source.cols, source.col_pitch_mm, examples.col_pitch_mm);
  return lattice;
}

Regrid::Regrid(const SensedArray& source, const Lattice& lattice)
    : source_(source),
      lattice_(lattice),
      is_same_(source.rows == lattice.rows && source.cols == lattice.cols),
      of_rows_(is_same_ ? 0 : lattice.rows * source.cols) {
  if (is_same_) return;
  row_shares_ = line_shares(source.rows, lattice.rows);
  col_shares_ = line_shares(source.cols, lattice.cols);
}

void Regrid::apply(std::span<const float> frame, std::span<double> out) {
  const std::span<const float> readings = frame.subspan(source_.first_column, source_.taxel_count());
  if (is_same_) {
    std::transform(readings.begin(), readings.end(), out.begin(), valid_reading);
    return;
  }
  std::fill(of_rows_.begin(), of_rows_.end(), 0.0);
  for (std::size_t line = 0; line < source_.rows; ++line) {
    for (std::size_t row = 0; row < lattice_.rows; ++row) {
      const double share = row_shares_[line * lattice_.rows + row];
      if (share == 0.0) continue;
      for (std::size_t col = 0; col < source_.cols; ++col) {
        of_rows_[row * source_.cols + col] += share * valid_reading(readings[line * source_.cols + col]);
      }
    }
  }
  std::fill(out.begin(), out.end(), 0.0);
  for (std::size_t row = 0; row < lattice_.rows; ++row) {
    for (std::size_t line = 0; line < source_.cols; ++line) {
      const double load = of_rows_[row * source_.cols + line];
      for (std::size_t col = 0; col < lattice_.cols; ++col) {
        out[row * lattice_.cols + col] += load * col_shares_[line * lattice_.cols + col];
      }
    }
  }
}

}  // namespace dermis::learn::recognition
