// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/simulator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "support/reference_array.hpp"

namespace dermis::learn::simulation {
namespace {

using support::reference_array;

std::unique_ptr<Simulator> simulate(const ArrayDescription& array, std::string_view scene, std::uint64_t seed,
                                    std::optional<std::size_t> frames = {}, const SimulationOptions& options = {}) {
  return Simulator::create(array, options, scene, seed, frames).value();
}

std::vector<RawFrame> record(Simulator& simulator) {
  std::vector<RawFrame> frames;
  for (RawFrame frame; *simulator.next(frame);) frames.push_back(frame);
  return frames;
}

bool same_frame(const RawFrame& a, const RawFrame& b) {
  return a.time == b.time && a.temperature_celsius == b.temperature_celsius && a.supply_v == b.supply_v &&
         a.counts == b.counts;
}

TEST(Simulator, gives_as_many_frames_as_the_scene_has) {
  const auto simulator = simulate(reference_array(4, 3), "multitouch", 1, 25);
  EXPECT_EQ(simulator->frame_count(), 25U);
  const auto frames = record(*simulator);
  ASSERT_EQ(frames.size(), 25U);
  EXPECT_EQ(frames[0].counts.size(), 12U);
  EXPECT_EQ(frames[24].time, std::chrono::seconds(25));
  RawFrame frame;
  EXPECT_FALSE(*simulator->next(frame));
}

TEST(Simulator, same_seed_gives_the_same_frames_in_any_thread) {
  const ArrayDescription array = reference_array(5, 5);
  std::vector<std::vector<RawFrame>> runs(8);
  std::vector<std::jthread> threads;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    threads.emplace_back([&, i] { runs[i] = record(*simulate(array, "multitouch", i / 2, 40)); });
  }
  threads.clear();
  for (std::size_t frame = 0; frame < 40; ++frame) {
    for (std::size_t i = 0; i < runs.size(); i += 2) EXPECT_TRUE(same_frame(runs[i][frame], runs[i + 1][frame]));
    EXPECT_FALSE(same_frame(runs[0][frame], runs[2][frame]));
  }
}

TEST(Simulator, the_same_piece_of_rubber_goes_through_all_scenes) {
  const ArrayDescription array = reference_array(4, 4);
  const auto calibration = simulate(array, "calibration", 1);
  const auto multitouch = simulate(array, "multitouch", 2);
  for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
    EXPECT_EQ(calibration->rubber().conductance_from_force(taxel, 7.0, 33.0),
              multitouch->rubber().conductance_from_force(taxel, 7.0, 33.0));
  }
}

TEST(Simulator, true_law_finds_the_true_forces_but_for_the_material_noise) {
  const ArrayDescription array = reference_array(8, 8);
  const auto simulator = simulate(array, "multitouch", 3, 100);
  RawFrame frame;
  while (*simulator->next(frame)) {
    for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
      const double true_n = simulator->truth().force_n[taxel];
      const double found_n = simulator->rubber().force_from_conductance(taxel, simulator->true_siemens()[taxel],
                                                                        simulator->truth().temperature_celsius);
      if (true_n >= 1.0) {
        EXPECT_NEAR(found_n / true_n, 1.0, 2e-3);
      }
    }
  }
}

TEST(Simulator, counts_are_the_circuits_readings) {
  const ArrayDescription array = reference_array(6, 6);
  SimulationOptions options;
  options.environment.adc_noise_lsb = 0.0;
  const auto simulator = simulate(array, "multitouch", 4, 20, options);
  const ReadoutCircuit circuit = ReadoutCircuit::create(array).value();
  std::vector<double> ratio(array.taxel_count());
  RawFrame frame;
  while (*simulator->next(frame)) {
    circuit.ratios(simulator->true_siemens(), ratio);
    for (std::size_t i = 0; i < ratio.size(); ++i) {
      EXPECT_NEAR(frame.counts[i], ratio[i] * simulator->truth().supply_v / 5.0 * 4095.0, 0.5 + 1e-6);
    }
  }
}

TEST(Simulator, a_film_follows_the_forces_on_the_taxels) {
  ArrayDescription array = reference_array(6, 6);
  array.readout.film = Film{50e3, 500.0, 20.0};
  SimulationOptions options;
  options.environment.adc_noise_lsb = 0.0;
  const auto simulator = simulate(array, "multitouch", 4, 20, options);
  const ReadoutCircuit circuit = ReadoutCircuit::create(array).value();
  std::vector<double> ratio(array.taxel_count());
  RawFrame frame;
  while (*simulator->next(frame)) {
    circuit.ratios(simulator->true_siemens(), simulator->truth().force_n, ratio);
    for (std::size_t i = 0; i < ratio.size(); ++i) {
      EXPECT_NEAR(frame.counts[i], ratio[i] * simulator->truth().supply_v / 5.0 * 4095.0, 0.5 + 1e-6);
    }
  }
}

TEST(Simulator, instruments_report_with_their_noise) {
  constexpr std::size_t kFrames = 4000;
  const auto simulator = simulate(reference_array(1, 1), "idle", 5, kFrames);
  double temperature_variance = 0.0;
  double supply_variance = 0.0;
  RawFrame frame;
  while (*simulator->next(frame)) {
    const double celsius = *frame.temperature_celsius - simulator->truth().temperature_celsius;
    const double relative = *frame.supply_v / simulator->truth().supply_v - 1.0;
    temperature_variance += celsius * celsius / kFrames;
    supply_variance += relative * relative / kFrames;
  }
  const double five_sigma = 5.0 * std::sqrt(2.0 / kFrames);
  EXPECT_NEAR(temperature_variance / (0.3 * 0.3), 1.0, five_sigma);
  EXPECT_NEAR(supply_variance / (0.001 * 0.001), 1.0, five_sigma);
}

TEST(Simulator, sensors_at_opposite_edges_show_the_gradient) {
  ArrayDescription array = reference_array(8, 8);
  array.temperature_sensors = {{3.5, 0.0}, {3.5, 7.0}};
  SimulationOptions options;
  options.environment.gradient_celsius = 10.0;
  options.environment.temperature_noise_celsius = 0.0;
  const auto simulator = Simulator::create(array, options, "idle", 5, 10);
  ASSERT_TRUE(simulator) << simulator.error().message;
  RawFrame frame;
  ASSERT_TRUE((*simulator)->next(frame));
  ASSERT_EQ(frame.sensor_celsius.size(), 2U);
  EXPECT_FALSE(frame.temperature_celsius);
  EXPECT_NEAR(frame.sensor_celsius[1] - frame.sensor_celsius[0], 10.0, 0.1);  // the warm edge begins on the right
  EXPECT_NEAR(0.5 * (frame.sensor_celsius[0] + frame.sensor_celsius[1]), (*simulator)->truth().temperature_celsius,
              1e-4);
}

TEST(Simulator, creep_is_seen_in_the_conductance_of_a_press) {
  SimulationOptions options;
  options.rubber.creep = 0.1;
  options.rubber.pink_noise = 0.0;
  const auto simulator = simulate(reference_array(4, 4), "paper", 6, {}, options);
  RawFrame frame;
  ASSERT_TRUE(*simulator->next(frame));
  const Load press = simulator->loads().front();
  const std::size_t taxel = 4 * press.where.first_row + press.where.first_col;
  const double material_n = simulator->rubber().force_from_conductance(taxel, simulator->true_siemens()[taxel], 20.0);
  const double late = (3.0 - std::exp(-10.0) - std::exp(-1.0 / 3.0) - std::exp(-0.01)) / 3.0;
  EXPECT_NEAR(material_n, press.value * (0.9 + 0.1 * late), 1e-9);
}

TEST(Simulator, the_simple_memory_gives_the_counts_that_it_always_gave) {
  SimulationOptions options;
  options.rubber.hysteresis = 0.1;
  options.rubber.creep = 0.06;
  options.rubber.pink_noise = 1e-6;
  options.rubber.mechanical_spread = 0.05;
  const auto frames = record(*simulate(reference_array(3, 4), "multitouch", 5, 120, options));
  // As printed by dermis before it had another memory.
  EXPECT_EQ(frames[99].counts, (std::vector<float>{315, 366, 533, 1206, 308, 363, 495, 758, 283, 337, 410, 305}));
  EXPECT_EQ(frames[119].counts, (std::vector<float>{169, 63, 77, 45, 215, 134, 99, 48, 371, 336, 94, 48}));
}

TEST(Simulator, touches_of_rubber_that_remembers_read_more_the_longer_they_last) {
  SimulationOptions options;
  options.rubber.memory.emplace().touch_gain = 0.0;
  options.scene = {.rate_hz = 20.0, .taxels = 1};
  const auto simulator = simulate(reference_array(4, 4), "two_weights", 6, {}, options);
  std::vector<double> material_n;
  RawFrame frame;
  while (*simulator->next(frame) && material_n.size() < 240) {
    const auto& force_n = simulator->truth().force_n;
    const auto pressed = std::max_element(force_n.begin(), force_n.end());
    if (*pressed != 5.0) continue;
    const auto taxel = static_cast<std::size_t>(pressed - force_n.begin());
    material_n.push_back(simulator->rubber().force_from_conductance(taxel, simulator->true_siemens()[taxel], 22.0));
  }
  ASSERT_EQ(material_n.size(), 240U);
  EXPECT_NEAR(material_n[200] / material_n[20], 1.1, 0.01) << "10 s against 1 s";
}

TEST(Simulator, refuses_options_out_of_range) {
  SimulationOptions options;
  options.rubber.hysteresis = 2.0;
  EXPECT_EQ(options.validate().error().message.find("rubber.hysteresis:"), 0U);
  EXPECT_EQ(Simulator::create(reference_array(2, 2), options, "idle", 1).error().kind, ErrorKind::bad_input);
}

Result<SimulationOptions> read_text(const std::string& text) {
  const auto path =
      std::filesystem::temp_directory_path() / ("dermis_" + std::to_string(std::random_device{}()) + ".toml");
  std::ofstream(path) << text;
  Result<SimulationOptions> options = read_simulation_options(path.string());
  std::filesystem::remove(path);
  return options;
}

TEST(SimulationOptionsFile, sets_what_it_names_and_keeps_the_other_defaults) {
  const auto options = read_text("[rubber]\nseed = 9\nhysteresis = 0.1\n[environment]\nadc_noise_lsb = 0.5\n");
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(options->rubber.seed, 9U);
  EXPECT_EQ(options->rubber.hysteresis, 0.1);
  EXPECT_EQ(options->rubber.exponent, RubberOptions{}.exponent);
  EXPECT_EQ(options->environment.adc_noise_lsb, 0.5);
  EXPECT_EQ(options->environment.supply_noise, EnvironmentOptions{}.supply_noise);
}

TEST(SimulationOptionsFile, grade_comes_before_the_other_keys) {
  const auto options = read_text("[rubber]\nexponent = 0.95\ncarbon_percent = 15\n");
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(options->rubber.exponent, 0.95);
  EXPECT_EQ(options->rubber.resistance_at_10n_ohm, rubber_grade(15)->resistance_at_10n_ohm);
}

TEST(SimulationOptionsFile, sets_the_memory_of_rubber) {
  EXPECT_FALSE(read_text("[rubber]\nmemory = \"simple\"\ncreep = 0.1\n")->rubber.memory);
  const auto options = read_text("[rubber]\nmemory = \"rubber\"\ncreep_per_decade = 0.2\nrelease_dip = 0.1\n");
  ASSERT_TRUE(options) << options.error().message;
  ASSERT_TRUE(options->rubber.memory);
  EXPECT_EQ(options->rubber.memory->creep_per_decade, 0.2);
  EXPECT_EQ(options->rubber.memory->release_dip, 0.1);
  EXPECT_EQ(options->rubber.memory->loop_gap, RubberMemoryOptions{}.loop_gap);
  EXPECT_EQ(options->rubber.memory->touch_gain, RubberMemoryOptions{}.touch_gain);
}

TEST(SimulationOptionsFile, ages_the_rubber) {
  const auto options = read_text("[rubber]\ngain = 0.9\ngain_spread = 0.1\n");
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(options->rubber.gain, 0.9);
  EXPECT_EQ(options->rubber.gain_spread, 0.1);
}

TEST(SimulationOptionsFile, names_what_is_wrong) {
  EXPECT_NE(read_text("[rubber]\nhysterisis = 0.1\n").error().message.find("hysteresis"), std::string::npos);
  EXPECT_NE(read_text("[rubber]\ncreep = 3\n").error().message.find("rubber.creep"), std::string::npos);
  EXPECT_NE(read_text("[rubber]\ncarbon_percent = 7\n").error().message.find("5, 10 or 15"), std::string::npos);
  EXPECT_NE(read_text("[rubber]\ntouch_gain = 0.1\n").error().message.find("needs memory = \"rubber\""),
            std::string::npos);
  EXPECT_NE(read_text("[rubber]\nmemory = \"rubber\"\ncreep = 0.1\n").error().message.find("must be 0 for"),
            std::string::npos);
  EXPECT_NE(read_text("[rubber]\nmemory = \"elephant\"\n").error().message.find("rubber.memory"), std::string::npos);
  EXPECT_EQ(read_simulation_options("/nonexistent/options.toml").error().kind, ErrorKind::bad_input);
}

}  // namespace
}  // namespace dermis::learn::simulation
