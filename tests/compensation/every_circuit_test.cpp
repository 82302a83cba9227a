// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Every inversion against its forward model.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dermis/compensation/circuit_model.hpp"
#include "dermis/compensation/crosstalk.hpp"
#include "dermis/core/random.hpp"
#include "dermis/simulation/readout_circuit.hpp"
#include "support/allocation_guard.hpp"
#include "support/circuits.hpp"

namespace dermis::compensation {
namespace {

using support::NamedCircuit;
using support::random_array;
using support::random_siemens;

class EveryInversion : public testing::TestWithParam<NamedCircuit> {};

INSTANTIATE_TEST_SUITE_P(CrosstalkInversion, EveryInversion, testing::ValuesIn(support::all_circuits()),
                         [](const auto& info) { return info.param.name; });

std::unique_ptr<CrosstalkInversion> inversion_for(const ArrayDescription& array, const InversionOptions& options = {}) {
  auto inversion = make_crosstalk_inversion(array, options);
  EXPECT_TRUE(inversion) << inversion.error().message;
  return std::move(*inversion);
}

std::vector<double> model_ratios(const ArrayDescription& array, const std::vector<double>& siemens) {
  auto model = CircuitModel::create(array);
  model->solve(siemens);
  return {model->ratio().begin(), model->ratio().end()};
}

std::vector<double> simulated_ratios(const ArrayDescription& array, const std::vector<double>& siemens) {
  std::vector<double> ratio(siemens.size());
  simulation::ReadoutCircuit::create(array)->ratios(siemens, ratio);
  return ratio;
}

/// Largest relative difference.
double distance(const std::vector<double>& values, const std::vector<double>& expected) {
  double largest = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    largest = std::fmax(largest, std::abs(values[k] / expected[k] - 1.0));
  }
  return largest;
}

/// The sign of det(d ratio / d siemens), by Gauss elimination with pivoting.
int orientation(const ArrayDescription& array, const std::vector<double>& siemens) {
  const std::size_t size = siemens.size();
  std::vector<double> matrix(size * size);
  auto model = CircuitModel::create(array);
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
  int returned = 0;   // arrays whose every taxel came back to 1e-8
  int ambiguous = 0;  // another solution of the same readings
  int failed = 0;
  double worst = 0.0;  // relative error of a taxel that came back
};

void try_array(const ArrayDescription& array, Random& random, Campaign& campaign) {
  const auto siemens = random_siemens(array, random);
  const auto ratio = model_ratios(array, siemens);
  std::vector<double> inverted(siemens.size());
  const bool solved = inversion_for(array, {0.0})->invert(ratio, inverted).solved;
  const double error = distance(inverted, siemens);
  if (solved && error <= 1e-8) {
    ++campaign.returned;
    campaign.worst = std::max(campaign.worst, error);
  } else if (solved && distance(model_ratios(array, inverted), ratio) <= 1e-11 && orientation(array, siemens) < 0) {
    ++campaign.ambiguous;
  } else {
    ++campaign.failed;
    std::printf("  %zux%zu: solved %d, error %.1e, readings off by %.1e\n", array.rows, array.cols, solved, error,
                distance(model_ratios(array, inverted), ratio));
  }
}

Campaign campaign_of(const NamedCircuit& circuit, std::size_t rows, std::size_t cols, int arrays) {
  Campaign campaign;
  for (int seed = 1; seed <= arrays; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    try_array(random_array(circuit, rows, cols, random), random, campaign);
  }
  return campaign;
}

void print(const NamedCircuit& circuit, std::size_t rows, std::size_t cols, const Campaign& campaign) {
  std::printf("%-46s %2zux%-2zu returned %3d, two solutions %2d, failed %2d, largest error %.1e\n",
              circuit.name.c_str(), rows, cols, campaign.returned, campaign.ambiguous, campaign.failed, campaign.worst);
}

TEST_P(EveryInversion, DISABLED_campaign) {
  for (const std::size_t size : {2, 4, 8, 12, 16}) {
    print(GetParam(), size, size, campaign_of(GetParam(), size, size, 100));
  }
  print(GetParam(), 32, 32, campaign_of(GetParam(), 32, 32, 5));
}

}  // namespace
}  // namespace dermis::compensation
