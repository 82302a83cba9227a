// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

namespace dermis {
namespace {

constexpr int kSamples = 200'000;

struct Moments {
  double mean = 0.0;
  double deviation = 0.0;
};

Moments moments_of(const std::function<double()>& draw) {
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double value = draw();
    sum += value;
    squares += value * value;
  }
  const double mean = sum / kSamples;
  return {mean, std::sqrt(squares / kSamples - mean * mean)};
}

double correlation(Random a, Random b) {
  double products = 0.0;
  for (int i = 0; i < kSamples; ++i) products += a.normal() * b.normal();
  return products / kSamples;
}

TEST(Random, repeats_itself_with_the_same_seed) {
  Random a(7);
  Random b(7);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(a.bits(), b.bits());
}

TEST(Random, differs_between_seeds) {
  EXPECT_NE(Random(1).bits(), Random(2).bits());
}

// xoshiro256++ by hand from the state that splitmix64 gives for the seed 0 (its published first outputs).
TEST(Random, is_xoshiro256_plus_plus_seeded_with_splitmix64) {
  const std::array<std::uint64_t, 4> state{0xE220A8397B1DCDAFULL, 0x6E789E6AA1B965F4ULL, 0x06C45D188009454FULL,
                                           0xF88BB8A8724C81ECULL};
  const std::uint64_t sum = state[0] + state[3];
  EXPECT_EQ(Random(0).bits(), ((sum << 23U) | (sum >> 41U)) + state[0]);
}

TEST(Random, is_uniform_on_the_half_open_unit_interval) {
  Random random(1);
  const Moments moments = moments_of([&] {
    const double value = random.uniform();
    EXPECT_GE(value, 0.0);
    EXPECT_LT(value, 1.0);
    return value;
  });
  EXPECT_NEAR(moments.mean, 0.5, 0.003);
  EXPECT_NEAR(moments.deviation, std::sqrt(1.0 / 12.0), 0.003);
}

TEST(Random, is_uniform_between_bounds) {
  Random random(1);
  const Moments moments = moments_of([&] { return random.uniform(-2.0, 4.0); });
  EXPECT_NEAR(moments.mean, 1.0, 0.02);
  EXPECT_NEAR(moments.deviation, 6.0 / std::sqrt(12.0), 0.02);
}

TEST(Random, is_uniform_in_the_logarithm) {
  Random random(1);
  const Moments moments = moments_of([&] { return std::log(random.log_uniform(1.0, 50.0)); });
  EXPECT_NEAR(moments.mean, std::log(50.0) / 2.0, 0.02);
  EXPECT_NEAR(moments.deviation, std::log(50.0) / std::sqrt(12.0), 0.02);
}

TEST(Random, is_normal) {
  Random random(1);
  int within_one = 0;
  int within_two = 0;
  const Moments moments = moments_of([&] {
    const double value = random.normal();
    within_one += std::abs(value) < 1.0 ? 1 : 0;
    within_two += std::abs(value) < 2.0 ? 1 : 0;
    return value;
  });
  EXPECT_NEAR(moments.mean, 0.0, 0.01);
  EXPECT_NEAR(moments.deviation, 1.0, 0.01);
  EXPECT_NEAR(static_cast<double>(within_one) / kSamples, 0.6827, 0.005);
  EXPECT_NEAR(static_cast<double>(within_two) / kSamples, 0.9545, 0.003);
}

TEST(Random, draws_every_number_below_a_bound_equally_often) {
  Random random(1);
  std::vector<int> counts(10, 0);
  for (int i = 0; i < kSamples; ++i) ++counts.at(static_cast<std::size_t>(random.below(10)));
  for (const int count : counts) EXPECT_NEAR(count, 0.1 * kSamples, 700);
  EXPECT_EQ(random.below(1), 0U);
}

TEST(Random, gives_streams_that_do_not_correlate) {
  EXPECT_NEAR(correlation(Random::stream(1, 0), Random::stream(1, 1)), 0.0, 0.01);
  EXPECT_NEAR(correlation(Random::stream(1, 0), Random::stream(2, 0)), 0.0, 0.01);
  EXPECT_NEAR(correlation(Random(1), Random::stream(1, 0)), 0.0, 0.01);
}

TEST(Random, gives_another_stream_for_every_task) {
  std::set<std::uint64_t> first_bits;
  for (std::uint64_t stream = 0; stream < 10'000; ++stream) first_bits.insert(Random::stream(1, stream).bits());
  EXPECT_EQ(first_bits.size(), 10'000U);
  EXPECT_EQ(Random::stream(1, 5).bits(), Random::stream(1, 5).bits());
}

}  // namespace
}  // namespace dermis
