// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/scene.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>
#include <string>

#include "dermis/touch/frames/nearest_name.hpp"
#include "learn/simulation/contact_script.hpp"
#include "learn/simulation/option_range.hpp"
#include "learn/simulation/touch_place.hpp"
#include "learn/simulation/touch_script.hpp"
#include "learn/simulation/weight_script.hpp"

namespace dermis::learn::simulation {
namespace {

constexpr std::size_t kMostFrames = 200'000;
// In the order of Scene::Kind.
constexpr std::array kScenes = {
    SceneKind{"calibration", ScenePace::step, false, false},
    SceneKind{"uniform", ScenePace::step, false, false},
    SceneKind{"paper_calibration", ScenePace::step, false, false},
    SceneKind{"paper", ScenePace::step, false, false},
    SceneKind{"multitouch", ScenePace::step, true, false},
    SceneKind{"contacts", ScenePace::own_rate, true, true},
    SceneKind{"idle", ScenePace::step, true, false},
    SceneKind{"touches", ScenePace::any_rate, true, false},
    SceneKind{"two_weights", ScenePace::any_rate, false, false},
    SceneKind{"field", ScenePace::any_rate, false, false},  // the last one: nobody can play it without its forces
};

constexpr double kDefaultSupplyV = 5.0;
constexpr double kRestS = 1.0;
constexpr double kHoldS = 1.0;
constexpr double kSoakS = 600.0;
constexpr double kIdlePeriodS = 10.0;

constexpr std::size_t kTemperatures = 5;
constexpr double kHottestCelsius = 50.0;
constexpr std::size_t kUnloadedFrames = 20;
constexpr std::size_t kLevels = 14;
constexpr double kLightestN = 0.5;
constexpr double kHeaviestN = 50.0;
constexpr double kLowestPa = 15e3;
constexpr double kHighestPa = 700e3;
constexpr std::size_t kFramesPerPressure = 5;

constexpr std::array kPaperForcesN = {10.0, 20.0, 50.0};
constexpr std::size_t kPaperPoints = 16;
constexpr double kPaperCelsius = 20.0;
constexpr std::uint64_t kPaperStream = std::numeric_limits<std::uint64_t>::max();  // No frame has this index.

constexpr std::uint64_t kClimateStream = std::numeric_limits<std::uint64_t>::max() - 4;
constexpr std::size_t kDefaultContactFrames = 2000;
constexpr double kColdestMeanCelsius = 5.0;
constexpr double kHottestMeanCelsius = 45.0;
constexpr double kSwingCelsius = 5.0;

constexpr std::size_t kDefaultFrames = 1000;
constexpr std::uint64_t kMaxContacts = 4;
constexpr double kWeakestContactN = 1.0;

constexpr double kLowestRateHz = 10.0;
constexpr double kHighestRateHz = 1000.0;
constexpr double kTouchRateHz = 100.0;
constexpr double kWeightRateHz = 50.0;
constexpr std::size_t kDefaultTouchFrames = 6000;
constexpr std::size_t kDefaultWeightTaxels = 4;
constexpr double kRoomCelsius = 22.0;
constexpr float kMostFieldN = 10'000.0F;  // of field

double step_in_equal_ratios(double first, double last, std::size_t level) {
  if (level + 1 == kLevels) return last;
  return first * std::pow(last / first, static_cast<double>(level) / static_cast<double>(kLevels - 1));
}

double calibration_celsius(std::size_t index) {
  return kHottestCelsius * static_cast<double>(index) / static_cast<double>(kTemperatures - 1);
}

std::string known_names() {
  std::string names;
  for (const SceneKind& scene : scene_kinds()) names += (names.empty() ? "" : ", ") + std::string(scene.name);
  return names;
}

std::string what_is_known(const std::string& name) {
  std::set<std::string> names;
  for (const SceneKind& scene : scene_kinds()) names.emplace(scene.name);
  const std::string nearest = nearest_name(name, names);
  return nearest.empty() ? "unknown; there are " + known_names() : "unknown; did you mean \"" + nearest + "\"?";
}

std::string scene_message(std::string_view name, const std::string& problem) {
  return "scene \"" + std::string(name) + "\": " + problem;
}

}  // namespace

const char* to_string(PatchShape shape) noexcept {
  return shape == PatchShape::hertz ? "hertz" : "flat";
}

std::span<const SceneKind> scene_kinds() noexcept {
  return std::span(kScenes).first(kScenes.size() - 1);
}

const SceneKind* find_scene(std::string_view name) noexcept {
  const auto* const found = std::ranges::find(kScenes, name, &SceneKind::name);
  return found == kScenes.end() ? nullptr : found;
}

Status EnvironmentOptions::validate() const {
  return check_ranges({{"environment.supply_variation", supply_variation, 0.0, 0.5},
                       {"environment.temperature_noise_celsius", temperature_noise_celsius, 0.0, 20.0},
                       {"environment.gradient_celsius", gradient_celsius, 0.0, 50.0},
                       {"environment.supply_noise", supply_noise, 0.0, 0.1},
                       {"environment.adc_noise_lsb", adc_noise_lsb, 0.0, 1000.0}});
}

Scene::Scene(Kind kind, const ArrayDescription& array, const EnvironmentOptions& environment, std::uint64_t seed)
    : kind_(kind), array_(array), supply_variation_(environment.supply_variation), seed_(seed) {}

Result<Scene> Scene::create(std::string_view name, const ArrayDescription& array, const EnvironmentOptions& environment,
                            std::uint64_t seed, std::optional<std::size_t> frames, const SceneOptions& options) {
  const SceneKind* const found = find_scene(name);
  if (found == nullptr) return bad_input(scene_message(name, what_is_known(std::string(name))));
  if (Status valid = array.validate(); !valid) return valid.error();
  if (Status valid = environment.validate(); !valid) return valid.error();
  Scene scene(static_cast<Kind>(found - kScenes.data()), array, environment, seed);
  if (Status suits = scene.check_array(); !suits) return suits.error();
  if (Status set = scene.set_options(options); !set) return bad_input(scene_message(name, set.error().message));
  if (Status set = scene.set_length(frames); !set) return bad_input(scene_message(name, set.error().message));
  scene.write_script();
  return scene;
}

Status Scene::set_options(const SceneOptions& options) {
  const bool takes_rate = kScenes[static_cast<std::size_t>(kind_)].pace == ScenePace::any_rate;
  if (options.rate_hz && !takes_rate) return bad_input("has a rate of its own");
  if (options.taxels && kind_ != Kind::two_weights) return bad_input("has taxels of its own");
  rate_hz_ = options.rate_hz.value_or(kind_ == Kind::two_weights ? kWeightRateHz : kTouchRateHz);
  if (!(rate_hz_ >= kLowestRateHz && rate_hz_ <= kHighestRateHz)) return bad_input("needs 10 to 1000 frames a second");
  const std::size_t most = array_.taxel_count() - array_.absent.size();
  weighed_taxels_ = options.taxels.value_or(std::min(kDefaultWeightTaxels, most));
  if (kind_ == Kind::two_weights && (weighed_taxels_ < 1 || weighed_taxels_ > most)) {
    return bad_input("needs 1 to " + std::to_string(most) + " taxels");
  }
  if (kind_ == Kind::field) return set_field(options.field_n);
  return Done{};
}

Status Scene::set_field(const std::vector<float>& field_n) {
  const std::size_t taxels = array_.taxel_count();
  if (field_n.empty() || field_n.size() % taxels != 0) {
    return bad_input("needs the forces of " + std::to_string(taxels) + " taxels a frame");
  }
  const auto is_none = [](float force_n) { return !(force_n >= 0.0F && force_n <= kMostFieldN); };
  const auto none = std::ranges::find_if(field_n, is_none);
  if (none != field_n.end()) {
    const auto place = static_cast<std::size_t>(none - field_n.begin());
    return bad_input("frame " + std::to_string(place / taxels) + ", taxel " + std::to_string(place % taxels) + ": " +
                     std::to_string(*none) + " is no force of 0 to 10000 N");
  }
  field_n_ = std::make_shared<const std::vector<float>>(field_n);
  return Done{};
}

Status Scene::set_length(std::optional<std::size_t> frames) {
  if (frames && !kScenes[static_cast<std::size_t>(kind_)].is_of_any_length)
    return bad_input("has a fixed number of frames");
  if (frames && (*frames == 0 || *frames > kMostFrames)) {
    return bad_input("needs 1 to " + std::to_string(kMostFrames) + " frames");
  }
  frame_count_ = frames.value_or(default_frame_count());
  const bool may_be_long = kind_ != Kind::two_weights && kind_ != Kind::field;
  if (!may_be_long && frame_count_ > kMostFrames) {
    const char* const advice = kind_ == Kind::field ? "" : "; ask for fewer taxels or fewer frames a second";
    return bad_input("has " + std::to_string(frame_count_) + " frames, more than " + std::to_string(kMostFrames) +
                     advice);
  }
  return Done{};
}

void Scene::write_script() {
  if (kind_ == Kind::paper) choose_paper_taxels();
  if (kind_ == Kind::contacts) contacts_ = std::make_shared<ContactScript>(array_, frame_count_, seed_);
  if (kind_ == Kind::touches) {
    touches_ = std::make_shared<TouchScript>(array_, static_cast<double>(frame_count_) / rate_hz_, seed_);
  }
  if (kind_ == Kind::two_weights) weights_ = std::make_shared<WeightScript>(array_, weighed_taxels_, seed_);
}

Status Scene::check_array() const {
  if (kind_ == Kind::uniform && !array_.taxel_area_m2) {
    return bad_input("array.taxel_area_mm2: is missing; the scene \"uniform\" needs it to turn pressure into force");
  }
  if (kind_ == Kind::paper && array_.taxel_count() < kPaperPoints) {
    return bad_input("scene \"paper\": needs an array of at least " + std::to_string(kPaperPoints) + " taxels");
  }
  return Done{};
}

std::size_t Scene::default_frame_count() const {
  switch (kind_) {
    case Kind::calibration: return kTemperatures * (kUnloadedFrames + kLevels * array_.taxel_count());
    case Kind::uniform: return kTemperatures * (kUnloadedFrames + kLevels * kFramesPerPressure);
    case Kind::paper_calibration: return kUnloadedFrames + kLevels * array_.taxel_count();
    case Kind::paper: return kPaperForcesN.size() * kPaperPoints;
    case Kind::contacts: return kDefaultContactFrames;
    case Kind::touches: return kDefaultTouchFrames;
    case Kind::two_weights:
      return static_cast<std::size_t>(std::llround(WeightScript::seconds(weighed_taxels_) * rate_hz_));
    case Kind::field: return field_n_->size() / array_.taxel_count();
    case Kind::multitouch:
    case Kind::idle: break;
  }
  return kDefaultFrames;
}

void Scene::choose_paper_taxels() {
  Random random = Random::stream(seed_, kPaperStream);
  std::vector<std::size_t> deck(array_.taxel_count());
  std::iota(deck.begin(), deck.end(), std::size_t{0});
  for (std::size_t force = 0; force < kPaperForcesN.size(); ++force) {
    for (std::size_t point = 0; point < kPaperPoints; ++point) {
      std::swap(deck[point], deck[point + random.below(deck.size() - point)]);
      paper_taxels_.push_back(deck[point]);
    }
  }
}

void Scene::frame(std::size_t index, SceneFrame& out) const {
  assert(index < frame_count_);
  Random random = Random::stream(seed_, index);
  out.force_n.assign(array_.taxel_count(), 0.0);
  out.loads.clear();
  out.contacts.clear();
  out.rest_s = kRestS;
  out.hold_s = kHoldS;
  const double nominal_v = array_.readout.supply_v.value_or(kDefaultSupplyV);
  out.supply_v = nominal_v * (1.0 + supply_variation_ * random.uniform(-1.0, 1.0));
  bool is_known = true;
  switch (kind_) {
    case Kind::calibration:
    case Kind::paper_calibration: press_each_taxel(index, out); break;
    case Kind::uniform: inflate_bladder(index, out); break;
    case Kind::paper: press_as_in_paper(index, out); break;
    case Kind::multitouch: touch(random, out); break;
    case Kind::contacts: move_contacts(index, out); break;
    case Kind::idle: leave_alone(index, out); break;
    case Kind::touches: press_and_let_go(index, out); break;
    case Kind::two_weights: is_known = lay_weights(index, out); break;
    case Kind::field: press_as_given(index, out); break;
  }
  if (is_known && out.loads.empty()) label_forces(index, out);
}

void Scene::press_each_taxel(std::size_t index, SceneFrame& out) const {
  const std::size_t taxels = array_.taxel_count();
  const std::size_t per_temperature = kUnloadedFrames + kLevels * taxels;
  const std::size_t step = index % per_temperature;
  out.temperature_celsius =
      kind_ == Kind::paper_calibration ? kPaperCelsius : calibration_celsius(index / per_temperature);
  if (step == 0) out.rest_s = kSoakS;
  if (step < kUnloadedFrames) return;
  const std::size_t press = step - kUnloadedFrames;
  out.force_n[press % taxels] = step_in_equal_ratios(kLightestN, kHeaviestN, press / taxels);
}

void Scene::inflate_bladder(std::size_t index, SceneFrame& out) const {
  constexpr std::size_t kPerTemperature = kUnloadedFrames + kLevels * kFramesPerPressure;
  const std::size_t step = index % kPerTemperature;
  out.temperature_celsius = calibration_celsius(index / kPerTemperature);
  out.rest_s = step == 0 ? kSoakS : 0.0;
  if (step < kUnloadedFrames) return;
  const double pascal = step_in_equal_ratios(kLowestPa, kHighestPa, (step - kUnloadedFrames) / kFramesPerPressure);
  std::fill(out.force_n.begin(), out.force_n.end(), pascal * *array_.taxel_area_m2);
  out.loads.push_back({index, LoadKind::pressure, all_taxels(array_), pascal});
}

void Scene::press_as_in_paper(std::size_t index, SceneFrame& out) const {
  out.temperature_celsius = kPaperCelsius;
  out.force_n[paper_taxels_[index]] = kPaperForcesN[index / kPaperPoints];
}

void Scene::touch(Random& random, SceneFrame& out) const {
  out.rest_s = 0.0;
  out.temperature_celsius = random.uniform(0.0, kHottestCelsius);
  const std::uint64_t contacts = 1 + random.below(kMaxContacts);
  for (std::uint64_t contact = 0; contact < contacts; ++contact) add_contact(random, out.force_n);
  for (double& force_n : out.force_n) force_n = std::min(force_n, kHeaviestN);
}

void Scene::move_contacts(std::size_t index, SceneFrame& out) const {
  out.rest_s = 0.0;
  out.hold_s = ContactScript::kFrameS;
  Random climate = Random::stream(seed_, kClimateStream);
  const double mean_celsius = climate.uniform(kColdestMeanCelsius, kHottestMeanCelsius);
  const double phase = climate.uniform() + static_cast<double>(index) / static_cast<double>(frame_count_);
  out.temperature_celsius = mean_celsius + kSwingCelsius * std::sin(2.0 * std::numbers::pi * phase);
  contacts_->frame(index, out.contacts, out.force_n);
}

void Scene::leave_alone(std::size_t index, SceneFrame& out) const {
  out.rest_s = 0.0;
  out.hold_s = kIdlePeriodS;
  const double phase = static_cast<double>(index) / static_cast<double>(frame_count_);
  out.temperature_celsius = kHottestCelsius / 2.0 * (1.0 - std::cos(2.0 * std::numbers::pi * phase));
}

/// A frame later of a scene that is continuous in time; gives that time [s].
double Scene::go_on(std::size_t index, SceneFrame& out) const {
  out.rest_s = 0.0;
  out.hold_s = 1.0 / rate_hz_;
  out.temperature_celsius = kRoomCelsius;
  return static_cast<double>(index) / rate_hz_;
}

void Scene::press_and_let_go(std::size_t index, SceneFrame& out) const {
  touches_->add_forces(go_on(index, out), out.force_n);
  for (const std::size_t taxel : array_.absent) out.force_n[taxel] = 0.0;
}

void Scene::press_as_given(std::size_t index, SceneFrame& out) const {
  go_on(index, out);
  const auto taxels = static_cast<std::ptrdiff_t>(array_.taxel_count());
  std::copy_n(field_n_->begin() + static_cast<std::ptrdiff_t>(index) * taxels, taxels, out.force_n.begin());
  for (const std::size_t taxel : array_.absent) out.force_n[taxel] = 0.0;
}

/// False while a weight is put on or taken off.
bool Scene::lay_weights(std::size_t index, SceneFrame& out) const {
  const WeightScript::Moment now = weights_->at(go_on(index, out));
  out.force_n[now.taxel] = now.force_n;
  return now.is_known;
}

void Scene::add_contact(Random& random, std::vector<double>& force_n) const {
  const double peak_n = random.log_uniform(kWeakestContactN, kHeaviestN);
  add_touch(array_, draw_place(array_, random), peak_n, force_n);
}

void Scene::label_forces(std::size_t index, SceneFrame& out) const {
  for (std::size_t row = 0; row < array_.rows; ++row) {
    for (std::size_t col = 0; col < array_.cols; ++col) {
      const double force_n = out.force_n[array_.index(row, col)];
      if (force_n > 0.0) out.loads.push_back({index, LoadKind::force, {row, col, row, col}, force_n});
    }
  }
  if (out.loads.empty()) out.loads.push_back({index, LoadKind::force, all_taxels(array_), 0.0});
}

}  // namespace dermis::learn::simulation
