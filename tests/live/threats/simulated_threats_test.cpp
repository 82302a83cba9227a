// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Threats from counts of a simulated array: the noise of a 12-bit ADC, a temperature that is read with noise, patches
// whose pressure on the taxels is summed over small pieces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "dermis/learn/simulation/adc.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/learn/simulation/rubber_memory.hpp"
#include "dermis/live/threats/threat_monitor.hpp"
#include "dermis/touch/contacts/contact_tracker.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "support/hand_made_model.hpp"
#include "support/pressure_patches.hpp"

namespace dermis::live::threats {
namespace {

constexpr std::size_t kLines = 16;
constexpr double kSupplyV = 5.0;
constexpr double kTemperatureNoiseCelsius = 0.3;
constexpr double kStill = 40.0;  // N

touch::pipeline::Model sheet_model() {
  touch::pipeline::Model model = support::hand_made_model(kLines, kLines);
  model.array.readout.adc_bits = 12;
  model.array.taxel_area_m2 = 38.48e-6;
  return model;
}

/// The same of rubber with memory that no calibration has learned: its standard deviation is the gain of a touch.
touch::pipeline::Model rubber_model() {
  touch::pipeline::Model model = sheet_model();
  const auto touch_gain = static_cast<float>(learn::simulation::RubberMemoryOptions{}.touch_gain);
  std::fill(model.networks.relative_sigma.begin(), model.networks.relative_sigma.end(), touch_gain);
  return model;
}

/// From forces on the taxels to threats.
class Sheet {
 public:
  Sheet(const std::vector<ThreatLimit>& limits, std::uint64_t seed) : Sheet(sheet_model(), limits, seed) {}

  static Sheet of_rubber(const std::vector<ThreatLimit>& limits, std::uint64_t seed) {
    Sheet sheet(rubber_model(), limits, seed);
    sheet.memory_.emplace(learn::simulation::RubberMemoryOptions{}, kLines * kLines, seed);
    return sheet;
  }

  /// Whether a threat stands. Of rubber, the forces have lain on it since the frame before.
  bool see(const std::vector<double>& newtons, double seconds, double celsius) {
    siemens_.resize(newtons.size());
    ratio_.resize(newtons.size());
    if (memory_) memory_->press(newtons, seconds - seconds_);
    seconds_ = seconds;
    for (std::size_t k = 0; k < newtons.size(); ++k) siemens_[k] = siemens_at(k, newtons[k], celsius);
    circuit_.ratios(siemens_, ratio_);
    raw_.counts.resize(newtons.size());
    adc_.convert(ratio_, kSupplyV, random_, raw_.counts);
    raw_.time = Nanos(std::llround(seconds * 1e9));
    raw_.supply_v = kSupplyV;
    raw_.temperature_celsius = celsius + kTemperatureNoiseCelsius * random_.normal();
    pipeline_.process(raw_, force_);
    contacts_.process(force_, report_);
    monitor_.process(force_, report_);
    const std::span<const ThreatState> states = monitor_.states();
    return std::any_of(states.begin(), states.end(),
                       [](const ThreatState& state) { return state.phase == ThreatPhase::standing; });
  }

 private:
  Sheet(touch::pipeline::Model model, const std::vector<ThreatLimit>& limits, std::uint64_t seed)
      : model_(std::move(model)),
        circuit_(*learn::simulation::ReadoutCircuit::create(model_.array)),
        adc_(model_.array.readout, 1.0),
        pipeline_(*touch::pipeline::Pipeline::create(model_)),
        contacts_(model_.array),
        monitor_(*ThreatMonitor::create({{}, limits}, model_.array.name, model_.array)),
        random_(seed) {}

  [[nodiscard]] double siemens_at(std::size_t taxel, double newtons, double celsius) const {
    if (!memory_) return support::siemens_under(model_, taxel, newtons, celsius);
    const double unloaded = support::siemens_under(model_, taxel, 0.0, celsius);
    return support::siemens_under(model_, taxel, memory_->material_force(taxel), celsius) -
           (1.0 - memory_->unloaded_share(taxel)) * unloaded;
  }

  touch::pipeline::Model model_;
  std::optional<learn::simulation::RubberMemory> memory_;
  double seconds_ = 0.0;  // of the frame before
  learn::simulation::ReadoutCircuit circuit_;
  learn::simulation::Adc adc_;
  touch::pipeline::Pipeline pipeline_;
  touch::contacts::ContactTracker contacts_;
  ThreatMonitor monitor_;
  Random random_;
  std::vector<double> siemens_;
  std::vector<double> ratio_;
  RawFrame raw_;
  ForceFrame force_;
  ContactReport report_;
};

ThreatLimit contact_limit(double newtons) {
  return {.name = "pushed", .quantity = ThreatQuantity::contact_force, .limit = newtons};
}

ThreatLimit rate_limit(double newtons_per_s) {
  return {.name = "hit", .quantity = ThreatQuantity::force_rate, .limit = newtons_per_s};
}

ThreatLimit sharp_limit() {
  return {.name = "needle", .quantity = ThreatQuantity::sharp_pressure, .limit = 60e3};
}

/// A patch somewhere inside the array; its force is set by who presses it.
support::PressurePatch somewhere(Random& random, double diameter_m) {
  const double x = random.uniform(0.03, 0.12);
  return support::round_patch(x, random.uniform(0.03, 0.12), diameter_m, 1.0);
}

std::vector<double> scaled(const std::vector<double>& shares, double factor) {
  std::vector<double> newtons = shares;
  for (double& force : newtons) force *= factor;
  return newtons;
}

double sum_of(const std::vector<double>& newtons) {
  double sum = 0.0;
  for (const double force : newtons) sum += force;
  return sum;
}

/// Frames from when the true value is beyond the limit until the threat stands; empty where it never does or where it
/// stands before.
std::optional<int> delay(Sheet& sheet, const std::vector<double>& shares, double frames_per_s,
                         const std::function<double(double)>& on_taxels, double crossing_s) {
  std::optional<int> frames;
  for (int k = 0; k < static_cast<int>(0.3 * frames_per_s); ++k) {
    const double seconds = k / frames_per_s;
    const bool beyond = seconds >= crossing_s;
    if (beyond) frames = frames.value_or(0) + 1;
    if (sheet.see(scaled(shares, on_taxels(seconds)), seconds, 25.0)) return frames;
  }
  return std::nullopt;
}

enum class Material { without_memory, rubber };

/// At so many frames a second.
class AtAnyRate : public testing::TestWithParam<std::tuple<double, Material>> {
 protected:
  static double rate() { return std::get<double>(GetParam()); }
  static bool is_rubber() { return std::get<Material>(GetParam()) == Material::rubber; }
  static Sheet sheet(const std::vector<ThreatLimit>& limits, std::uint64_t seed) {
    return is_rubber() ? Sheet::of_rubber(limits, seed) : Sheet(limits, seed);
  }
};

// A ramp to far beyond the limit within 10 ms, as of a robot that does not stop.
TEST_P(AtAnyRate, over_force_stands_within_two_frames_and_that_on_fast_rubber_within_three) {
  constexpr double kLimit = 20.0;
  const int most_frames = is_rubber() && rate() > 500.0 ? 3 : 2;  // rubber feels a sudden force late
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    Sheet sheet = AtAnyRate::sheet({contact_limit(kLimit)}, seed);
    std::vector<double> shares = support::taxel_forces(sheet_model().array, {somewhere(random, 0.025)});
    shares = scaled(shares, 1.0 / sum_of(shares));
    const auto ramp = [](double seconds) { return std::clamp((seconds - 0.1) / 0.01, 0.0, 1.0) * 60.0; };
    const std::optional<int> frames = delay(sheet, shares, rate(), ramp, 0.1 + 0.01 * kLimit / 60.0);
    ASSERT_TRUE(frames);
    EXPECT_LE(*frames, most_frames);
  }
}

TEST_P(AtAnyRate, a_hit_stands_within_two_frames) {
  constexpr double kLimit = 1000.0;  // N/s: 30 N in 30 ms
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    Sheet sheet = AtAnyRate::sheet({rate_limit(kLimit)}, seed);
    std::vector<double> shares = support::taxel_forces(sheet_model().array, {somewhere(random, 0.025)});
    shares = scaled(shares, 1.0 / sum_of(shares));
    const auto hit = [](double seconds) { return std::clamp((seconds - 0.1) / 0.005, 0.0, 1.0) * 60.0; };
    const std::optional<int> frames = delay(sheet, shares, rate(), hit, 0.1 + 0.005 * 30.0 / 60.0);
    ASSERT_TRUE(frames);
    EXPECT_LE(*frames, 2);
  }
}

TEST_P(AtAnyRate, needles_are_sharp) {
  constexpr int kNeedles = 60;
  const double lightest = is_rubber() ? 5.0 : 3.5;
  int found = 0;
  for (int seed = 1; seed <= kNeedles; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    Sheet sheet = AtAnyRate::sheet({sharp_limit()}, static_cast<std::uint64_t>(seed));
    std::vector<double> newtons(kLines * kLines, 0.0);
    newtons[random.below(newtons.size())] = random.uniform(lightest, 10.0);
    bool stands = false;
    for (int k = 0; k < 5; ++k) stands = sheet.see(newtons, k / rate(), 25.0) || stands;
    found += stands ? 1 : 0;
  }
  EXPECT_GE(found, kNeedles * 95 / 100);
}

// 20 to 45 N that rise in 0.2 s, by fingers, palms and elbows, against limits that lie above.
TEST_P(AtAnyRate, pushes_below_the_limits_raise_no_alarm) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const support::PressurePatch patch = somewhere(random, random.uniform(0.025, 0.05));
    const std::vector<double> shares = support::taxel_forces(sheet_model().array, {patch});
    const double force = random.uniform(20.0, 45.0);
    Sheet sheet = AtAnyRate::sheet({contact_limit(50.0), rate_limit(1000.0), sharp_limit()}, seed);
    for (int k = 0; k < static_cast<int>(0.4 * rate()); ++k) {
      const double seconds = k / rate();
      const double newtons = force * std::clamp(seconds / 0.2, 0.0, 1.0);
      ASSERT_FALSE(sheet.see(scaled(shares, newtons), seconds, 25.0)) << seconds;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(FramesPerSecond, AtAnyRate,
                         testing::Combine(testing::Values(100.0, 1000.0),
                                          testing::Values(Material::without_memory, Material::rubber)));

/// When an alarm comes of 40 N that lie still for ten minutes while the sheet warms up by 15 C; empty: never.
std::optional<double> alarm_s(Sheet sheet, double frames_per_s) {
  constexpr double kSeconds = 600.0;
  Random random(1);
  const support::PressurePatch patch = somewhere(random, 0.03);
  std::vector<double> shares = support::taxel_forces(sheet_model().array, {patch});
  shares = scaled(shares, kStill / sum_of(shares));
  for (int k = 0; k < static_cast<int>(kSeconds * frames_per_s); ++k) {
    const double seconds = k / frames_per_s;
    const double celsius = 20.0 + 15.0 * seconds / kSeconds;
    if (sheet.see(shares, seconds, celsius)) return seconds;
  }
  return std::nullopt;
}

TEST(SimulatedThreats, a_load_below_the_limit_raises_no_alarm_while_the_sheet_warms_up) {
  EXPECT_EQ(alarm_s(Sheet({contact_limit(kStill / 0.8)}, 1), 100.0), std::nullopt);
}

TEST(SimulatedThreats, rubber_that_creeps_raises_no_alarm_at_four_fifths_of_the_limit) {
  EXPECT_EQ(alarm_s(Sheet::of_rubber({contact_limit(kStill / 0.8)}, 1), 10.0), std::nullopt);
}

TEST(SimulatedThreats, rubber_that_creeps_raises_an_alarm_at_nine_tenths_of_the_limit_only_after_half_a_minute) {
  const std::optional<double> seconds = alarm_s(Sheet::of_rubber({contact_limit(kStill / 0.9)}, 1), 10.0);
  ASSERT_TRUE(seconds);
  EXPECT_GT(*seconds, 30.0);
}

}  // namespace
}  // namespace dermis::live::threats
