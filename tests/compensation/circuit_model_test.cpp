// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/compensation/circuit_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "dermis/core/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/circuits.hpp"
#include "support/nodal_readout.hpp"

namespace dermis::compensation {
namespace {

using support::NamedCircuit;
using support::random_array;
using support::random_siemens;

class EveryCircuit : public testing::TestWithParam<NamedCircuit> {};

INSTANTIATE_TEST_SUITE_P(CircuitModel, EveryCircuit, testing::ValuesIn(support::all_circuits()),
                         [](const auto& info) { return info.param.name; });

CircuitModel model_of(const ArrayDescription& array) {
  auto model = CircuitModel::create(array);
  EXPECT_TRUE(model) << model.error().message;
  return std::move(*model);
}

std::vector<double> ratios_of(CircuitModel& model, const std::vector<double>& siemens) {
  model.solve(siemens);
  return {model.ratio().begin(), model.ratio().end()};
}

/// Half of the lines get no resistance of any kind.
void take_resistances_away(ArrayDescription& array, Random& random) {
  Readout& readout = array.readout;
  for (auto* ohms :
       {&readout.drive_ohm, &readout.column_switch_ohm, &readout.row_segment_ohm, &readout.column_segment_ohm}) {
    for (double& ohm : *ohms) ohm = random.below(2) == 0 ? 0.0 : ohm;
  }
  if (random.below(2) == 0) readout.amplifier_gain.reset();
}

TEST_P(EveryCircuit, readings_are_those_of_the_nodal_equations) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    auto array = random_array(GetParam(), 1 + random.below(5), 1 + random.below(5), random);
    if (seed % 2 == 0) take_resistances_away(array, random);
    const auto siemens = random_siemens(array, random);
    auto model = model_of(array);
    const auto ratio = ratios_of(model, siemens);
    const auto expected = support::NodalReadout(array).ratios(siemens);
    for (std::size_t k = 0; k < ratio.size(); ++k) {
      ASSERT_NEAR(ratio[k], expected[k], 1e-9 * std::abs(expected[k]) + 1e-15) << "taxel " << k;
    }
  }
}

/// The derivative by central differences, in steps relative to the value.
template <typename Set>
std::vector<double> difference(CircuitModel& model, const std::vector<double>& siemens, double value, const Set& set) {
  constexpr double kStep = 1e-4;
  set(value * (1.0 + kStep));
  const auto above = ratios_of(model, siemens);
  set(value * (1.0 - kStep));
  auto slope = ratios_of(model, siemens);
  set(value);
  for (std::size_t k = 0; k < slope.size(); ++k) slope[k] = (above[k] - slope[k]) / (2.0 * kStep * value);
  return slope;
}

double largest(const std::vector<double>& values) {
  double result = 0.0;
  for (const double value : values) result = std::max(result, std::abs(value));
  return result;
}

TEST_P(EveryCircuit, derivatives_are_those_of_finite_differences) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const auto array = random_array(GetParam(), 1 + random.below(5), 1 + random.below(5), random);
    auto siemens = random_siemens(array, random, 200.0, 1e5);
    auto drive = array.readout.drive_ohm;
    auto load = array.readout.load_ohm;
    auto model = model_of(array);
    model.solve(siemens);
    const std::size_t taxels = array.taxel_count();
    std::vector<double> by_taxel(taxels * taxels);
    std::vector<double> by_drive(taxels * drive.size());
    std::vector<double> by_load(taxels * load.size());
    model.taxel_jacobian(by_taxel);
    model.drive_jacobian(by_drive);
    model.load_jacobian(by_load);
    const auto compare = [&](const std::vector<double>& jacobian, std::vector<double>& values, const char* what) {
      const std::size_t count = values.size();
      for (std::size_t c = 0; c < count; ++c) {
        const auto slope = difference(model, siemens, values[c], [&](double value) {
          values[c] = value;
          model.set_resistors(drive, load);
        });
        const double rounding = 1e-10 / values[c];
        for (std::size_t k = 0; k < taxels; ++k) {
          ASSERT_NEAR(jacobian[k * count + c], slope[k], 1e-6 * largest(slope) + rounding)
              << "reading " << k << " by " << what << ' ' << c;
        }
      }
    };
    compare(by_taxel, siemens, "taxel");
    compare(by_drive, drive, "driver");
    compare(by_load, load, "load");
  }
}

}  // namespace
}  // namespace dermis::compensation
