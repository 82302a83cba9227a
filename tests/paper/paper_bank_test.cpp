// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/paper_bank.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace dermis::paper {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Four taxels whose networks see nothing but their thresholds: network k gives `outputs[k]`.
PaperBank bank_of_outputs(const std::vector<double>& outputs, std::optional<PaperBank::Range> celsius = {}) {
  PaperBank bank({{0.0, 1.0}, {0.1, 0.5}, {0.0, 2.0}, {-1.0, 1.0}}, celsius, 50.0);
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    std::vector<float> parameters(bank.networks().shape().parameter_count(), 0.0F);
    parameters.back() = static_cast<float>(std::log(outputs[k] / (1.0 - outputs[k])));
    bank.networks().set_parameters(k, parameters);
  }
  return bank;
}

TEST(PaperBank, has_the_papers_33751296_unknowns) {
  EXPECT_EQ(paper_bank_unknowns(256), 33'751'296U);
  EXPECT_EQ(256 * paper_network_shape(256, false).parameter_count(), 33'751'296U);
  EXPECT_EQ(paper_network_shape(256, false).describe(), "256-256-256-1");
  EXPECT_EQ(paper_network_shape(256, true).describe(), "257-256-256-1");
  for (const std::size_t taxels : {1U, 2U, 9U, 64U}) {
    EXPECT_EQ(taxels * paper_network_shape(taxels, false).parameter_count(), paper_bank_unknowns(taxels));
  }
}

TEST(PaperBank, says_what_it_is) {
  const PaperBank bank(std::vector<PaperBank::Range>(16), {}, 50.0);
  EXPECT_EQ(bank.name(), "paper_bank");
  EXPECT_EQ(bank.description(),
            "the paper's bank: one N-N-N-1 network a taxel, N = 16, from the readings of the whole array, and the "
            "temperature where the calibration varies it, to newtons; it is told nothing of the circuit");
}

TEST(PaperBank, normalises_each_reading_and_the_temperature_to_its_range) {
  const PaperBank bank = bank_of_outputs({0.5, 0.5, 0.5, 0.5}, PaperBank::Range{10.0, 30.0});
  std::vector<float> inputs(5);
  bank.normalise(std::vector<double>{0.25, 0.5, 0.0, 2.0}, 15.0, inputs);
  EXPECT_EQ(inputs, (std::vector<float>{0.25F, 1.0F, 0.0F, 1.5F, 0.25F}));
  bank.normalise(std::vector<double>{0.25, 0.5, 0.0, 2.0}, std::nullopt, inputs);
  EXPECT_EQ(inputs.back(), 0.5F);
}

TEST(PaperBank, gives_no_force_at_an_output_of_a_quarter_and_the_heaviest_at_three_quarters) {
  PaperBank bank = bank_of_outputs({0.25, 0.75, 0.5, 0.1});
  EXPECT_FLOAT_EQ(bank.target(0.0), 0.25F);
  EXPECT_FLOAT_EQ(bank.target(50.0), 0.75F);
  std::vector<float> newtons(4);
  bank.estimate(std::vector<double>{0.3, 0.3, 0.3, 0.3}, std::nullopt, newtons);
  EXPECT_NEAR(newtons[0], 0.0, 1e-4);
  EXPECT_NEAR(newtons[1], 50.0, 1e-4);
  EXPECT_NEAR(newtons[2], 25.0, 1e-4);
  EXPECT_EQ(newtons[3], 0.0F);  // never below 0
}

TEST(PaperBank, gives_no_number_where_a_reading_is_none) {
  PaperBank bank = bank_of_outputs({0.5, 0.5, 0.5, 0.5});
  std::vector<float> newtons(4);
  bank.estimate(std::vector<double>{0.3, kNaN, 0.3, 0.3}, std::nullopt, newtons);
  for (const float value : newtons) EXPECT_TRUE(std::isnan(value));
}

}  // namespace
}  // namespace dermis::paper
