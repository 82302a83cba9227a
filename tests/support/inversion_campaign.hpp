// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include "dermis/touch/compensation/circuit_model.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/circuits.hpp"

/// Random arrays whose readings are inverted: does every taxel come back?
namespace dermis::support {

inline std::vector<double> model_ratios(const ArrayDescription& array, const std::vector<double>& siemens) {
  auto model = touch::compensation::CircuitModel::create(array);
  model->solve(siemens);
  return {model->ratio().begin(), model->ratio().end()};
}

/// Largest relative difference.
inline double distance(const std::vector<double>& values, const std::vector<double>& expected) {
  double largest = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    largest = std::fmax(largest, std::abs(values[k] / expected[k] - 1.0));
  }
  return largest;
}

/// The sign of det(d ratio / d siemens), by Gauss elimination with pivoting.
inline int orientation(const ArrayDescription& array, const std::vector<double>& siemens) {
  const std::size_t size = siemens.size();
  std::vector<double> matrix(size * size);
  auto model = touch::compensation::CircuitModel::create(array);
  model->solve(siemens);
  model->taxel_jacobian(matrix);
  int sign = 1;
  for (std::size_t k = 0; k < size; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < size; ++i) {
      if (std::abs(matrix[i * size + k]) > std::abs(matrix[pivot * size + k])) pivot = i;
    }
    if (pivot != k) {
      sign = -sign;
      for (std::size_t j = k; j < size; ++j) std::swap(matrix[k * size + j], matrix[pivot * size + j]);
    }
    if (matrix[k * size + k] < 0.0) sign = -sign;
    for (std::size_t i = k + 1; i < size; ++i) {
      const double factor = matrix[i * size + k] / matrix[k * size + k];
      for (std::size_t j = k; j < size; ++j) matrix[i * size + j] -= factor * matrix[k * size + j];
    }
  }
  return sign;
}

struct Campaign {
  int returned = 0;   ///< Arrays whose every taxel came back to 1e-8
  int ambiguous = 0;  ///< Beyond a fold of the readings: another array explains them too, and that was found
  int failed = 0;
  double worst = 0.0;  ///< Relative error of a taxel that came back
};

inline void try_array(const ArrayDescription& array, Random& random, Campaign& campaign) {
  const auto siemens = random_siemens(array, random);
  const auto ratio = model_ratios(array, siemens);
  std::vector<double> inverted(siemens.size());
  const bool solved =
      touch::compensation::make_crosstalk_inversion(array, {0.0}).value()->invert(ratio, inverted).solved;
  const double error = distance(inverted, siemens);
  if (solved && error <= 1e-8) {
    ++campaign.returned;
    campaign.worst = std::max(campaign.worst, error);
  } else if (solved && orientation(array, siemens) < 0) {
    ++campaign.ambiguous;
  } else {
    ++campaign.failed;
    std::printf("  %zux%zu: solved %d, error %.1e, readings off by %.1e\n", array.rows, array.cols, solved, error,
                distance(model_ratios(array, inverted), ratio));
  }
}

/// Inverts `arrays` random arrays of this circuit and size, seeds from 1 on.
inline Campaign campaign_of(const NamedCircuit& circuit, std::size_t rows, std::size_t cols, int arrays) {
  Campaign campaign;
  for (int seed = 1; seed <= arrays; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    try_array(random_array(circuit, rows, cols, random), random, campaign);
  }
  return campaign;
}

}  // namespace dermis::support
