// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/faults/line_sums.hpp"

#include <algorithm>
#include <cstddef>

#include "dermis/touch/frames/processor_clones.hpp"

namespace dermis::touch::compensation {
namespace {

inline double sum_of(std::span<const double> values) {
  const double* const value = values.data();
  double sum = 0.0;
#pragma omp simd reduction(+ : sum)
  for (std::size_t k = 0; k < values.size(); ++k) sum += value[k];
  return sum;
}

}  // namespace

LineSums::LineSums(const ArrayDescription& array)
    : array_(array),
      ratio_{std::vector<double>(array.rows), std::vector<double>(array.cols)},
      driven_siemens_(array.driven_lines()) {}

void LineSums::sum(const ConditionedFrame& conditioned, const ConductanceFrame& conductance, bool solved) noexcept {
  sum_readings(conditioned.ratio);
  std::fill(driven_siemens_.begin(), driven_siemens_.end(), 0.0);
  if (solved) sum_conductances(conductance.siemens);
}

DERMIS_PROCESSOR_CLONES void LineSums::sum_readings(std::span<const double> ratio) noexcept {
  const std::size_t cols = array_.cols;
  double* const columns = ratio_.column.data();
  std::fill_n(columns, cols, 0.0);
  for (std::size_t row = 0; row < array_.rows; ++row) {
    const std::span<const double> readings = ratio.subspan(row * cols, cols);
    ratio_.row[row] = sum_of(readings);
    for (std::size_t col = 0; col < cols; ++col) columns[col] += readings[col];
  }
}

DERMIS_PROCESSOR_CLONES void LineSums::sum_conductances(std::span<const double> siemens) noexcept {
  const std::size_t cols = array_.cols;
  const bool by_row = driven_axis(array_) == Axis::row;
  for (std::size_t row = 0; row < array_.rows; ++row) {
    const std::span<const double> conductances = siemens.subspan(row * cols, cols);
    if (by_row) {
      driven_siemens_[row] = sum_of(conductances);
    } else {
      for (std::size_t col = 0; col < cols; ++col) driven_siemens_[col] += conductances[col];
    }
  }
}

}  // namespace dermis::touch::compensation
