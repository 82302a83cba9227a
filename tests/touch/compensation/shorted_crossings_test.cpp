// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Crossings whose row and column touch, in every circuit that the simulator can break.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "dermis/learn/simulation/line_faults.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "support/allocation_guard.hpp"
#include "support/circuits.hpp"
#include "support/reference_array.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr std::uint64_t kSeed = 46;

struct Solved {
  std::vector<double> siemens;  // true
  ConductanceFrame conductance;
};

/// Without noise, what an array of these conductances reads with these shorted crossings.
ConditionedFrame frame_with(const ArrayDescription& array, const learn::simulation::LineFaults& faults,
                            const std::vector<double>& siemens, double sigma_ratio) {
  ConditionedFrame frame;
  frame.sigma_ratio = sigma_ratio;
  frame.ratio.resize(array.taxel_count());
  frame.taxels.resize(array.taxel_count());
  learn::simulation::FaultyCircuit::create(array, faults).value().ratios(siemens, 0, frame.ratio);
  return frame;
}

learn::simulation::LineFaults shorts_at(const ArrayDescription& array, const std::vector<std::size_t>& shorted) {
  learn::simulation::LineFaults faults;
  for (const std::size_t taxel : shorted) faults.shorted_taxels.push_back(array.taxel_name(taxel));
  return faults;
}

std::vector<LineFault> faults_at(const std::vector<std::size_t>& shorted) {
  std::vector<LineFault> faults;
  for (const std::size_t taxel : shorted) {
    faults.push_back({.kind = LineFaultKind::shorted_crossing, .place = taxel});
  }
  return faults;
}

/// An array of 7 x 6 taxels with these faults, that the compensator knows of.
Solved solve(const ArrayDescription& array, const learn::simulation::LineFaults& faults,
             const std::vector<LineFault>& known) {
  Random random(kSeed);
  Solved solved;
  solved.siemens = support::random_siemens(array, random, 1e3, 1e5);
  const ConditionedFrame frame = frame_with(array, faults, solved.siemens, 1e-6);
  auto compensator = Compensator::create(array).value();
  compensator.set_faults(known);
  compensator.process(frame, solved.conductance);
  const support::AllocationGuard guard;
  compensator.set_faults(known);
  compensator.process(frame, solved.conductance);
  EXPECT_EQ(guard.count(), 0U);
  return solved;
}

Solved solve(const ArrayDescription& array, const std::vector<std::size_t>& shorted) {
  return solve(array, shorts_at(array, shorted), faults_at(shorted));
}

/// The taxels that have a conductance have the right one. Returns how many have none.
std::size_t expect_right(const Solved& solved, double relative) {
  EXPECT_FALSE(has(solved.conductance.status, FrameStatus::not_converged));
  std::size_t masked = 0;
  for (std::size_t taxel = 0; taxel < solved.siemens.size(); ++taxel) {
    if (solved.conductance.taxels[taxel] == TaxelStatus::line_fault) {
      ++masked;
      continue;
    }
    EXPECT_NEAR(solved.conductance.siemens[taxel] / solved.siemens[taxel], 1.0, relative) << "taxel " << taxel;
  }
  return masked;
}

ArrayDescription small_array(const support::NamedCircuit& circuit) {
  Random random(kSeed);
  ArrayDescription array = support::random_array(circuit, 7, 6, random);
  for (double& ohm : array.readout.drive_ohm) ohm = 10.0 + 0.1 * ohm;
  for (double& ohm : array.readout.load_ohm) ohm = 200.0 + 0.01 * ohm;
  return array;
}

std::vector<support::NamedCircuit> circuits_with_faults() {
  auto circuits = support::all_circuits();
  std::erase_if(circuits, [](const auto& circuit) { return circuit.resistive_lines || circuit.real_amplifiers; });
  return circuits;
}

bool merges_lines(const support::NamedCircuit& circuit) {
  return circuit.circuit == Circuit::flexitac ||
         (circuit.circuit == Circuit::divider && circuit.idle_rows == IdleRows::grounded);
}

TEST(ShortedCrossings, the_other_taxels_are_solved_in_every_circuit) {
  for (const support::NamedCircuit& circuit : circuits_with_faults()) {
    SCOPED_TRACE(testing::Message() << circuit << ", seed " << kSeed);
    const ArrayDescription array = small_array(circuit);
    const std::size_t masked = expect_right(solve(array, {array.index(2, 4)}), merges_lines(circuit) ? 2e-3 : 0.05);
    EXPECT_EQ(masked, circuit.circuit == Circuit::transimpedance ? array.cols : 1U);
  }
}

TEST(ShortedCrossings, of_two_nodes_only_the_sum_of_the_taxels_between_them_is_lost) {
  for (const support::NamedCircuit& circuit : circuits_with_faults()) {
    if (!merges_lines(circuit)) continue;
    SCOPED_TRACE(testing::Message() << circuit << ", seed " << kSeed);
    const ArrayDescription array = small_array(circuit);
    EXPECT_EQ(expect_right(solve(array, {array.index(2, 4), array.index(5, 0)}), 2e-3), 4U);
  }
}

TEST(ShortedCrossings, two_columns_on_one_row_or_two_rows_on_one_column_are_lost_and_no_more) {
  for (const support::NamedCircuit& circuit : circuits_with_faults()) {
    if (!merges_lines(circuit)) continue;
    SCOPED_TRACE(testing::Message() << circuit << ", seed " << kSeed);
    const ArrayDescription array = small_array(circuit);
    EXPECT_EQ(expect_right(solve(array, {array.index(2, 4), array.index(2, 1)}), 2e-3), 2 * array.rows);
    EXPECT_EQ(expect_right(solve(array, {array.index(2, 4), array.index(6, 4)}), 2e-3), 2 * array.cols);
  }
}

TEST(ShortedCrossings, on_a_driver_of_no_resistance_the_others_are_solved) {
  for (const support::NamedCircuit& circuit : circuits_with_faults()) {
    if (!merges_lines(circuit)) continue;
    SCOPED_TRACE(testing::Message() << circuit << ", seed " << kSeed);
    ArrayDescription array = small_array(circuit);
    std::fill(array.readout.drive_ohm.begin(), array.readout.drive_ohm.end(), 0.0);
    const std::size_t sensed_line = circuit.circuit == Circuit::flexitac ? array.cols : array.rows;
    EXPECT_EQ(expect_right(solve(array, {array.index(2, 4)}), 0.05), sensed_line);
  }
}

/// Each crossing but the first is on the row or the column of one before it.
std::vector<std::size_t> random_chain(const ArrayDescription& array, std::size_t length, Random& random) {
  std::vector<std::size_t> chain = {random.below(array.taxel_count())};
  while (chain.size() < length) {
    const std::size_t last = chain[random.below(chain.size())];
    const bool on_row = random.below(2) == 0;
    const std::size_t next = on_row ? array.index(last / array.cols, random.below(array.cols))
                                    : array.index(random.below(array.rows), last % array.cols);
    if (std::find(chain.begin(), chain.end(), next) == chain.end()) chain.push_back(next);
  }
  return chain;
}

TEST(ShortedCrossings, of_any_chain_the_taxels_off_its_lines_are_solved) {
  Random random(kSeed);
  for (const support::NamedCircuit& circuit : circuits_with_faults()) {
    const ArrayDescription array = small_array(circuit);
    for (std::size_t trial = 0; trial < 12; ++trial) {
      const std::vector<std::size_t> chain = random_chain(array, 2 + trial % 4, random);
      SCOPED_TRACE(testing::Message() << circuit << ", seed " << kSeed << ", chain " << testing::PrintToString(chain));
      const Solved solved = solve(array, chain);
      expect_right(solved, merges_lines(circuit) ? 2e-3 : 0.05);
      for (const std::size_t taxel : chain) {
        EXPECT_EQ(solved.conductance.taxels[taxel], TaxelStatus::line_fault) << taxel;
      }
    }
  }
}

TEST(ShortedCrossings, of_four_neighbouring_lines_that_are_one_no_taxel_is_solved_and_all_others_are) {
  for (const support::NamedCircuit& circuit : circuits_with_faults()) {
    if (circuit.idle_rows == IdleRows::floating || circuit.idle_columns == IdleColumns::floating) continue;
    if (circuit.circuit == Circuit::flexitac) continue;  // a twentieth of a count is much there
    SCOPED_TRACE(testing::Message() << circuit << ", seed " << kSeed);
    const ArrayDescription array = small_array(circuit);
    learn::simulation::LineFaults rows;
    learn::simulation::LineFaults columns;
    rows.rows.shorted = columns.columns.shorted = {1, 2, 3};
    std::vector<LineFault> known;
    for (const std::size_t line : {2U, 1U, 3U}) known.push_back({.kind = LineFaultKind::shorted_rows, .place = line});
    {
      SCOPED_TRACE("rows");
      EXPECT_EQ(expect_right(solve(array, rows, known), 0.01), 4 * array.cols);
    }
    for (LineFault& fault : known) fault.kind = LineFaultKind::shorted_columns;
    SCOPED_TRACE("columns");
    EXPECT_EQ(expect_right(solve(array, columns, known), 0.01), 4 * array.rows);
  }
}

TEST(ShortedCrossings, a_reading_that_is_missing_on_a_joined_row_costs_no_other) {
  for (const std::size_t row : {2U, 6U}) {
    const ArrayDescription array = support::reference_circuit(7, 6);
    const std::vector<std::size_t> shorted = {array.index(2, 4), array.index(6, 4)};
    ConditionedFrame frame =
        frame_with(array, shorts_at(array, shorted), std::vector<double>(array.taxel_count(), 1e-4), 1e-4);
    frame.ratio[array.index(row, 2)] = 0.0;
    frame.taxels[array.index(row, 2)] = TaxelStatus::invalid;
    auto compensator = Compensator::create(array).value();
    compensator.set_faults(faults_at(shorted));
    ConductanceFrame conductance;
    compensator.process(frame, conductance);
    EXPECT_FALSE(has(conductance.status, FrameStatus::not_converged)) << row;
    EXPECT_NEAR(conductance.siemens[array.index(0, 1)], 1e-4, 1e-6) << row;
  }
}

}  // namespace
}  // namespace dermis::touch::compensation
