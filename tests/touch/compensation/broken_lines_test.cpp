// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Broken lines in the inversions that solve them. LumpedCircuit, which solves nodal equations, says what they read.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "dermis/touch/compensation/crosstalk.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/reference_array.hpp"
#include "touch/compensation/faults/masked_taxels.hpp"
#include "touch/compensation/lumped_circuit.hpp"

namespace dermis::touch::compensation {
namespace {

struct Case {
  LineFaultKind kind{};
  std::size_t place = 0;
  bool grounded = false;
};

LumpedCircuit circuit_with(const ArrayDescription& array, const std::vector<LineFault>& faults) {
  LumpedCircuit circuit(array);
  for (const LineFault& fault : faults) {
    const LineFaultTraits& traits = traits_of(fault.kind);
    if (traits.effect == LineFaultEffect::shorted) {
      circuit.join_lines(*traits.axis, fault.place);
    } else if (traits.effect == LineFaultEffect::supplied) {
      circuit.tie_column_to_supply(fault.place);
    } else if (fault.grounded) {
      circuit.ground_line(*traits.axis, fault.place);
    } else {
      circuit.open_line(*traits.axis, fault.place);
    }
  }
  return circuit;
}

/// The largest relative error of a taxel whose reading is used. Those of joined lines count together.
double error_of(const ArrayDescription& array, const std::vector<LineFault>& faults, Random& random) {
  auto inversion = make_crosstalk_inversion(array).value();
  EXPECT_TRUE(inversion->set_broken(faults));
  std::vector<double> truth(array.taxel_count());
  std::vector<double> ratio(truth.size());
  double worst = 0.0;
  for (int frame = 0; frame < 5; ++frame) {
    for (double& siemens : truth) siemens = random.log_uniform(1e-5, 1e-3);
    circuit_with(array, faults).solve(truth, ratio);
    std::vector<double> siemens(truth.size());
    std::vector<double> expected = truth;
    for (const LineFault& fault : faults) {
      const LineFaultTraits& traits = traits_of(fault.kind);
      if (traits.effect == LineFaultEffect::shorted) {
        for (std::size_t k = 0; k < line_length(array, *traits.axis); ++k) {
          double& first = expected[taxel_on_line(array, *traits.axis, fault.place, k)];
          double& second = expected[taxel_on_line(array, *traits.axis, fault.place + 1, k)];
          first = second = 0.5 * (first + second);
        }
        continue;
      }
      for_each_masked_taxel(fault, array, [&](std::size_t taxel) {
        ratio[taxel] = std::numeric_limits<double>::quiet_NaN();
        siemens[taxel] = truth[taxel];
      });
    }
    EXPECT_TRUE(inversion->invert(ratio, siemens).solved);
    for (std::size_t taxel = 0; taxel < truth.size(); ++taxel) {
      if (!std::isnan(ratio[taxel])) worst = std::max(worst, std::abs(siemens[taxel] / expected[taxel] - 1.0));
    }
  }
  return worst;
}

TEST(BrokenLines, are_solved_with_the_others_where_all_columns_are_loaded) {
  const ArrayDescription array = support::reference_circuit(12, 10);
  Random random(1);
  for (const Case& of : {Case{LineFaultKind::silent_row, 4}, Case{LineFaultKind::silent_row, 0, true},
                         Case{LineFaultKind::silent_column, 9}, Case{LineFaultKind::silent_column, 3, true},
                         Case{LineFaultKind::supplied_column, 5}, Case{LineFaultKind::shorted_rows, 6},
                         Case{LineFaultKind::shorted_columns, 2}}) {
    const std::vector<LineFault> faults = {{.kind = of.kind, .place = of.place, .grounded = of.grounded}};
    EXPECT_LT(error_of(array, faults, random), 2e-3) << to_string(of.kind) << " " << of.place;
  }
}

TEST(BrokenLines, several_are_solved_together) {
  const std::vector<LineFault> faults = {{.kind = LineFaultKind::silent_row, .place = 2},
                                         {.kind = LineFaultKind::silent_column, .place = 7},
                                         {.kind = LineFaultKind::shorted_rows, .place = 5},
                                         {.kind = LineFaultKind::silent_row, .place = 9, .grounded = true}};
  Random random(2);
  EXPECT_LT(error_of(support::reference_circuit(12, 10), faults, random), 2e-3);
}

TEST(BrokenLines, are_solved_with_the_others_where_one_line_is_loaded) {
  ArrayDescription array = support::reference_circuit(12, 10);
  array.readout.idle_columns = IdleColumns::floating;
  Random random(3);
  for (const ArrayDescription& circuit : {array, support::reference_circuit(12, 10, Circuit::flexitac)}) {
    const bool is_flexitac = circuit.readout.circuit == Circuit::flexitac;
    for (const Case& of : {Case{LineFaultKind::silent_row, 4}, Case{LineFaultKind::silent_column, 3},
                           Case{LineFaultKind::shorted_rows, 6}, Case{LineFaultKind::shorted_columns, 2}}) {
      const std::vector<LineFault> faults = {{.kind = of.kind, .place = of.place}};
      EXPECT_LT(error_of(circuit, faults, random), 2e-3) << is_flexitac << " " << to_string(of.kind);
    }
  }
}

TEST(BrokenLines, a_mended_line_leaves_no_trace) {
  const ArrayDescription array = support::reference_circuit(12, 10);
  auto inversion = make_crosstalk_inversion(array).value();
  auto other = make_crosstalk_inversion(array).value();
  const std::vector<LineFault> faults = {{.kind = LineFaultKind::silent_row, .place = 2},
                                         {.kind = LineFaultKind::supplied_column, .place = 3},
                                         {.kind = LineFaultKind::shorted_columns, .place = 6}};
  ASSERT_TRUE(inversion->set_broken(faults));
  ASSERT_TRUE(inversion->set_broken({}));
  Random random(4);
  std::vector<double> ratio(array.taxel_count());
  for (double& reading : ratio) reading = random.uniform(0.0, 0.02);
  std::vector<double> siemens(ratio.size());
  std::vector<double> expected(ratio.size());
  EXPECT_TRUE(inversion->invert(ratio, siemens).solved);
  EXPECT_TRUE(other->invert(ratio, expected).solved);
  EXPECT_EQ(siemens, expected);
}

TEST(BrokenLines, that_are_broken_in_two_ways_or_in_another_circuit_are_left_to_the_caller) {
  const std::vector<LineFault> silent = {{.kind = LineFaultKind::silent_row, .place = 2}};
  const std::vector<LineFault> both = {{.kind = LineFaultKind::silent_row, .place = 2},
                                       {.kind = LineFaultKind::shorted_rows, .place = 2}};
  EXPECT_FALSE(make_crosstalk_inversion(support::reference_circuit(12, 10)).value()->set_broken(both));
  const ArrayDescription amplified = support::reference_circuit(12, 10, Circuit::transimpedance);
  EXPECT_FALSE(make_crosstalk_inversion(amplified).value()->set_broken(silent));
}

}  // namespace
}  // namespace dermis::touch::compensation
