// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "commands.hpp"
#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/frames_csv.hpp"
#include "dermis/bytes/files/loads_csv.hpp"
#include "dermis/bytes/files/npy.hpp"
#include "dermis/bytes/files/origin_toml.hpp"
#include "dermis/learn/simulation/simulator.hpp"
#include "dermis/touch/frames/millimetres.hpp"
#include "interruption.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

constexpr const char* kField = "field";  // the scene of --field

struct SimulateOptions {
  std::string array;
  std::string scene;
  std::string field;
  std::string out;
  std::string physics;
  std::uint64_t seed = 1;
  std::optional<std::size_t> frames;
  std::optional<double> rate_hz;
  std::optional<std::size_t> taxels;
  std::string memory;
  std::optional<double> creep_per_decade;
  std::optional<double> touch_gain;
  std::vector<double> film;  ///< As --film; empty: the array's.
  std::optional<double> cover_mm;
};

Status set_film(const std::vector<double>& values, ArrayDescription& array) {
  if (values.empty()) return Done{};
  Film film{values.front(), values.front()};
  if (values.size() == 2) return bad_input("--film: needs one resistance, or UNLOADED,LOADED,NEWTONS");
  if (values.size() == 3) film = {values[0], values[1], values[2]};
  array.readout.film = film;
  if (Status valid = array.validate(); !valid) return bad_input("--film: " + valid.error().message);
  return Done{};
}

Status set_memory(const SimulateOptions& options, learn::simulation::RubberOptions& rubber) {
  if (!options.memory.empty()) {
    Status chosen = learn::simulation::choose_memory(options.memory, rubber);
    if (!chosen) return bad_input("--" + chosen.error().message);
  }
  if (!options.creep_per_decade && !options.touch_gain) return Done{};
  if (!rubber.memory) return bad_input("--creep-per-decade, --touch-gain: need --memory rubber");
  rubber.memory->creep_per_decade = options.creep_per_decade.value_or(rubber.memory->creep_per_decade);
  rubber.memory->touch_gain = options.touch_gain.value_or(rubber.memory->touch_gain);
  return Done{};
}

/// Newtons of an array of NumPy (frames, rows, cols).
Result<std::vector<float>> read_field(const std::string& path, const ArrayDescription& array) {
  const bytes::files::NpyInput input{.rate_hz = 1.0, .shape = FrameShape{array.rows, array.cols}};
  const Result<std::unique_ptr<bytes::files::NpyReader>> file = bytes::files::NpyReader::open(path, input);
  if (!file) return file.error();
  std::vector<float> newtons;
  RawFrame frame;
  while (true) {
    const Result<bool> more = (*file)->next(frame);
    if (!more) return more.error();
    if (!*more) return newtons;
    newtons.insert(newtons.end(), frame.counts.begin(), frame.counts.end());
  }
}

Result<std::unique_ptr<learn::simulation::Simulator>> create_simulator(const SimulateOptions& options,
                                                                       const ArrayDescription& array) {
  learn::simulation::SimulationOptions physics;
  if (!options.physics.empty()) {
    Result<learn::simulation::SimulationOptions> read = learn::simulation::read_simulation_options(options.physics);
    if (!read) return read.error();
    physics = *read;
  }
  if (Status set = set_memory(options, physics.rubber); !set) return set.error();
  physics.scene = {options.rate_hz, options.taxels};
  if (!options.field.empty()) {
    Result<std::vector<float>> newtons = read_field(options.field, array);
    if (!newtons) return newtons.error();
    physics.scene.field_n = *std::move(newtons);
  }
  return learn::simulation::Simulator::create(array, physics, options.scene, options.seed, options.frames);
}

/// The name of the same frames among sources, without other options; a field has none.
std::string source_of(const SimulateOptions& options) {
  return fmt::format("sim:{}?seed={}", options.scene, options.seed);
}

/// The simulator's truth besides the frames themselves.
struct Truth {
  std::vector<Load> loads;
  std::string contacts = "frame,id,shape,x_mm,y_mm,diameter_mm,force_n,taxel_force_n\n";

  void add(std::size_t frame, const learn::simulation::Simulator& simulator) {
    loads.insert(loads.end(), simulator.loads().begin(), simulator.loads().end());
    for (const learn::simulation::AppliedContact& contact : simulator.truth().contacts) {
      contacts += fmt::format("{},{},{},{:.4f},{:.4f},{:.4f},{:.6g},{:.6g}\n", frame, contact.id,
                              learn::simulation::to_string(contact.shape), 1e3 * contact.x_m, 1e3 * contact.y_m,
                              1e3 * contact.diameter_m, contact.force_n, contact.taxel_force_n);
    }
  }

  [[nodiscard]] Status write(const std::filesystem::path& folder, const ArrayDescription& array,
                             bool has_contacts) const {
    if (Status written = bytes::files::write_loads((folder / "loads.csv").string(), array, loads); !written)
      return written;
    if (!has_contacts) return Done{};
    Result<bytes::files::AtomicFile> file = bytes::files::AtomicFile::create((folder / "contacts.csv").string());
    if (!file) return file.error();
    file->write(contacts);
    return file->commit();
  }
};

Result<ArrayDescription> read_covered(const SimulateOptions& options) {
  Result<ArrayDescription> array = bytes::files::read_array(options.array);
  if (!array) return array.error();
  if (options.cover_mm) array->cover = Cover{*options.cover_mm / kMillimetresPerMetre, {}};
  if (array->cover && array->cover->is_unknown()) {
    return bad_input(options.array + ": a cover that is to be fitted cannot be simulated; give --cover MM");
  }
  if (Status valid = array->validate(); !valid) return valid.error();
  return array;
}

Status simulate(const SimulateOptions& options) {
  Result<ArrayDescription> array = read_covered(options);
  if (!array) return array.error();
  if (Status set = set_film(options.film, *array); !set) return set;
  if (array->has_unknown_circuit()) {
    return bad_input(options.array +
                     ": a circuit that is to be fitted cannot be simulated; name it and give its resistances in ohm");
  }
  Result<std::unique_ptr<learn::simulation::Simulator>> simulator = create_simulator(options, *array);
  if (!simulator) return simulator.error();

  const std::filesystem::path folder(options.out);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return failed(fmt::format("cannot create the folder '{}': {}", options.out, error.message()));
  const Result<std::unique_ptr<bytes::files::FramesCsvWriter>> frames =
      bytes::files::FramesCsvWriter::create((folder / "frames.csv").string(), FrameShape{array->rows, array->cols});
  if (!frames) return frames.error();

  Progress progress(array->name);
  Truth truth;
  RawFrame frame;
  const std::size_t count = (*simulator)->frame_count();
  for (std::size_t k = 0;; ++k) {
    const Result<bool> more = (*simulator)->next(frame);
    if (!more) return more.error();
    if (!*more) break;
    if (Status written = (*frames)->write(frame); !written) return written;
    truth.add(k, **simulator);
    progress.show(options.scene, static_cast<double>(k + 1) / static_cast<double>(count));
  }
  if (Status written = (*frames)->commit(); !written) return written;
  Status written = truth.write(folder, *array, learn::simulation::find_scene(options.scene)->has_contacts);
  if (written) written = bytes::files::write_origin((folder / "frames.csv").string(), source_of(options));
  if (!written) std::filesystem::remove(folder / "frames.csv", error);  // worth nothing without its truth
  return written;
}

}  // namespace

void add_simulate(Command& command) {
  auto options = std::make_shared<SimulateOptions>();
  command.input("--array", options->array, "array.toml: size, pitch and readout circuit").required();
  std::vector<std::string> scenes;
  for (const learn::simulation::SceneKind& scene : learn::simulation::scene_kinds()) scenes.emplace_back(scene.name);
  command.option("--scene", options->scene, "What happens to the array").one_of(scenes);
  command.input("--field", options->field, "In place of a scene: newtons of each taxel, .npy [frames, rows, cols]");
  command
      .output_folder("--out", options->out, {"frames.csv", "loads.csv", "contacts.csv", "origin.toml"},
                     "Folder for frames.csv, loads.csv, contacts.csv and origin.toml")
      .required();
  command.option("--seed", options->seed, "Seed of contacts, temperatures, supply and noise").shows_default();
  command.option("--frames", options->frames, "Length of the scenes multitouch, contacts, idle and touches");
  command.option("--rate", options->rate_hz, "Frames a second of touches, two_weights and a field, 10 to 1000");
  command.option("--taxels", options->taxels, "How many taxels the scene two_weights presses");
  command.input("--physics", options->physics, "physics.toml: material and surroundings (docs/simulation.md)");
  command.heading("Material");
  command.option("--memory", options->memory, "What the material remembers; simple: as physics.toml says")
      .one_of({"simple", "rubber"});
  command.option("--creep-per-decade", options->creep_per_decade,
                 "rubber: growth of a held reading in ten times the time, 0.02 to 0.30");
  command.option("--touch-gain", options->touch_gain, "rubber: standard deviation from touch to touch, 0 to 0.3");
  command
      .option("--film", options->film,
              "Sheet that conducts sideways: OHM between neighbours, or UNLOADED,LOADED,NEWTONS; in place of film_ohm")
      .takes_list(3);
  command.option("--cover", options->cover_mm,
                 "A cover spreads forces by a Gaussian of so many mm; loads.csv has what stands on it");
  command.action([options]() -> Status {
    end_when_interrupted();
    if (options->scene.empty() == options->field.empty()) return bad_input("give either --scene or --field");
    if (options->scene.empty()) options->scene = kField;
    return simulate(*options);
  });
}

}  // namespace dermis::app
