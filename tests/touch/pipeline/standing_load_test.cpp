// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/pipeline/standing_load.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "support/stream_of_loads.hpp"

namespace dermis::touch::pipeline {
namespace {

using support::StreamOfLoads;

constexpr std::size_t kTaxels = 100;

std::vector<double> square(double newtons) {
  std::vector<double> loads(kTaxels, 0.0);
  for (std::size_t row = 2; row < 6; ++row) {
    for (std::size_t col = 3; col < 7; ++col) loads[row * 10 + col] = newtons;
  }
  return loads;
}

/// A watch of all frames of a stream.
class Watched {
 public:
  void process(const std::vector<double>& newtons, double seconds) {
    stream_.process(newtons, seconds,
                    [this](const ForceFrame& force) { watch_.add(stream_.pipeline().conductance(), force); });
  }
  StreamOfLoads& stream() { return stream_; }
  StandingLoadWatch& watch() { return watch_; }

 private:
  StreamOfLoads stream_{10, 10};
  StandingLoadWatch watch_{stream_.model()};
};

TEST(StandingLoadWatch, names_what_was_never_released) {
  Watched watched;
  watched.process(square(1.0), 6.0);
  const auto load = watched.watch().load();
  ASSERT_TRUE(load);
  EXPECT_NEAR(load->newtons, 16.0, 0.2);
  EXPECT_EQ(
      describe_never_released(*load, watched.stream().model().array),
      "r2c3 to r5c6 were never released and read 16 N: take off what lies there, or tare if the array was put on");
}

TEST(StandingLoadWatch, says_nothing_before_five_seconds) {
  Watched watched;
  watched.process(square(1.0), 4.0);
  EXPECT_FALSE(watched.watch().load());
}

TEST(StandingLoadWatch, forgets_a_load_that_was_released_once) {
  Watched watched;
  watched.process(square(1.0), 6.0);
  watched.process(std::vector<double>(kTaxels, 0.0), 0.1);
  watched.process(square(1.0), 20.0);
  EXPECT_FALSE(watched.watch().load());
  EXPECT_FALSE(watched.watch().is_any_loaded());
  watched.watch().begin_anew();
  watched.process(square(1.0), 6.0);
  EXPECT_TRUE(watched.watch().load());
}

TEST(StandingLoadWatch, takes_drift_for_no_load) {
  Watched watched;
  watched.stream().age_unloaded(1.4);
  watched.process(std::vector<double>(kTaxels, 0.0), 20.0);
  EXPECT_FALSE(watched.watch().load());
}

TEST(StandingLoad, is_named_by_its_taxel_its_rectangle_or_its_number) {
  const Model model = support::hand_made_model(10, 10);
  StandingLoad load{1.25, std::vector<std::uint8_t>(kTaxels, 0)};
  load.bears[35] = 1;
  EXPECT_EQ(describe(load, model.array), "r3c5 reads 1.2 N");
  load.bears[36] = 1;
  EXPECT_EQ(place_name(load, model.array), "r3c5 to r3c6");
  load.bears[99] = 1;
  EXPECT_EQ(place_name(load, model.array), "3 taxels between r3c5 and r9c9");
}

}  // namespace
}  // namespace dermis::touch::pipeline
