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

#include "dermis/core/array_description.hpp"
#include "dermis/core/loads.hpp"
#include "dermis/core/random.hpp"
#include "dermis/core/result.hpp"

namespace dermis::simulation {

/// The surroundings of the array and the instruments that watch them. Defaults: the reference array of the project.
struct EnvironmentOptions {
  double supply_variation = 0.10;          ///< The supply is nominal times 1 +- this, uniform, 0 ... 0.5.
  double temperature_noise_celsius = 0.3;  ///< Sd of the reported temperature [C], 0 ... 20. A digital sensor.
  double supply_noise = 0.001;             ///< Relative sd of the reported supply, 0 ... 0.1.
  double adc_noise_lsb = 1.0;              ///< Sd of the ADC before rounding [counts], 0 ... 1000.

  /// Names the first field that is out of its range, as "environment.supply_noise: ...".
  [[nodiscard]] Status validate() const;
};

/// How the pressure p of a round patch of radius a falls off with the distance r from its centre.
enum class PatchShape {
  hertz,  ///< p = p0 sqrt(1 - r2/a2): a ball on an elastic sheet (Hertz 1882).
  flat,   ///< p = p0: a stamp on a soft one.
};

/// A patch that touches the array in one frame, in the plane of core/contacts.hpp: the origin is the centre of taxel
/// r0c0, x runs along the columns, y along the rows.
struct AppliedContact {
  std::uint32_t id = 0;  ///< From 1 on, in order of onset; the same from onset to release.
  PatchShape shape = PatchShape::hertz;
  double x_m = 0.0;            ///< Centre [m].
  double y_m = 0.0;            ///< Centre [m].
  double diameter_m = 0.0;     ///< 2 a [m].
  double force_n = 0.0;        ///< Of the whole patch [N], > 0.
  double taxel_force_n = 0.0;  ///< What of it lies on taxels [N]; the rest presses between and beside them.

  bool operator==(const AppliedContact&) const = default;
};

/// What happens to the array until one frame is taken, and what is known about it. The frame is taken at the end.
struct SceneFrame {
  double rest_s = 0.0;                   ///< First unloaded for so long [s]; 0: the load changes at once.
  double hold_s = 0.0;                   ///< Then under force_n for so long [s].
  double temperature_celsius = 0.0;      ///< True temperature of the whole array [C].
  double supply_v = 0.0;                 ///< True supply [V].
  std::vector<double> force_n;           ///< True force applied to each taxel [N], [rows, cols].
  std::vector<Load> loads;               ///< The labels of loads.csv; every frame has at least one.
  std::vector<AppliedContact> contacts;  ///< Of the scene "contacts", by id; empty in all others.
};

class ContactScript;

/// A script of loads for an array. The supply is drawn anew each frame around Readout::supply_v (5 V where empty).
///
/// name               loads                                                                      frames
/// calibration        each taxel alone at 14 forces, 0.5 ... 50 N in equal ratios, at 0, 12.5,   5 (20 + 14 taxels)
///                    25, 37.5 and 50 C; the whole array at one force before the next force;
///                    each temperature starts with 20 unloaded frames
/// uniform            an air bladder: 14 pressures, 15 ... 700 kPa in equal ratios, rising       5 (20 + 14 x 5)
///                    without venting, 5 frames each, same temperatures and unloaded frames;
///                    force = pressure times taxel area, labelled as pressure
/// paper_calibration  as calibration, at 20 C alone                                              20 + 14 taxels
/// paper              10, 20, 50 N at 16 different random taxels each, alone, 20 C               48
/// multitouch         1-4 contacts of 1-50 N (log-uniform): 40 % on one taxel, the others        1000 or as asked
///                    Gaussians of 0.7-2.5 pitches sigma centred anywhere, cut below 0.02 N;
///                    at most 50 N a taxel; 0-50 C uniform; each frame is independent
/// contacts           up to 5 round patches at once of 8-30 mm and 2-50 N, Hertz or flat, that   2000 or as asked
///                    come, rest or slide at human speed, and go; 100 frames/s; unloaded in the
///                    first and last 0.3 s; +- 5 C over the scene around 5-45 C by the seed
/// idle               unloaded; 0 to 50 C and back over the scene, as a cosine                   1000 or as asked
///
/// A press is 1 s of rest and 1 s of hold; uniform and multitouch change the load without rest, every 1 s; idle takes a
/// frame every 10 s. The patches of contacts stay 2.5 pitches apart from centre to centre and a pitch from rim to rim;
/// a taxel, a disc of taxel_area_m2 or of 0.7 pitches, carries the pressure on it. Each temperature of calibration,
/// paper_calibration and uniform starts with 600 s of rest. Thread-safe: frame() only reads, and a frame depends on the
/// seed and its index alone (contacts: also on the number of frames).
class Scene {
 public:
  /// Fails on an unknown name, options out of range, a frame count for a scene of fixed length (or one that is not 1
  /// ... 200,000), and where the array does not suit: uniform needs taxel_area_m2, paper at least 16 taxels.
  [[nodiscard]] static Result<Scene> create(std::string_view name, const ArrayDescription& array,
                                            const EnvironmentOptions& environment, std::uint64_t seed,
                                            std::optional<std::size_t> frames = {});

  [[nodiscard]] std::size_t frame_count() const noexcept { return frame_count_; }

  /// Frame `index` < frame_count(), reusing the buffers of `out`.
  void frame(std::size_t index, SceneFrame& out) const;

 private:
  enum class Kind { calibration, uniform, paper_calibration, paper, multitouch, contacts, idle };

  Scene(Kind kind, const ArrayDescription& array, const EnvironmentOptions& environment, std::uint64_t seed);
  [[nodiscard]] Status check_array() const;
  [[nodiscard]] std::size_t default_frame_count() const;
  void choose_paper_taxels();
  void press_each_taxel(std::size_t index, SceneFrame& out) const;
  void inflate_bladder(std::size_t index, SceneFrame& out) const;
  void press_as_in_paper(std::size_t index, SceneFrame& out) const;
  void touch(Random& random, SceneFrame& out) const;
  void move_contacts(std::size_t index, SceneFrame& out) const;
  void leave_alone(std::size_t index, SceneFrame& out) const;
  void add_contact(Random& random, std::vector<double>& force_n) const;
  void label_forces(std::size_t index, SceneFrame& out) const;

  Kind kind_;
  ArrayDescription array_;
  double supply_variation_;
  std::uint64_t seed_;
  std::size_t frame_count_ = 0;
  std::vector<std::size_t> paper_taxels_;  // [3 forces, 16]
  std::shared_ptr<const ContactScript> contacts_;
};

[[nodiscard]] const char* to_string(PatchShape shape) noexcept;

/// All names that Scene::create knows.
[[nodiscard]] std::vector<std::string> scene_names();

}  // namespace dermis::simulation
