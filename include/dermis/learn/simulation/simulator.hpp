// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/learn/simulation/adc.hpp"
#include "dermis/learn/simulation/line_faults.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/learn/simulation/rubber.hpp"
#include "dermis/learn/simulation/sampling_capacitor.hpp"
#include "dermis/learn/simulation/scene.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::simulation {

struct SimulationOptions {
  RubberOptions rubber;
  EnvironmentOptions environment;
  LineFaults faults;
  SceneOptions scene;

  [[nodiscard]] Status validate() const;
};

/// Reads the tables [rubber], [environment] and [faults] of a TOML file; keys are the field names, absent keys keep
/// their defaults. `rubber.carbon_percent` (5, 10 or 15) sets the defaults of that grade. Unknown keys are errors.
[[nodiscard]] Result<SimulationOptions> read_simulation_options(const std::string& path);

class CoverSpread;

/// A simulated array as a source of frames: scene -> cover -> rubber -> readout circuit -> ADC. The piece of rubber
/// depends only on RubberOptions::seed, so the same array can go through several scenes. `seed` drives contacts,
/// supply, temperature and all noise. Not thread-safe: one reader. Many members: each stage between a scene and its
/// frame.
class Simulator final : public FrameSource {
 public:
  /// `frames`: number of frames of the scenes "multitouch", "contacts", "idle" and "touches". Fails as Scene::create
  /// and ConductiveRubber::create do.
  [[nodiscard]] static Result<std::unique_ptr<Simulator>> create(const ArrayDescription& array,
                                                                 const SimulationOptions& options,
                                                                 std::string_view scene, std::uint64_t seed,
                                                                 std::optional<std::size_t> frames = {});

  [[nodiscard]] Result<bool> next(RawFrame& frame) override;
  [[nodiscard]] std::optional<FrameShape> shape() const override { return FrameShape{array_.rows, array_.cols}; }

  [[nodiscard]] std::size_t frame_count() const noexcept { return scene_.frame_count(); }

  /// The knowledge of a calibration rig about the last frame: its lines of loads.csv.
  [[nodiscard]] const std::vector<Load>& loads() const noexcept { return truth_.loads; }

  /// The hidden truth of the last frame: true forces, contacts, temperature and supply.
  [[nodiscard]] const SceneFrame& truth() const noexcept { return truth_; }

  /// True conductances of the last frame [S], [rows, cols].
  [[nodiscard]] const std::vector<double>& true_siemens() const noexcept { return siemens_; }

  /// The true law of the material.
  [[nodiscard]] const ConductiveRubber& rubber() const noexcept { return rubber_; }

  ~Simulator() override;
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

 private:
  [[nodiscard]] double celsius_at(const TemperatureSensor& place) const;
  [[nodiscard]] std::vector<double> taxel_celsius() const;
  void measure_temperature(RawFrame& frame);

  Simulator(ArrayDescription array, Scene scene, ConductiveRubber rubber, ReadoutCircuit circuit,
            std::optional<FaultyCircuit> faulty, const EnvironmentOptions& environment, std::uint64_t seed);

  ArrayDescription array_;
  Scene scene_;
  ConductiveRubber rubber_;
  ReadoutCircuit circuit_;
  std::optional<FaultyCircuit> faulty_;
  SamplingCapacitor capacitor_;
  Adc adc_;
  std::unique_ptr<const CoverSpread> cover_;
  EnvironmentOptions environment_;
  Random instruments_;
  std::size_t next_frame_ = 0;
  double time_s_ = 0.0;
  SceneFrame truth_;
  std::vector<double> unloaded_n_;
  std::vector<double> siemens_;
  std::vector<double> ratio_;
};

}  // namespace dermis::learn::simulation
