// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/simulator.hpp"

#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "dermis/bytes/files/config_table.hpp"
#include "learn/simulation/cover_spread.hpp"

namespace dermis::learn::simulation {
namespace {

// Streams of the scene's seed that no frame index reaches.
constexpr std::uint64_t kRubberNoiseStream = std::numeric_limits<std::uint64_t>::max() - 1;
constexpr std::uint64_t kInstrumentStream = std::numeric_limits<std::uint64_t>::max() - 2;

void read_rubber(bytes::files::ConfigFile& file, RubberOptions& rubber) {
  if (file.contains("rubber.carbon_percent")) {
    int carbon_percent = 10;
    file.integer("rubber.carbon_percent", carbon_percent);
    const Result<RubberOptions> grade = rubber_grade(carbon_percent);
    if (!grade) return file.fail("rubber.carbon_percent", "must be 5, 10 or 15");
    rubber = *grade;
  }
  std::size_t seed = rubber.seed;
  file.count("rubber.seed", seed);
  rubber.seed = seed;
  file.number("rubber.resistance_at_10n_ohm", rubber.resistance_at_10n_ohm);
  file.number("rubber.resistance_spread", rubber.resistance_spread);
  file.number("rubber.exponent", rubber.exponent);
  file.number("rubber.exponent_spread", rubber.exponent_spread);
  file.number("rubber.unloaded_ohm", rubber.unloaded_ohm);
  file.number("rubber.contact_ohm", rubber.contact_ohm);
  file.number("rubber.temperature_coefficient", rubber.temperature_coefficient);
  file.number("rubber.temperature_coefficient_spread", rubber.temperature_coefficient_spread);
  file.number("rubber.temperature_curvature", rubber.temperature_curvature);
  file.number("rubber.hysteresis", rubber.hysteresis);
  file.number("rubber.creep", rubber.creep);
  file.number("rubber.gain", rubber.gain);
  file.number("rubber.gain_spread", rubber.gain_spread);
  file.number("rubber.pink_noise", rubber.pink_noise);
  file.number("rubber.mechanical_spread", rubber.mechanical_spread);
}

void read_memory(bytes::files::ConfigFile& file, RubberOptions& rubber) {
  std::size_t law = 0;
  file.choice("rubber.memory", {"simple", "rubber"}, law);
  RubberMemoryOptions memory;
  const std::pair<const char*, double*> fields[] = {{"rubber.creep_per_decade", &memory.creep_per_decade},
                                                    {"rubber.loop_gap", &memory.loop_gap},
                                                    {"rubber.touch_gain", &memory.touch_gain},
                                                    {"rubber.release_dip", &memory.release_dip}};
  for (const auto& [key, value] : fields) {
    if (law == 0 && file.contains(key)) file.fail(key, "needs memory = \"rubber\"");
    file.number(key, *value);
  }
  if (law == 1) rubber.memory = memory;
}

void read_environment(bytes::files::ConfigFile& file, EnvironmentOptions& environment) {
  file.number("environment.supply_variation", environment.supply_variation);
  file.number("environment.temperature_noise_celsius", environment.temperature_noise_celsius);
  file.number("environment.gradient_celsius", environment.gradient_celsius);
  file.number("environment.supply_noise", environment.supply_noise);
  file.number("environment.adc_noise_lsb", environment.adc_noise_lsb);
}

}  // namespace

Status SimulationOptions::validate() const {
  if (Status valid = rubber.validate(); !valid) return valid;
  return environment.validate();
}

Result<SimulationOptions> read_simulation_options(const std::string& path) {
  Result<bytes::files::ConfigFile> file = bytes::files::ConfigFile::read(path);
  if (!file) return file.error();
  SimulationOptions options;
  read_rubber(*file, options.rubber);
  read_memory(*file, options.rubber);
  read_environment(*file, options.environment);
  read_line_faults(*file, options.faults);
  if (Status complete = file->finish(); !complete) return complete.error();
  if (Status valid = options.validate(); !valid) return bad_input(path + ": " + valid.error().message);
  return options;
}

Simulator::Simulator(ArrayDescription array, Scene scene, ConductiveRubber rubber, ReadoutCircuit circuit,
                     std::optional<FaultyCircuit> faulty, const EnvironmentOptions& environment, std::uint64_t seed)
    : array_(std::move(array)),
      scene_(std::move(scene)),
      rubber_(std::move(rubber)),
      circuit_(std::move(circuit)),
      faulty_(std::move(faulty)),
      capacitor_(array_),
      adc_(array_.readout, environment.adc_noise_lsb),
      cover_(std::make_unique<const CoverSpread>(array_)),
      environment_(environment),
      instruments_(Random::stream(seed, kInstrumentStream)),
      unloaded_n_(rubber_.taxel_count()),
      siemens_(rubber_.taxel_count()),
      ratio_(rubber_.taxel_count()) {}

Result<std::unique_ptr<Simulator>> Simulator::create(const ArrayDescription& array, const SimulationOptions& options,
                                                     std::string_view scene, std::uint64_t seed,
                                                     std::optional<std::size_t> frames) {
  Result<Scene> script = Scene::create(scene, array, options.environment, seed, frames, options.scene);
  if (!script) return script.error();
  const std::uint64_t noise_seed = Random::stream(seed, kRubberNoiseStream).bits();
  Result<ConductiveRubber> rubber = ConductiveRubber::create(options.rubber, array.rows, array.cols, noise_seed);
  if (!rubber) return rubber.error();
  Result<ReadoutCircuit> circuit = ReadoutCircuit::create(array);
  if (!circuit) return circuit.error();
  std::optional<FaultyCircuit> faulty;
  if (options.faults.any()) {
    Result<FaultyCircuit> created = FaultyCircuit::create(array, options.faults);
    if (!created) return created.error();
    faulty = *std::move(created);
  }
  return std::unique_ptr<Simulator>(new Simulator(array, *std::move(script), *std::move(rubber), *std::move(circuit),
                                                  std::move(faulty), options.environment, seed));
}

Simulator::~Simulator() = default;

/// True temperature at a place of the sheet.
double Simulator::celsius_at(const TemperatureSensor& place) const {
  constexpr double kTurnS = 600.0;
  if (environment_.gradient_celsius == 0.0) return truth_.temperature_celsius;
  const auto from_middle = [](double line, std::size_t lines) { return line / static_cast<double>(lines - 1) - 0.5; };
  const double angle = 2.0 * std::numbers::pi * time_s_ / kTurnS;
  const double across = array_.cols > 1 ? from_middle(place.col, array_.cols) * std::cos(angle) : 0.0;
  const double along = array_.rows > 1 ? from_middle(place.row, array_.rows) * std::sin(angle) : 0.0;
  return truth_.temperature_celsius + environment_.gradient_celsius * (across + along);
}

std::vector<double> Simulator::taxel_celsius() const {
  std::vector<double> celsius;
  for (const TemperatureSensor& place : sensors_on_each_taxel(array_.rows, array_.cols)) {
    celsius.push_back(celsius_at(place));
  }
  return celsius;
}

void Simulator::measure_temperature(RawFrame& frame) {
  const auto measured = [&](double celsius) {
    return celsius + environment_.temperature_noise_celsius * instruments_.normal();
  };
  frame.temperature_celsius.reset();
  frame.sensor_celsius.clear();
  if (array_.temperature_sensors.empty()) frame.temperature_celsius = measured(truth_.temperature_celsius);
  for (const TemperatureSensor& sensor : array_.temperature_sensors) {
    frame.sensor_celsius.push_back(static_cast<float>(measured(celsius_at(sensor))));
  }
}

Result<bool> Simulator::next(RawFrame& frame) {
  if (next_frame_ == scene_.frame_count()) return false;
  const std::size_t index = next_frame_++;
  const bool is_faulty = faulty_ && faulty_->present(index);
  frame.acquisition = {};
  scene_.frame(index, truth_);
  for (const std::size_t taxel : array_.absent) truth_.force_n[taxel] = 0.0;
  if (truth_.rest_s > 0.0) rubber_.press(unloaded_n_, truth_.rest_s);
  rubber_.press(cover_->felt(truth_.force_n), truth_.hold_s);
  time_s_ += truth_.rest_s + truth_.hold_s;
  rubber_.read(taxel_celsius(), siemens_);
  for (const std::size_t taxel : array_.absent) siemens_[taxel] = 0.0;
  is_faulty ? faulty_->ratios(siemens_, rubber_.load_n(), index, ratio_)
            : circuit_.ratios(siemens_, rubber_.load_n(), ratio_);
  frame.time = Nanos(std::llround(time_s_ * 1e9));
  measure_temperature(frame);
  frame.supply_v = truth_.supply_v * (1.0 + environment_.supply_noise * instruments_.normal());
  frame.counts.resize(ratio_.size());
  capacitor_.sample(ratio_, truth_.supply_v);
  adc_.convert(ratio_, truth_.supply_v, instruments_, frame.counts);
  if (is_faulty) faulty_->stick(frame.counts);
  return true;
}

}  // namespace dermis::learn::simulation
