// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/compensation/circuit_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/circuits.hpp"
#include "support/nodal_readout.hpp"

namespace dermis::touch::compensation {
namespace {

using support::NamedCircuit;
using support::random_array;
using support::random_siemens;

class EveryCircuit : public testing::TestWithParam<NamedCircuit> {};

INSTANTIATE_TEST_SUITE_P(CircuitModel, EveryCircuit, testing::ValuesIn(support::all_circuits()),
                         [](const auto& info) { return info.param.name; });
INSTANTIATE_TEST_SUITE_P(WithFilm, EveryCircuit, testing::ValuesIn(support::circuits_with_film()),
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

TEST_P(EveryCircuit, a_film_conducts_as_it_is_told) {
  if (!GetParam().film) return;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    auto array = random_array(GetParam(), 1 + random.below(5), 1 + random.below(5), random);
    FilmConductances film(array.rows, array.cols);
    const double most = GetParam().resistive_lines ? 1.0 / array.readout.film->unloaded_ohm : 5e-3;  // spread evenly
    for (double& siemens : film.between_rows) siemens = random.uniform(0.0, most);
    for (double& siemens : film.between_cols) siemens = random.uniform(0.0, most);
    const auto siemens = random_siemens(array, random);
    auto model = model_of(array);
    model.set_film(film);
    std::vector<double> drive(array.readout.drive_ohm.size(), 30.0);
    if (seed % 2 == 0) {
      drive[0] = 0.0;
      array.readout.drive_ohm = drive;
      model.set_resistors(drive, array.readout.load_ohm);
    }
    const auto ratio = ratios_of(model, siemens);
    const auto expected = support::NodalReadout(array, film).ratios(siemens);
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

/// Some taxels at 0 S, whole lines of them among them.
std::vector<double> sparse_siemens(const ArrayDescription& array, Random& random) {
  auto siemens = random_siemens(array, random, 200.0, 1e5);
  for (double& value : siemens) value = random.below(3) == 0 ? value : 0.0;
  const std::size_t row = random.below(array.rows);
  const std::size_t col = random.below(array.cols);
  for (std::size_t j = 0; j < array.cols; ++j) siemens[array.index(row, j)] = 0.0;
  for (std::size_t i = 0; i < array.rows; ++i) siemens[array.index(i, col)] = 0.0;
  return siemens;
}

TEST_P(EveryCircuit, diagonal_and_product_are_those_of_the_jacobian) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const auto array = random_array(GetParam(), 1 + random.below(9), 1 + random.below(9), random);
    auto model = model_of(array);
    model.solve(seed % 2 == 0 ? sparse_siemens(array, random) : random_siemens(array, random));
    const std::size_t taxels = array.taxel_count();
    std::vector<double> jacobian(taxels * taxels);
    std::vector<double> own(taxels);
    std::vector<double> change(taxels);
    std::vector<double> product(taxels);
    for (double& value : change) value = random.normal();
    model.taxel_jacobian(jacobian);
    model.own_derivatives(own);
    model.multiply_taxel_jacobian(change, product);
    for (std::size_t k = 0; k < taxels; ++k) {
      EXPECT_EQ(own[k], jacobian[k * taxels + k]);
      double sum = 0.0;
      double size = 0.0;
      for (std::size_t c = 0; c < taxels; ++c) {
        sum += jacobian[k * taxels + c] * change[c];
        size += std::abs(jacobian[k * taxels + c] * change[c]);
      }
      ASSERT_NEAR(product[k], sum, 1e-12 * size) << "reading " << k;
    }
  }
}

TEST_P(EveryCircuit, a_first_taxel_of_an_open_line_reads_as_its_derivative_says) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const auto array = random_array(GetParam(), 2 + random.below(3), 2 + random.below(3), random);
    auto siemens = sparse_siemens(array, random);
    auto model = model_of(array);
    const auto ratio = ratios_of(model, siemens);
    const std::size_t taxels = array.taxel_count();
    std::vector<double> jacobian(taxels * taxels);
    model.taxel_jacobian(jacobian);
    for (std::size_t c = 0; c < taxels; ++c) {
      constexpr double kFirstSiemens = 1e-12;
      const double before = std::exchange(siemens[c], siemens[c] + kFirstSiemens);
      const auto changed = ratios_of(model, siemens);
      siemens[c] = before;
      for (std::size_t k = 0; k < taxels; ++k) {
        ASSERT_NEAR((changed[k] - ratio[k]) / kFirstSiemens, jacobian[k * taxels + c], 1e-2 * array.readout.load_ohm[0])
            << "reading " << k << " by taxel " << c;
      }
    }
  }
}

TEST_P(EveryCircuit, an_open_array_reads_nothing_but_offsets) {
  Random random(1);
  auto array = random_array(GetParam(), 3, 4, random);
  if (GetParam().film) array.readout.amplifier_offset_v.clear();  // they drive currents through it
  auto model = model_of(array);
  const auto ratio = ratios_of(model, std::vector<double>(12, 0.0));
  for (std::size_t k = 0; k < ratio.size(); ++k) {
    const bool has_offset = !array.readout.amplifier_offset_v.empty();
    const double offset = has_offset ? array.readout.amplifier_offset_v[k % 4] / 5.0 / (1.0 + 1e-4) : 0.0;
    EXPECT_NEAR(ratio[k], -offset, 1e-12);
  }
}

TEST_P(EveryCircuit, later_solutions_allocate_nothing) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  Random random(2);
  const auto array = random_array(GetParam(), 20, 16, random);
  const auto siemens = random_siemens(array, random);
  auto model = model_of(array);
  std::vector<double> product(siemens.size());
  model.solve(siemens);
  const support::AllocationGuard guard;
  model.solve(siemens);
  model.own_derivatives(product);
  model.multiply_taxel_jacobian(siemens, product);
  EXPECT_EQ(guard.count(), 0);
}

TEST(CircuitModel, far_apart_conductances_are_solved_to_rounding) {
  // One taxel: T = RL / (Rd + 1/G + RL), with another of 1e12 times the resistance beside it in each direction.
  const NamedCircuit two_terminal{"", Circuit::divider, IdleRows::floating, IdleColumns::floating};
  Random random(3);
  const auto array = random_array(two_terminal, 2, 2, random);
  auto model = model_of(array);
  const auto ratio = ratios_of(model, {1e-2, 1e-14, 1e-14, 1e-3});
  const double around = 1.0 / (1e-14 + 1.0 / (1e2 + 1e14 + 1e3));  // the weak taxel beside its sneak path
  const double load = array.readout.load_ohm[1];
  EXPECT_NEAR(ratio[1] * (array.readout.drive_ohm[0] + around + load) / load, 1.0, 1e-14);
}

TEST(CircuitModel, refuses_what_cannot_be_computed_with_one_line) {
  ArrayDescription array;
  array.rows = array.cols = 2;
  array.readout.circuit = Circuit::none;
  EXPECT_EQ(CircuitModel::create(array).error().kind, ErrorKind::bad_input);
  array.readout.circuit = Circuit::divider;
  array.readout.drive_ohm = {1.0, kFitOhm};
  array.readout.load_ohm = {1.0, 1.0};
  EXPECT_NE(CircuitModel::create(array).error().message.find("must be known"), std::string::npos);
  array.readout.drive_ohm.clear();
  EXPECT_FALSE(CircuitModel::create(array));
  array.rows = array.cols = 1024;
  array.readout.drive_ohm.assign(1024, 1.0);
  array.readout.load_ohm.assign(1024, 1.0);
  EXPECT_NE(CircuitModel::create(array).error().message.find("too large"), std::string::npos);
}

}  // namespace
}  // namespace dermis::touch::compensation
