// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/bank_reproduction.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "dermis/paper/paper_bank.hpp"

namespace dermis::paper {
namespace {

PaperReproduction reproduced() {
  PaperReproduction found;
  const Status done = reproduce_bank(
      paper_array(4, 4), {10, 20}, [](const std::string&, double) {}, found);
  EXPECT_TRUE(done) << done.error().message;
  return found;
}

TEST(BankReproduction, counts_the_unknowns_and_solves_the_printed_systems) {
  const PaperReproduction found = reproduced();
  EXPECT_EQ(found.rows, 4U);
  EXPECT_EQ(found.unknowns, paper_bank_unknowns(16));
  ASSERT_EQ(found.start.size(), 7U);
  for (const StartSystem& system : found.start) EXPECT_LT(system.residual, 1e-12) << system.equation << system.where;
}

TEST(BankReproduction, trains_from_each_start_and_judges_sixteen_points_a_force) {
  const PaperReproduction found = reproduced();
  ASSERT_EQ(found.convergence.size(), 3U);
  EXPECT_EQ(found.convergence.front().name, "the paper's start");
  for (const TrainingCurve& curve : found.convergence) EXPECT_EQ(curve.value.size(), 10U);
  EXPECT_EQ(found.bank_training.value.size(), 20U);
  ASSERT_EQ(found.points.size(), 48U);
  EXPECT_EQ(found.evaluation.estimators.back().name, kPaperBankName);
  EXPECT_EQ(found.evaluation.estimators.back().description.find("the paper's bank"), 0U);
  std::set<double> forces;
  for (const PaperPoint& point : found.points) forces.insert(point.true_newtons);
  EXPECT_EQ(forces, (std::set<double>{10.0, 20.0, 50.0}));
}

TEST(BankReproduction, tells_how_far_each_part_is) {
  std::set<std::string> parts;
  double last = 0.0;
  PaperReproduction found;
  const auto note = [&](const std::string& part, double share) {
    parts.insert(part);
    last = share;
  };
  ASSERT_TRUE(reproduce_bank(paper_array(4, 4), {10, 20}, note, found));
  EXPECT_EQ(parts, (std::set<std::string>{"bank", "convergence"}));
  EXPECT_EQ(last, 1.0);
}

}  // namespace
}  // namespace dermis::paper
