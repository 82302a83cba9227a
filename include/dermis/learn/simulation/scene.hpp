// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/loads.hpp"
#include "dermis/touch/frames/random.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::simulation {

/// The surroundings of the array and the instruments that watch them. Defaults: the reference array of the project.
struct EnvironmentOptions {
  double supply_variation = 0.10;          ///< The supply is nominal times 1 +- this, uniform, 0 ... 0.5.
  double temperature_noise_celsius = 0.3;  ///< Sd of the reported temperature [C], 0 ... 20. A digital sensor.
  /// Opposite edges of the sheet differ by so much [C], 0 ... 50. The warm edge goes round once in ten minutes.
  double gradient_celsius = 0.0;
  double supply_noise = 0.001;  ///< Relative sd of the reported supply, 0 ... 0.1.
  double adc_noise_lsb = 1.0;   ///< Sd of the ADC before rounding [counts], 0 ... 1000.

  /// Names the first field that is out of its range, as "environment.supply_noise: ...".
  [[nodiscard]] Status validate() const;
};

/// How the pressure p of a round patch of radius a falls off with the distance r from its centre.
enum class PatchShape {
  hertz,  ///< p = p0 sqrt(1 - r2/a2): a ball on an elastic sheet (Hertz 1882).
  flat,   ///< p = p0: a stamp on a soft one.
};

/// A patch that touches the array in one frame, in the plane of core/contacts.hpp. The origin is the centre of taxel
/// r0c0, x runs along the columns and y along the rows.
struct AppliedContact {
  std::uint32_t id = 0;  ///< From 1 on, in order of onset; the same from onset to release.
  PatchShape shape = PatchShape::hertz;
  double x_m = 0.0;            ///< Centre [m].
  double y_m = 0.0;            ///< Centre [m].
  double diameter_m = 0.0;     ///< 2 a [m].
  double force_n = 0.0;        ///< Force of the whole patch [N], > 0.
  double taxel_force_n = 0.0;  ///< Its part on taxels [N]; the rest presses between and beside them.

  bool operator==(const AppliedContact&) const = default;
};

/// The loads on the array until one frame is taken, and what is known about them. The frame is taken at the end.
struct SceneFrame {
  double rest_s = 0.0;               ///< Time unloaded before [s]; 0: the load changes at once.
  double hold_s = 0.0;               ///< Time under force_n after that [s].
  double temperature_celsius = 0.0;  ///< True mean temperature of the array [C].
  double supply_v = 0.0;             ///< True supply [V].
  std::vector<double> force_n;       ///< True force applied to each taxel [N], [rows, cols].
  /// The labels of loads.csv; at least one, except in the frames of two_weights in which a hand moves.
  std::vector<Load> loads;
  std::vector<AppliedContact> contacts;  ///< By id; empty where the scene has none (SceneKind::has_contacts).
};

/// The options that some scenes leave open.
struct SceneOptions {
  std::optional<double> rate_hz{};      ///< touches, field (100), two_weights (50): frames a second, 10 ... 1000.
  std::optional<std::size_t> taxels{};  ///< two_weights (4, or all of fewer): how many are pressed, 1 ... all.
  std::vector<float> field_n{};         ///< field: newtons, 0 ... 10,000, [frames, rows, cols].
};

/// How the frames of a scene follow each other.
enum class ScenePace {
  step,      ///< Each load rests for the time that it takes; there is no rate.
  own_rate,  ///< Continuous in time, 100 frames a second.
  any_rate,  ///< Continuous in time at SceneOptions::rate_hz.
};

/// The kind of a scene, apart from its loads.
struct SceneKind {
  const char* name;
  ScenePace pace;
  bool is_of_any_length;  ///< Takes a number of frames.
  bool has_contacts;      ///< Fills SceneFrame::contacts.
};

/// All scenes that need no forces given: all but "field".
[[nodiscard]] std::span<const SceneKind> scene_kinds() noexcept;
/// Null where there is none of that name.
[[nodiscard]] const SceneKind* find_scene(std::string_view name) noexcept;

class ContactScript;
class TouchScript;
class WeightScript;

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
/// touches            up to 4 touches at once, each on one taxel (40 %) or a Gaussian as in      6000 or as asked
///                    multitouch: up to 1-50 N (log-uniform) in 0.03-1 s, held for 0.2-5 s;
///                    then up to three times up or down (60 %, to 20-80 %) and held again;
///                    gone in 0.03-0.5 s; back at the same place after 0.05-0.5 s (35 %) or
///                    elsewhere after 0.5-9 s; at most 50 N a taxel; 22 C; unloaded for 2 s
/// two_weights        10 s unloaded; then 5, 5 + 10, 5 N for 15 s each and 10 s off on 4 taxels  (10 + 110 taxels)
///                    or as asked, one after another, two rounds; 0.2 s, which have no label,    x rate
///                    for each change; 22 C
/// field              the forces of SceneOptions::field_n, as another simulator gives them; 22 C  as many as given
///
/// A press is 1 s of rest and 1 s of hold. uniform and multitouch change the load without rest, every 1 s. idle takes a
/// frame every 10 s. The patches of contacts stay 2.5 pitches apart from centre to centre and a pitch from rim to rim.
/// A taxel is a disc of taxel_area_m2 or of 0.7 pitches, and carries the pressure on it. Each temperature of
/// calibration, paper_calibration and uniform starts with 600 s of rest. touches, two_weights and field are continuous
/// in time at their rate: all their frames are history of one piece. Thread-safe, because frame() only reads. A frame
/// depends only on the seed and its index (contacts: also on the number of frames; touches and two_weights: on the
/// options).
class Scene {
 public:
  /// Fails on an unknown name, on options out of range or of other scenes, and on a frame count for a scene of fixed
  /// length. The frame count must be 1 ... 200,000. uniform needs taxel_area_m2, paper at least 16 taxels.
  [[nodiscard]] static Result<Scene> create(std::string_view name, const ArrayDescription& array,
                                            const EnvironmentOptions& environment, std::uint64_t seed,
                                            std::optional<std::size_t> frames = {}, const SceneOptions& options = {});

  [[nodiscard]] std::size_t frame_count() const noexcept { return frame_count_; }

  /// Frame `index` < frame_count(), reusing the buffers of `out`.
  void frame(std::size_t index, SceneFrame& out) const;

 private:
  enum class Kind {
    calibration,
    uniform,
    paper_calibration,
    paper,
    multitouch,
    contacts,
    idle,
    touches,
    two_weights,
    field
  };

  Scene(Kind kind, const ArrayDescription& array, const EnvironmentOptions& environment, std::uint64_t seed);
  [[nodiscard]] Status check_array() const;
  [[nodiscard]] Status set_options(const SceneOptions& options);
  [[nodiscard]] Status set_field(const std::vector<float>& field_n);
  [[nodiscard]] Status set_length(std::optional<std::size_t> frames);
  void write_script();
  [[nodiscard]] std::size_t default_frame_count() const;
  void choose_paper_taxels();
  void press_each_taxel(std::size_t index, SceneFrame& out) const;
  void inflate_bladder(std::size_t index, SceneFrame& out) const;
  void press_as_in_paper(std::size_t index, SceneFrame& out) const;
  void touch(Random& random, SceneFrame& out) const;
  void move_contacts(std::size_t index, SceneFrame& out) const;
  void leave_alone(std::size_t index, SceneFrame& out) const;
  double go_on(std::size_t index, SceneFrame& out) const;
  void press_and_let_go(std::size_t index, SceneFrame& out) const;
  void press_as_given(std::size_t index, SceneFrame& out) const;
  [[nodiscard]] bool lay_weights(std::size_t index, SceneFrame& out) const;
  void add_contact(Random& random, std::vector<double>& force_n) const;
  void label_forces(std::size_t index, SceneFrame& out) const;

  Kind kind_;  // Place in scene_kinds().
  ArrayDescription array_;
  double supply_variation_;
  std::uint64_t seed_;
  std::size_t frame_count_ = 0;
  double rate_hz_ = 0.0;                   // touches, two_weights, field
  std::size_t weighed_taxels_ = 0;         // two_weights
  std::vector<std::size_t> paper_taxels_;  // [3 forces, 16]
  std::shared_ptr<const ContactScript> contacts_;
  std::shared_ptr<const TouchScript> touches_;
  std::shared_ptr<const WeightScript> weights_;
  std::shared_ptr<const std::vector<float>> field_n_;
};

[[nodiscard]] const char* to_string(PatchShape shape) noexcept;

}  // namespace dermis::learn::simulation
