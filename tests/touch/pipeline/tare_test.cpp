// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/pipeline/tare.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/stream_of_loads.hpp"

namespace dermis::touch::pipeline {
namespace {

using support::StreamOfLoads;

constexpr std::size_t kTaxels = 100;
const std::vector<double> kUntouched(kTaxels, 0.0);

std::vector<double> loaded(const std::vector<std::size_t>& taxels, double newtons) {
  std::vector<double> loads = kUntouched;
  for (const std::size_t taxel : taxels) loads[taxel] = newtons;
  return loads;
}

const std::vector<std::vector<std::size_t>> kPlaces = [] {
  std::vector<std::size_t> all(kTaxels);
  for (std::size_t k = 0; k < kTaxels; ++k) all[k] = k;
  return std::vector<std::vector<std::size_t>>{{34}, {11, 12, 13, 14, 15, 16, 17, 18, 21, 22}, all};
}();

TEST(Tare, of_any_load_from_1_to_50_newtons_is_refused_and_moves_no_zero) {
  for (const std::vector<std::size_t>& place : kPlaces) {
    for (const double newtons : {1.0, 5.0, 20.0, 50.0}) {
      SCOPED_TRACE(testing::Message() << newtons << " N on each of " << place.size());
      StreamOfLoads stream(10, 10);
      stream.pipeline().tare();
      stream.process(loaded(place, newtons), 1.5);
      const Tare& tare = stream.pipeline().last_tare();
      ASSERT_EQ(tare.state, Tare::State::refused);
      const double sum = newtons * static_cast<double>(place.size());
      EXPECT_NEAR(tare.load.newtons, sum, 0.02 * sum);
      EXPECT_NEAR(stream.process(loaded(place, newtons), 0.5)[place[0]], newtons, 0.02 * newtons);
    }
  }
}

TEST(Tare, that_is_refused_says_what_stands_where) {
  StreamOfLoads stream(10, 10);
  stream.pipeline().tare();
  stream.process(loaded({34, 35, 44, 45}, 12.0), 1.5);
  EXPECT_EQ(describe(stream.pipeline().last_tare(), stream.model().array),
            "r3c4 to r4c5 read 48 N: take it off and tare again");
}

TEST(Tare, of_an_untouched_array_is_taken_without_a_word) {
  StreamOfLoads stream(10, 10);
  stream.pipeline().tare();
  EXPECT_EQ(stream.pipeline().last_tare().state, Tare::State::taking);
  stream.process(kUntouched, 1.5);
  EXPECT_EQ(stream.pipeline().last_tare().state, Tare::State::taken);
  EXPECT_EQ(describe(stream.pipeline().last_tare(), stream.model().array), "");
}

TEST(Tare, over_any_load_takes_it_as_zero_and_says_so) {
  StreamOfLoads stream(10, 10);
  stream.pipeline().tare(TareOver::any_load);
  stream.process(loaded({34}, 12.0), 1.5);
  EXPECT_EQ(stream.pipeline().last_tare().state, Tare::State::taken);
  EXPECT_EQ(describe(stream.pipeline().last_tare(), stream.model().array), "the tare takes 12 N on r3c4 as zero");
  EXPECT_LT(stream.process(loaded({34}, 12.0), 0.5)[34], 0.05);
  stream.pipeline().tare();
  stream.process(loaded({34, 35}, 12.0), 1.5);
  EXPECT_EQ(stream.pipeline().last_tare().state, Tare::State::refused) << "the next one is asked again";
}

TEST(Tare, that_is_undone_gives_back_the_zero_before_it) {
  StreamOfLoads stream(10, 10);
  stream.pipeline().tare(TareOver::any_load);
  stream.process(loaded({34}, 3.0), 1.5);
  stream.pipeline().tare(TareOver::any_load);
  stream.process(loaded({34}, 10.0), 1.5);
  stream.pipeline().undo_tare();
  EXPECT_EQ(stream.pipeline().last_tare().state, Tare::State::none);
  const double power = 1.0 / static_cast<double>(support::kExponent);
  const double beyond_3_newtons = std::pow(std::pow(10.0, power) - std::pow(3.0, power), 1.0 / power);
  EXPECT_NEAR(stream.process(loaded({34}, 10.0), 0.5)[34], beyond_3_newtons, 0.05);
}

TEST(Tare, takes_what_drift_explains_and_says_it_where_it_reads_as_a_force) {
  StreamOfLoads stream(10, 10);
  stream.age_unloaded(1.4);
  stream.pipeline().tare();
  stream.process(kUntouched, 1.5);
  const Tare& tare = stream.pipeline().last_tare();
  EXPECT_EQ(tare.state, Tare::State::taken);
  EXPECT_GT(tare.load.newtons, 0.1);
  EXPECT_TRUE(describe(tare, stream.model().array).ends_with(" N on r0c0 to r9c9 as zero"));
  for (const double newtons : stream.process(kUntouched, 0.5)) EXPECT_LT(newtons, 0.01);
}

}  // namespace
}  // namespace dermis::touch::pipeline
