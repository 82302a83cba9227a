// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/fusion/material_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/simd_targets.hpp"

namespace dermis::touch::fusion {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

MemoryLaw creep_only() {
  return {{0.05F, 0.1F, 0.08F, 0.12F}, {}};
}
MemoryLaw creep_and_hysteresis() {
  return {{0.05F, 0.1F, 0.08F, 0.12F}, {0.02F, 0.04F, 0.03F}};
}

ForceFrame frame_at(double seconds, std::vector<float> newtons, float sigma = 0.1F) {
  ForceFrame frame;
  frame.time = std::chrono::duration_cast<Nanos>(std::chrono::duration<double>(seconds));
  frame.sigma_newtons.assign(newtons.size(), sigma);
  frame.taxels.assign(newtons.size(), TaxelStatus::ok);
  frame.newtons = std::move(newtons);
  return frame;
}

/// A frame whose standard deviations are all noise.
void process(MaterialMemory& memory, ForceFrame& frame) {
  const std::vector<float> noise = frame.sigma_newtons;
  memory.process(frame, noise);
}

/// One taxel of the material, in double precision: a load is put on at once and held.
class Material {
 public:
  explicit Material(const MemoryLaw& law) : law_(law) {}

  /// What it feels after `seconds` under `newtons` of creep alone.
  double feel(double newtons, double seconds) {
    double felt = newtons;
    for (std::size_t k = 0; k < late_.size(); ++k) {
      late_[k] += (1.0 - std::exp(-seconds / MemoryLaw::kCreepSeconds[k])) * (newtons - late_[k]);
      felt += static_cast<double>(law_.creep[k]) * (late_[k] - newtons);
    }
    return felt;
  }

  /// The load whose creep would leave `newtons`, by the stops.
  double slide(double newtons) {
    double share = 1.0;
    for (std::size_t j = 0; j < stops_.size(); ++j) {
      const double moved = (std::log1p(newtons) - last_) / static_cast<double>(MemoryLaw::kStopReach[j]);
      stops_[j] = std::clamp(stops_[j] + moved, -1.0, 1.0);
      share += 0.5 * static_cast<double>(law_.gap[j]) * stops_[j];
    }
    last_ = std::log1p(newtons);
    return newtons * share;
  }

 private:
  MemoryLaw law_;
  std::array<double, 4> late_{};
  std::array<double, 3> stops_{};
  double last_ = 0.0;
};

/// Loads that come, change, are held and go, at irregular times.
struct Hold {
  double seconds = 0.0;
  double newtons = 0.0;
};
std::vector<Hold> random_holds(Random& random, std::size_t count) {
  std::vector<Hold> holds;
  double newtons = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    if (random.below(4) == 0) newtons = random.below(3) == 0 ? 0.0 : random.log_uniform(0.5, 50.0);
    holds.push_back({random.log_uniform(1e-3, 20.0), newtons});
  }
  return holds;
}

TEST(MaterialMemory, a_law_without_memory_changes_no_bit) {
  MaterialMemory memory({}, 3);
  Random random(1);
  for (int k = 0; k < 50; ++k) {
    const std::vector<float> newtons{0.0F, static_cast<float>(random.log_uniform(0.01, 100.0)), 3.7F};
    ForceFrame frame = frame_at(0.01 * k, newtons, 0.3F);
    process(memory, frame);
    EXPECT_EQ(frame.newtons, newtons);
    EXPECT_EQ(frame.sigma_newtons, std::vector<float>(3, 0.3F));
  }
}

TEST(MaterialMemory, the_force_of_a_load_does_not_depend_on_how_long_it_lies_nor_on_when_it_is_read) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    Material material(creep_only());
    MaterialMemory memory(creep_only(), 1);
    ForceFrame first = frame_at(0.0, {0.0F});
    process(memory, first);
    double seconds = 0.0;
    for (const Hold& hold : random_holds(random, 300)) {
      seconds += hold.seconds;
      ForceFrame frame = frame_at(seconds, {static_cast<float>(material.feel(hold.newtons, hold.seconds))});
      process(memory, frame);
      ASSERT_NEAR(static_cast<double>(frame.newtons[0]), hold.newtons, 2e-4 * hold.newtons + 2e-4) << seconds << " s";
    }
  }
}

TEST(MaterialMemory, lost_frames_of_a_held_load_change_nothing) {
  Material material(creep_only());
  MaterialMemory all(creep_only(), 1);
  MaterialMemory some(creep_only(), 1);
  Random random(3);
  for (int k = 0; k <= 2000; ++k) {
    const double newtons = k > 10 && k < 1500 ? 12.0 : 0.0;
    const auto felt = static_cast<float>(k == 0 ? 0.0 : material.feel(newtons, 0.02));
    ForceFrame frame = frame_at(0.02 * k, {felt});
    ForceFrame kept = frame;
    process(all, frame);
    const bool is_change = k == 11 || k == 1500;
    if (k != 0 && k != 10 && k != 1499 && !is_change && random.below(4) != 0) continue;
    process(some, kept);
    EXPECT_NEAR(kept.newtons[0], frame.newtons[0], 1e-3F) << k;
  }
}

TEST(MaterialMemory, loading_and_unloading_are_told_apart_by_the_stops) {
  const MemoryLaw law{{}, {0.02F, 0.04F, 0.03F}};
  Material material(law);
  MaterialMemory memory(law, 1);
  Random random(5);
  double seconds = 0.0;
  for (const Hold& hold : random_holds(random, 500)) {
    ForceFrame frame = frame_at(seconds += hold.seconds, {static_cast<float>(hold.newtons)});
    process(memory, frame);
    const double expected = material.slide(hold.newtons);
    ASSERT_NEAR(static_cast<double>(frame.newtons[0]), expected, 1e-4 * expected + 1e-5);
  }
  ForceFrame off = frame_at(seconds + 0.5, {0.0F});
  process(memory, off);
  ForceFrame up = frame_at(seconds + 1.0, {40.0F});
  process(memory, up);
  ForceFrame half = frame_at(seconds + 2.0, {10.0F});
  process(memory, half);
  EXPECT_NEAR(up.newtons[0], 40.0F * 1.045F, 1e-3F);
  EXPECT_LT(half.newtons[0], 10.0F * 0.97F);
}

TEST(MaterialMemory, after_a_release_nothing_presses) {
  MaterialMemory memory(creep_and_hysteresis(), 1);
  Random random(7);
  for (int k = 0; k < 600; ++k) {
    const bool is_pressed = k > 5 && k < 300;
    ForceFrame frame = frame_at(0.05 * k, {is_pressed ? 20.0F : static_cast<float>(0.05 * random.uniform(0.0, 1.0))});
    process(memory, frame);
    if (is_pressed) continue;
    EXPECT_GE(frame.newtons[0], 0.0F);
    EXPECT_LT(frame.newtons[0], 0.1F);
  }
}

TEST(MaterialMemory, a_taxel_without_a_force_counts_as_carrying_its_last_one) {
  Material material(creep_only());
  MaterialMemory memory(creep_only(), 2);
  for (int k = 0; k < 400; ++k) {
    const double newtons = k > 0 ? 8.0 : 0.0;
    const auto felt = static_cast<float>(k == 0 ? 0.0 : material.feel(newtons, 0.05));
    const bool is_known = k < 100 || k >= 300;
    ForceFrame frame = frame_at(0.05 * k, {is_known ? felt : kNan, felt});
    if (!is_known) frame.sigma_newtons[0] = kNan;
    process(memory, frame);
    EXPECT_EQ(std::isnan(frame.newtons[0]), !is_known);
    EXPECT_EQ(std::isnan(frame.sigma_newtons[0]), !is_known);
    if (is_known) {
      EXPECT_NEAR(static_cast<double>(frame.newtons[0]), newtons, 0.01) << k;
    }
    EXPECT_NEAR(static_cast<double>(frame.newtons[1]), newtons, 0.01) << k;
  }
}

TEST(MaterialMemory, a_rejected_frame_is_none) {
  Material material(creep_only());
  MaterialMemory memory(creep_only(), 1);
  for (int k = 0; k < 200; ++k) {
    const auto felt = static_cast<float>(k == 0 ? 0.0 : material.feel(8.0, 0.05));
    ForceFrame frame = frame_at(0.05 * k, {felt});
    if (k % 3 == 1) {
      frame.status = FrameStatus::rejected;
      frame.newtons[0] = kNan;
      frame.time = Nanos(-5);
    }
    process(memory, frame);
    if (k > 1 && k % 3 != 1) {
      EXPECT_NEAR(frame.newtons[0], 8.0F, 0.01F) << k;
    }
  }
}

TEST(MaterialMemory, states_stay_finite_whatever_the_frames_are) {
  MaterialMemory memory(creep_and_hysteresis(), 4);
  Random random(11);
  const std::array<float, 6> odd{0.0F, 3e38F, kNan, 1e-38F, std::numeric_limits<float>::infinity(), 5.0F};
  double seconds = 0.0;
  for (int k = 0; k < 5000; ++k) {
    seconds += random.below(10) == 0 ? 1e6 : 1e-3 * static_cast<double>(random.below(3));
    std::vector<float> newtons;
    for (int taxel = 0; taxel < 4; ++taxel) newtons.push_back(odd[random.below(odd.size())]);
    ForceFrame frame = frame_at(seconds, newtons);
    process(memory, frame);
    for (std::size_t taxel = 0; taxel < 4; ++taxel) {
      EXPECT_EQ(std::isfinite(frame.newtons[taxel]), !std::isnan(newtons[taxel]));
    }
  }
  ForceFrame frame = frame_at(seconds + 1e5, {2.0F, 2.0F, 2.0F, 2.0F});
  process(memory, frame);
  for (const float newtons : frame.newtons) EXPECT_NEAR(newtons, 2.0F, 0.2F);
}

TEST(MaterialMemory, the_load_of_the_first_frame_counts_as_lying_there_for_long) {
  MaterialMemory memory(creep_only(), 1);
  for (const double start : {100.0, 5.0}) {  // earlier: a recording that begins anew
    for (int k = 0; k < 20; ++k) {
      ForceFrame frame = frame_at(start + k, {7.0F});
      process(memory, frame);
      EXPECT_NEAR(frame.newtons[0], 7.0F, 1e-4F);
    }
  }
}

TEST(MaterialMemory, noise_grows_as_the_inverse_does) {
  const MemoryLaw law = creep_only();
  const auto newtons_of = [&](float felt, float& sigma) {
    MaterialMemory memory(law, 1);
    ForceFrame frame;
    for (int k = 0; k < 30; ++k) {
      frame = frame_at(0.01 * k, {k < 5 ? 0.0F : (k < 29 ? 10.0F : felt)}, 0.25F);
      process(memory, frame);
    }
    sigma = frame.sigma_newtons[0];
    return frame.newtons[0];
  };
  float sigma = 0.0F;
  const float below = newtons_of(9.9F, sigma);
  const float above = newtons_of(10.1F, sigma);
  EXPECT_NEAR(sigma / 0.25F, (above - below) / 0.2F, 1e-3F);
  EXPECT_GT(sigma, 0.3F);
}

TEST(MaterialMemory, an_error_that_lasts_a_touch_stays_the_same_share_of_the_force) {
  Material material(creep_only());
  MaterialMemory memory(creep_only(), 2);
  constexpr float kError = 0.05F;
  const std::vector<float> noise{0.0F, 1e-3F};
  for (int k = 0; k < 2000; ++k) {
    const double newtons = k < 5 ? 0.0 : (k < 1000 ? 10.0 : 3.0);
    const auto felt = static_cast<float>(material.feel(newtons, 0.01));
    ForceFrame frame = frame_at(0.01 * k, {felt, felt * (1.0F + kError)});
    frame.sigma_newtons = {kError * felt, std::hypot(kError * felt, noise[1])};
    memory.process(frame, noise);
    if (k < 5) continue;
    EXPECT_NEAR(frame.newtons[1], frame.newtons[0] * (1.0F + kError), 1e-3F) << k;
    EXPECT_NEAR(frame.sigma_newtons[0], kError * std::max(frame.newtons[0], felt), 1e-4F) << k;
    EXPECT_NEAR(frame.sigma_newtons[1], frame.sigma_newtons[0], 1e-4F) << k;
  }
}

TEST(MaterialMemory, every_instruction_set_gives_the_same_and_nothing_is_allocated) {
  std::vector<std::vector<float>> results;
  support::for_each_simd_target([&] {
    constexpr std::size_t kTaxels = 37;
    const std::vector<float> noise(kTaxels, 0.05F);
    MaterialMemory memory(creep_and_hysteresis(), kTaxels);
    Random random(13);
    ForceFrame frame;
    for (int k = 0; k < 100; ++k) {
      std::vector<float> newtons(kTaxels);
      for (float& force : newtons) force = static_cast<float>(random.below(2) == 0 ? 0.0 : random.uniform(0.0, 30.0));
      frame = frame_at(0.013 * k, newtons);
      const support::AllocationGuard guard;
      memory.process(frame, noise);
      if (support::kAllocationsAreCounted) {
        EXPECT_EQ(guard.count(), 0U);
      }
    }
    results.push_back(frame.newtons);
  });
  ASSERT_FALSE(results.empty());
  for (const std::vector<float>& result : results) {
    for (std::size_t taxel = 0; taxel < result.size(); ++taxel) {
      EXPECT_NEAR(result[taxel], results[0][taxel], 1e-4F * results[0][taxel] + 1e-5F);
    }
  }
}

TEST(MemoryLaw, is_consistent_where_its_inverse_is_stable) {
  EXPECT_TRUE(MemoryLaw{}.is_consistent());
  EXPECT_TRUE(creep_and_hysteresis().is_consistent());
  EXPECT_FALSE((MemoryLaw{{0.3F, 0.3F, 0.2F, 0.1F}, {}}).is_consistent());
  EXPECT_FALSE((MemoryLaw{{-0.01F}, {}}).is_consistent());
  EXPECT_FALSE((MemoryLaw{{kNan}, {}}).is_consistent());
  EXPECT_FALSE((MemoryLaw{{}, {0.5F, 0.5F, 0.0F}}).is_consistent());
  EXPECT_FALSE((MemoryLaw{{}, {0.0F, std::numeric_limits<float>::infinity(), 0.0F}}).is_consistent());
}

/// Of taxels that feel signed noise of a hundredth of a newton.
ForceFrame noisy_frame(double seconds, std::size_t taxels, Random& random) {
  std::vector<float> newtons(taxels);
  for (float& value : newtons) value = static_cast<float>(0.01 * random.normal());
  ForceFrame frame = frame_at(seconds, newtons, 0.01F);
  frame.sums.newtons = newtons;
  frame.sums.own_variance.assign(taxels, 0.0F);
  frame.sums.newtons_per_siemens.assign(taxels, 1.0F);
  frame.sums.newtons_per_celsius.assign(taxels, 0.0F);
  for (float& value : frame.newtons) value = std::max(value, 0.0F);
  return frame;
}

TEST(MaterialMemory, noise_of_unloaded_taxels_cancels_in_sums) {
  constexpr std::size_t kTaxels = 400;
  MaterialMemory memory(creep_and_hysteresis(), kTaxels);
  Random random(7);
  double mean = 0.0;
  for (int k = 0; k < 500; ++k) {
    ForceFrame frame = noisy_frame(0.05 * k, kTaxels, random);
    process(memory, frame);
    if (k >= 100) mean += frame.total().newtons / (400.0 * kTaxels);
  }
  EXPECT_NEAR(mean, 0.0, 1e-4) << "seed 7";
}

TEST(MaterialMemory, a_loaded_taxel_counts_in_sums_as_it_is_freed) {
  MaterialMemory memory(creep_and_hysteresis(), 2);
  for (int k = 0; k < 20; ++k) {
    ForceFrame frame = frame_at(0.1 * k, {5.0F + static_cast<float>(k), kNan});
    frame.sums.newtons = frame.newtons;
    frame.sums.own_variance = {0.0F, 0.0F};
    frame.sums.newtons_per_siemens = frame.sums.newtons_per_celsius = {0.0F, 0.0F};
    process(memory, frame);
    EXPECT_FLOAT_EQ(frame.sums.newtons[0], frame.newtons[0]);
    EXPECT_EQ(frame.total().left_out, 1U);
  }
}

}  // namespace
}  // namespace dermis::touch::fusion
