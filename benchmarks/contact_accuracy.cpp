// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// How well contacts are found on the reference array: patches on round taxels, through the simulator with all that
// disturbs it, a model of scene `calibration` seed 1, the pipeline and a ContactTracker. The truth is integrated here.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "calibrated_model.hpp"
#include "dermis/touch/contacts/contact_tracker.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "support/pressure_patches.hpp"
#include "support/reference_array.hpp"

namespace dermis {
namespace {

using support::PressurePatch;
using support::Profile;

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto place = static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(place), values.end());
  return values[place];
}

touch::pipeline::Model calibrate(const ArrayDescription& array) {
  const auto simulator = need(learn::simulation::Simulator::create(array, {}, "calibration", 1));
  return calibrated_model(array, *simulator);
}

/// The simulated array under loads of our own.
class PressedArray {
 public:
  PressedArray(const ArrayDescription& description, const touch::pipeline::Model& model)
      : array(description),
        rubber_(need(learn::simulation::ConductiveRubber::create({}, array.rows, array.cols, 77))),
        circuit_(need(learn::simulation::ReadoutCircuit::create(array))),
        adc_(array.readout, 1.0),
        pipeline_(need(touch::pipeline::Pipeline::create(model))),
        siemens_(array.taxel_count()),
        ratio_(array.taxel_count()) {
    raw_.counts.resize(array.taxel_count());
  }

  const ForceFrame& press(const std::vector<double>& newtons) {
    const double celsius = random.uniform(0.0, 50.0);
    const double supply_v = 5.0 * random.uniform(0.9, 1.1);
    rubber_.press(std::vector<double>(newtons.size()), 1.0);
    rubber_.press(newtons, 1.0);
    rubber_.read(celsius, siemens_);
    circuit_.ratios(siemens_, ratio_);
    adc_.convert(ratio_, supply_v, random, raw_.counts);
    raw_.time += std::chrono::seconds(2);
    raw_.temperature_celsius = celsius + 0.3 * random.normal();
    raw_.supply_v = supply_v * (1.0 + 0.001 * random.normal());
    pipeline_.process(raw_, force);
    return force;
  }

  ArrayDescription array;
  Random random{5};
  ForceFrame force;

 private:
  learn::simulation::ConductiveRubber rubber_;
  learn::simulation::ReadoutCircuit circuit_;
  learn::simulation::Adc adc_;
  touch::pipeline::Pipeline pipeline_;
  std::vector<double> siemens_;
  std::vector<double> ratio_;
  RawFrame raw_;
};

/// The best that can be known of the place of one round patch whose profile and diameter are known: the mean of all
/// places on a fine grid, each with its likelihood, whatever the force.
class TrueShapeFit {
 public:
  TrueShapeFit(double diameter_m, Profile profile) {
    for (double away = 0.0; away < 0.5 * diameter_m + 4e-3; away += kStep) {
      share_.push_back(support::force_on_disc(support::round_patch(0.0, 0.0, diameter_m, 1.0, profile), away, 0.0));
    }
    share_.push_back(0.0);
  }

  [[nodiscard]] PlaneVector place(const ArrayDescription& array, const ForceFrame& force, PlaneVector about) const {
    double least = 1e300;
    double sum = 0.0;
    PlaneVector first;
    for (double x = about.x - kReach; x <= about.x + kReach; x += kGrid) {
      for (double y = about.y - kReach; y <= about.y + kReach; y += kGrid) {
        const double chi = chi_squared(array, force, x, y);
        if (chi < least) {
          const double scale = std::exp(0.5 * (chi - least));
          sum *= scale;
          first = {first.x * scale, first.y * scale};
          least = chi;
        }
        const double weight = std::exp(0.5 * (least - chi));
        sum += weight;
        first.x += weight * x;
        first.y += weight * y;
      }
    }
    return {first.x / sum, first.y / sum};
  }

 private:
  static constexpr double kStep = 5e-5;
  static constexpr double kReach = 5e-3;
  static constexpr double kGrid = 2e-4;

  [[nodiscard]] double chi_squared(const ArrayDescription& array, const ForceFrame& force, double x, double y) const {
    const double reach = kStep * static_cast<double>(share_.size()) + 0.01;
    double square = 1e-12;
    double product = 0.0;
    double all = 0.0;
    for (std::size_t row = 0; row < array.rows; ++row) {
      const double dy = static_cast<double>(row) * array.row_pitch_m - y;
      if (std::abs(dy) > reach) continue;
      for (std::size_t col = 0; col < array.cols; ++col) {
        const double dx = static_cast<double>(col) * array.col_pitch_m - x;
        if (std::abs(dx) > reach) continue;
        const auto place = static_cast<std::size_t>(std::lround(std::hypot(dx, dy) / kStep));
        const double sigma = force.sigma_newtons[array.index(row, col)];
        const double share = place < share_.size() ? share_[place] / sigma : 0.0;
        const double measured = force.newtons[array.index(row, col)] / sigma;
        square += share * share;
        product += share * measured;
        all += measured * measured;
      }
    }
    const double newtons = std::max(0.0, product / square);
    return all - 2.0 * newtons * product + newtons * newtons * square;
  }

  std::vector<double> share_;
};

struct Errors {
  std::vector<double> position_mm;
  std::vector<double> fit_mm;
  std::vector<double> mass_mm;
  std::vector<double> sigmas;
  std::vector<double> force;
  std::size_t frames = 0;
  std::size_t unseen = 0;
  std::size_t miscounted = 0;
};

double sum_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum;
}

PlaneVector centre_of_mass(const ArrayDescription& array, const ForceFrame& force) {
  double sum = 0.0;
  PlaneVector first;
  for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
    if (force.newtons[taxel] < 4.0F * force.sigma_newtons[taxel]) continue;
    sum += force.newtons[taxel];
    const std::size_t row = taxel / array.cols;
    first.x += force.newtons[taxel] * static_cast<double>(taxel % array.cols) * array.col_pitch_m;
    first.y += force.newtons[taxel] * static_cast<double>(row) * array.row_pitch_m;
  }
  return {first.x / sum, first.y / sum};
}

PressurePatch anywhere(PressedArray& pressed, double diameter_m, Profile profile) {
  const double last = 0.15;
  return support::round_patch(pressed.random.uniform(0.01, last - 0.01), pressed.random.uniform(0.01, last - 0.01),
                              diameter_m, pressed.random.log_uniform(2.0, 50.0), profile);
}

/// One contact a frame, of one diameter.
Errors single_contacts(PressedArray& pressed, double diameter_m, Profile profile, std::size_t frames) {
  Errors errors;
  const TrueShapeFit fit(diameter_m, profile);
  ContactReport report;
  for (std::size_t k = 0; k < frames; ++k) {
    const PressurePatch patch = anywhere(pressed, diameter_m, profile);
    const std::vector<double> truth = support::taxel_forces(pressed.array, {patch});
    const double newtons = sum_of(truth);
    const ForceFrame& force = pressed.press(truth);
    touch::contacts::ContactTracker tracker(pressed.array);
    tracker.process(force, report);
    if (newtons < 0.3) {
      ++errors.unseen;
      continue;
    }
    ++errors.frames;
    if (report.contacts.size() != 1) {
      ++errors.miscounted;
      continue;
    }
    const Contact& contact = report.contacts[0];
    const double dx = contact.position.x - patch.x;
    const double dy = contact.position.y - patch.y;
    errors.position_mm.push_back(1e3 * std::hypot(dx, dy));
    errors.sigmas.push_back(std::abs(dx) / contact.sigma_position_m.x);
    errors.sigmas.push_back(std::abs(dy) / contact.sigma_position_m.y);
    errors.force.push_back(std::abs(contact.force_n / newtons - 1.0));
    const PlaneVector mass = centre_of_mass(pressed.array, force);
    errors.mass_mm.push_back(1e3 * std::hypot(mass.x - patch.x, mass.y - patch.y));
    const PlaneVector best = fit.place(pressed.array, force, {patch.x, patch.y});
    errors.fit_mm.push_back(1e3 * std::hypot(best.x - patch.x, best.y - patch.y));
  }
  return errors;
}

double share_below(const std::vector<double>& values, double bound) {
  const auto below = std::count_if(values.begin(), values.end(), [&](double value) { return value <= bound; });
  return static_cast<double>(below) / static_cast<double>(values.size());
}

void print_single_contacts(PressedArray& pressed) {
  fmt::print("one contact, 2-50 N on the patch, anywhere; position error [mm], force error [%]\n");
  fmt::print("{:>9}{:>9}{:>8}{:>8}{:>12}{:>14}{:>14}{:>8}{:>8}{:>8}{:>8}{:>9}\n", "shape", "diameter", "unseen",
             "count!", "median p95", "mass", "true shape", "1 s", "2 s", "f med", "f p95", "frames");
  for (const Profile profile : {Profile::hertz, Profile::flat}) {
    for (const double diameter : {8.0, 12.0, 15.0, 20.0, 25.0, 30.0}) {
      const Errors e = single_contacts(pressed, 1e-3 * diameter, profile, 300);
      fmt::print(
          "{:>9}{:>9}{:>8}{:>8}{:>7.2f}{:>6.2f}{:>8.2f}{:>6.2f}{:>8.2f}{:>6.2f}{:>8.2f}{:>8.2f}{:>8.2f}{:>8.2f}{:>9}\n",
          profile == Profile::hertz ? "hertz" : "flat", diameter, e.unseen, e.miscounted,
          percentile(e.position_mm, 0.5), percentile(e.position_mm, 0.95), percentile(e.mass_mm, 0.5),
          percentile(e.mass_mm, 0.95), percentile(e.fit_mm, 0.5), percentile(e.fit_mm, 0.95),
          share_below(e.sigmas, 1.0), share_below(e.sigmas, 2.0), 100.0 * percentile(e.force, 0.5),
          100.0 * percentile(e.force, 0.95), e.frames);
    }
  }
}

/// Centres at least 2.5 pitches and both radii apart.
std::vector<PressurePatch> several(PressedArray& pressed, std::size_t count) {
  std::vector<PressurePatch> patches;
  while (patches.size() < count) {
    const PressurePatch next = anywhere(pressed, 1e-3 * pressed.random.uniform(8.0, 30.0), Profile::hertz);
    const bool is_apart = std::all_of(patches.begin(), patches.end(), [&](const PressurePatch& other) {
      return std::hypot(next.x - other.x, next.y - other.y) >= std::max(0.025, next.half_axis_m + other.half_axis_m);
    });
    if (is_apart) patches.push_back(next);
  }
  return patches;
}

void print_several_contacts(PressedArray& pressed) {
  fmt::print("\nseveral contacts of 8-30 mm, Hertz, 2.5 pitches apart and not overlapping, each of 0.3 N or more\n");
  fmt::print("{:>9}{:>12}{:>12}{:>10}{:>10}{:>12}{:>12}\n", "contacts", "count right", "frames", "f med", "f p95",
             "median mm", "p95 mm");
  ContactReport report;
  for (std::size_t count = 1; count <= 5; ++count) {
    std::size_t right = 0;
    std::size_t frames = 0;
    std::vector<double> force_errors;
    std::vector<double> place_errors;
    for (std::size_t k = 0; k < 1500; ++k) {
      const std::vector<PressurePatch> patches = several(pressed, count);
      std::vector<double> newtons;
      std::vector<double> all(pressed.array.taxel_count());
      for (const PressurePatch& patch : patches) {
        const std::vector<double> one = support::taxel_forces(pressed.array, {patch});
        newtons.push_back(sum_of(one));
        for (std::size_t taxel = 0; taxel < all.size(); ++taxel) all[taxel] += one[taxel];
      }
      if (*std::min_element(newtons.begin(), newtons.end()) < 0.3) continue;
      ++frames;
      touch::contacts::ContactTracker tracker(pressed.array);
      tracker.process(pressed.press(all), report);
      if (report.contacts.size() != count) continue;
      ++right;
      for (std::size_t n = 0; n < count; ++n) {
        const Contact& nearest =
            *std::min_element(report.contacts.begin(), report.contacts.end(), [&](const Contact& a, const Contact& b) {
              return std::hypot(a.position.x - patches[n].x, a.position.y - patches[n].y) <
                     std::hypot(b.position.x - patches[n].x, b.position.y - patches[n].y);
            });
        force_errors.push_back(std::abs(nearest.force_n / newtons[n] - 1.0));
        place_errors.push_back(1e3 * std::hypot(nearest.position.x - patches[n].x, nearest.position.y - patches[n].y));
      }
    }
    fmt::print("{:>9}{:>11.1f}%{:>12}{:>9.2f}%{:>9.2f}%{:>12.2f}{:>12.2f}\n", count,
               100.0 * static_cast<double>(right) / static_cast<double>(frames), frames,
               100.0 * percentile(force_errors, 0.5), 100.0 * percentile(force_errors, 0.95),
               percentile(place_errors, 0.5), percentile(place_errors, 0.95));
  }
}

void print_elongated_contacts(PressedArray& pressed) {
  fmt::print("\none elliptical contact at any angle, 5-100 N\n");
  fmt::print("{:>9}{:>12}{:>12}{:>12}{:>12}{:>12}{:>12}\n", "shape", "axes mm", "found as 1", "median mm", "p95 mm",
             "angle med", "angle p95");
  ContactReport report;
  for (const Profile profile : {Profile::hertz, Profile::flat}) {
    for (const auto& [axis, other_axis] : {std::pair{24.0, 16.0}, {36.0, 20.0}, {50.0, 16.0}, {60.0, 12.0}}) {
      std::vector<double> place_errors;
      std::vector<double> angle_errors;
      constexpr std::size_t kFrames = 200;
      for (std::size_t k = 0; k < kFrames; ++k) {
        Random& random = pressed.random;
        const PressurePatch patch{
            random.uniform(0.03, 0.12),  random.uniform(0.03, 0.12),     0.5e-3 * axis, 0.5e-3 * other_axis,
            random.uniform(-1.57, 1.57), random.log_uniform(5.0, 100.0), profile};
        touch::contacts::ContactTracker tracker(pressed.array);
        tracker.process(pressed.press(support::taxel_forces(pressed.array, {patch})), report);
        if (report.contacts.size() != 1) continue;
        const Contact& contact = report.contacts[0];
        place_errors.push_back(1e3 * std::hypot(contact.position.x - patch.x, contact.position.y - patch.y));
        const double off = std::remainder(contact.angle_rad - patch.angle_rad, std::numbers::pi);
        angle_errors.push_back(std::abs(off) * 180.0 / std::numbers::pi);
      }
      fmt::print("{:>9}{:>9.0f}x{:.0f}{:>11.1f}%{:>12.2f}{:>12.2f}{:>12.1f}{:>12.1f}\n",
                 profile == Profile::hertz ? "hertz" : "flat", axis, other_axis,
                 100.0 * static_cast<double>(place_errors.size()) / kFrames, percentile(place_errors, 0.5),
                 percentile(place_errors, 0.95), percentile(angle_errors, 0.5), percentile(angle_errors, 0.95));
    }
  }
}

/// What a tracker says about the true contacts of a scene of moving contacts.
class SceneJudge {
 public:
  void judge(const std::vector<learn::simulation::AppliedContact>& truth, const ContactReport& report) {
    std::map<std::uint32_t, std::uint32_t> now;
    for (const learn::simulation::AppliedContact& patch : truth) {
      if (patch.taxel_force_n < 0.3) continue;
      ++held;
      const Contact* const contact = nearest(patch, report);
      if (contact == nullptr) {
        ++missed;
        continue;
      }
      now[patch.id] = contact->id;
      const auto before = ids_.find(patch.id);
      if (before != ids_.end() && before->second != contact->id) ++changes;
      add_error(patch, *contact);
    }
    ids_ = std::move(now);
  }

  std::size_t held = 0;
  std::size_t missed = 0;
  std::size_t changes = 0;
  std::vector<double> position_mm;  // of contacts of 15 mm and more
  std::vector<double> sigmas;       // of all

 private:
  static constexpr double kReach = 0.015;

  static const Contact* nearest(const learn::simulation::AppliedContact& patch, const ContactReport& report) {
    const Contact* found = nullptr;
    double least = kReach;
    for (const Contact& contact : report.contacts) {
      const double distance = std::hypot(contact.position.x - patch.x_m, contact.position.y - patch.y_m);
      if (contact.phase == ContactPhase::release || distance >= least) continue;
      least = distance;
      found = &contact;
    }
    return found;
  }

  void add_error(const learn::simulation::AppliedContact& patch, const Contact& contact) {
    const double dx = contact.position.x - patch.x_m;
    const double dy = contact.position.y - patch.y_m;
    if (patch.diameter_m >= 0.015) position_mm.push_back(1e3 * std::hypot(dx, dy));
    sigmas.push_back(std::abs(dx) / contact.sigma_position_m.x);
    sigmas.push_back(std::abs(dy) / contact.sigma_position_m.y);
  }

  std::map<std::uint32_t, std::uint32_t> ids_;  // reported, by true id, of the frame before
};

void print_scene_line(std::uint64_t seed, const char* tracker, const SceneJudge& judge) {
  fmt::print("{:>9}{:>14}{:>12}{:>9}{:>12}{:>12.2f}{:>9.2f}{:>8.2f}{:>8.2f}\n", seed, tracker, judge.held, judge.missed,
             judge.changes, percentile(judge.position_mm, 0.5), percentile(judge.position_mm, 0.95),
             share_below(judge.sigmas, 1.0), share_below(judge.sigmas, 2.0));
}

/// Every frame with the tracker of the frames before, and with a new one that knows nothing of them.
void print_scenes(const ArrayDescription& array, const touch::pipeline::Model& model) {
  fmt::print("scene contacts, 20 s each: contacts while 0.3 N or more are on taxels\n");
  fmt::print("{:>9}{:>14}{:>12}{:>9}{:>12}{:>12}{:>9}{:>8}{:>8}\n", "seed", "tracker", "in frames", "missed",
             "id changes", ">= 15 mm: p50", "p95 mm", "1 s", "2 s");
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto simulator = need(learn::simulation::Simulator::create(array, {}, "contacts", seed));
    touch::pipeline::Pipeline pipeline = need(touch::pipeline::Pipeline::create(model));
    touch::contacts::ContactTracker tracker(array);
    SceneJudge with_history;
    SceneJudge without_history;
    RawFrame frame;
    ForceFrame force;
    ContactReport report;
    while (need(simulator->next(frame))) {
      pipeline.process(frame, force);
      tracker.process(force, report);
      with_history.judge(simulator->truth().contacts, report);
      touch::contacts::ContactTracker(array).process(force, report);
      without_history.judge(simulator->truth().contacts, report);
    }
    print_scene_line(seed, "tracked", with_history);
    print_scene_line(seed, "a frame's own", without_history);
  }
  fmt::print("\n");
}

}  // namespace
}  // namespace dermis

int main() {
  const dermis::ArrayDescription array = dermis::support::reference_array();
  const dermis::touch::pipeline::Model model = dermis::calibrate(array);
  dermis::print_scenes(array, model);
  dermis::PressedArray pressed(array, model);
  dermis::print_single_contacts(pressed);
  dermis::print_several_contacts(pressed);
  dermis::print_elongated_contacts(pressed);
  return 0;
}
