// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/contacts/contact_tracker.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <utility>

#include "dermis/touch/frames/neighbours.hpp"
#include "touch/contacts/contact_gauge.hpp"
#include "touch/contacts/contact_parting.hpp"
#include "touch/contacts/contact_tracks.hpp"
#include "touch/contacts/stressed_areas.hpp"
#include "touch/contacts/strip.hpp"
#include "touch/contacts/taxel_plane.hpp"

namespace dermis::touch::contacts {
namespace {

Status check_range(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return Done{};
  return bad_input("contacts." + std::string(name) + ": is " + std::to_string(value) + ", must be " +
                   std::to_string(low) + " to " + std::to_string(high));
}

}  // namespace

Status ContactOptions::validate() const {
  if (Status valid = check_range("onset_sigma", onset_sigma, 1.0, 100.0); !valid) return valid;
  if (Status valid = check_range("onset_force_n", onset_force_n, 0.0, 1000.0); !valid) return valid;
  if (Status valid = check_range("release_share", release_share, 0.1, 1.0); !valid) return valid;
  return check_range("most_contacts", static_cast<double>(most_contacts), 1.0, static_cast<double>(kMostContacts));
}

class ContactTracker::Implementation {
 public:
  Implementation(const ArrayDescription& array, const ContactOptions& contact_options, std::optional<StripTable> strip)
      : options(contact_options),
        plane_(array),
        pitch_m_(strip_pitch_m(array).value_or(std::max(array.row_pitch_m, array.col_pitch_m))),
        areas_(array.rows, array.cols, strip.has_value()),
        gauge_(plane_, std::move(strip)),
        parting_(plane_),
        tracks_(kReachPitches * pitch_m_) {
    assert(array.validate().has_value());
    found_.reserve(array.taxel_count());
    expected_.reserve(kMostContacts);
    held_.reserve(kMostContacts);
    touched_.reserve(array.taxel_count());
    regions_.reserve(array.taxel_count() + 1);
    totals_.reserve(array.taxel_count() + 1);
  }

  void process(const ForceFrame& force, ContactReport& report) noexcept {
    assert(force.newtons.size() == plane_.places.size() && force.sigma_newtons.size() == plane_.places.size() &&
           force.signal_to_noise.size() == plane_.places.size());
    report.time = force.time;
    report.status = force.status;
    report.contacts.reserve(2 * options.most_contacts);
    find_held_taxels(force.time);
    areas_.find(force, pressed_sigma(), held_);
    found_.clear();
    touched_.clear();
    regions_.clear();
    for (const std::span<std::uint32_t> taxels : areas_.areas()) add(force, taxels);
    find_sigmas(force);
    keep_strongest();
    tracks_.update(force, found_, report.contacts);
    add_up(report);
    // Errors that contacts share add up; the others add in squares.
    if (report.centre_of_pressure) report.sigma_total_n = std::max(report.sigma_total_n, totals_.back().sigma_newtons);
  }

  void forget() noexcept { tracks_.forget(); }

  ContactOptions options;

 private:
  static constexpr double kReachPitches = 2.0;
  static constexpr double kPitchesApart = 1.7;

  /// A taxel is pressed from so many standard deviations of the noise on.
  [[nodiscard]] double pressed_sigma() const { return options.release_share * options.onset_sigma; }

  void find_held_taxels(Nanos time) {
    tracks_.predict(time, expected_);
    held_.clear();
    for (const ExpectedContact& expected : expected_) {
      const PlaneVector place = expected.place;
      const double row = std::clamp(place.y / plane_.row_pitch_m, 0.0, static_cast<double>(plane_.rows - 1));
      const double col = std::clamp(place.x / plane_.col_pitch_m, 0.0, static_cast<double>(plane_.cols - 1));
      held_.push_back(static_cast<std::uint32_t>(std::lround(row)) * static_cast<std::uint32_t>(plane_.cols) +
                      static_cast<std::uint32_t>(std::lround(col)));
    }
  }

  /// An area too weak to go on is left out, and one that holds two contacts is parted.
  void add(const ForceFrame& force, std::span<std::uint32_t> taxels) {
    if (!any_part_can_go_on(force, taxels)) return;
    const Measurement measured = gauge_.measure(force, taxels, pressed_sigma(), expected_at(taxels.front()));
    const auto [own, share] = part(force, taxels, measured);
    if (own < taxels.size() && own > 0 && can_go_on(force, taxels.subspan(own)) && is_top(force, taxels, taxels[own]) &&
        are_apart(force, taxels.first(own), taxels.subspan(own), share)) {
      add(force, taxels.first(own));
      add(force, taxels.subspan(own));
      return;
    }
    if (!can_go_on(force, taxels)) return;
    found_.push_back({measured.contact, measured.peak, measured.profile(), is_strong(force, taxels, 1.0)});
    const std::size_t before = touched_.size();
    touched_.insert(touched_.end(), taxels.begin(), taxels.end());
    regions_.push_back(std::span<const std::size_t>(touched_).subspan(before));
  }

  /// Includes the errors that the taxels share.
  void find_sigmas(const ForceFrame& force) {
    regions_.emplace_back(touched_);
    totals_.resize(regions_.size());
    force.find_totals(regions_, totals_);
    for (std::size_t k = 0; k < found_.size(); ++k) found_[k].contact.sigma_force_n = totals_[k].sigma_newtons;
  }

  struct Parting {
    std::size_t own = 0;  // taxels before the other contact's
    double share = 1.0;   // of the evidence that it needs
  };

  /// A contact that is there already is looked for before a new one.
  [[nodiscard]] Parting part(const ForceFrame& force, std::span<std::uint32_t> taxels, const Measurement& measured) {
    if (holds_several(taxels)) {
      const Evidence of_held{options.onset_sigma, StressedAreas::kHeldShare};
      const std::size_t own = parting_.part(force, taxels, measured, of_held, held_);
      if (own < taxels.size()) return {own, of_held.share};
    }
    const Evidence of_new{options.onset_sigma, 1.0};
    return {parting_.part(force, taxels, measured, of_new, {}), of_new.share};
  }

  /// More than one contact of the frame before was on these taxels.
  [[nodiscard]] bool holds_several(std::span<const std::uint32_t> taxels) const {
    return std::count_if(held_.begin(), held_.end(), [&](std::uint32_t held) {
             return std::find(taxels.begin(), taxels.end(), held) != taxels.end();
           }) > 1;
  }

  /// The other one stands out of all deviations of the first one's taxels from its patch, and their patches do not
  /// overlap. Contacts found on parts of an elongated one do overlap, near each other.
  [[nodiscard]] bool are_apart(const ForceFrame& force, std::span<const std::uint32_t> one,
                               std::span<const std::uint32_t> other, double share) {
    const Measurement measured = gauge_.measure(force, one, pressed_sigma(), nullptr);
    if (!stands_out(force, one, other.front(), measured, {options.onset_sigma, share})) return false;
    const Contact a = measured.contact;
    const Contact b = gauge_.measure(force, other, pressed_sigma(), nullptr).contact;
    const double distance = std::hypot(a.position.x - b.position.x, a.position.y - b.position.y);
    return distance >= share * kPitchesApart * pitch_m_ ||
           distance >= share * (std::sqrt(a.area_m2 / std::numbers::pi) + std::sqrt(b.area_m2 / std::numbers::pi));
  }

  /// `taxel` stands out of the deviations of the weak taxels around `area` from its patch. All do where it has none.
  [[nodiscard]] bool stands_out(const ForceFrame& force, std::span<const std::uint32_t> area, std::uint32_t taxel,
                                const Measurement& measured, Evidence evidence) {
    if (!measured.patch) return true;
    const float scatter = gauge_.scatter_of_weak_taxels(force, area, pressed_sigma(), measured);
    return parting_.stands_out(force, taxel, measured, evidence, scatter);
  }

  /// No taxel of another area beside it is stronger; otherwise it is the rim of that area.
  [[nodiscard]] bool is_top(const ForceFrame& force, std::span<const std::uint32_t> area, std::uint32_t taxel) const {
    for (const std::size_t beside : Neighbours(plane_.rows, plane_.cols, taxel)) {
      if (!(force.newtons[beside] > force.newtons[taxel])) continue;
      if (std::find(area.begin(), area.end(), beside) == area.end()) return false;
    }
    return true;
  }

  [[nodiscard]] bool can_go_on(const ForceFrame& force, std::span<const std::uint32_t> taxels) const {
    return is_strong(force, taxels, expected_at(taxels.front()) != nullptr ? options.release_share : 1.0);
  }

  /// No part of an area is stronger than the whole: noise is not measured.
  [[nodiscard]] bool any_part_can_go_on(const ForceFrame& force, std::span<const std::uint32_t> taxels) const {
    const auto is_expected = [&](std::uint32_t taxel) { return expected_at(taxel) != nullptr; };
    const bool any_is_expected = !held_.empty() && std::any_of(taxels.begin(), taxels.end(), is_expected);
    return is_strong(force, taxels, any_is_expected ? options.release_share : 1.0);
  }

  /// `share`: of the thresholds of an onset. Each taxel adds the square of its signal over the noise, less that of a
  /// taxel that just counts as pressed. So one taxel needs onset_sigma, and several together need less each. Noise that
  /// takes a taxel just over the threshold adds nothing.
  [[nodiscard]] bool is_strong(const ForceFrame& force, std::span<const std::uint32_t> taxels, double share) const {
    const double pressed = pressed_sigma();
    const double onset = std::max(share * options.onset_sigma, pressed);
    double evidence = 0.0;
    double newtons = 0.0;
    for (const std::uint32_t taxel : taxels) {
      const double signal = force.signal_to_noise[taxel];
      evidence += signal * signal - pressed * pressed;
      newtons += force.newtons[taxel];
    }
    return evidence >= onset * onset - pressed * pressed && newtons >= share * options.onset_force_n;
  }

  /// The nearest contact expected on this taxel or on a neighbour of it; null where there is none.
  [[nodiscard]] const ExpectedContact* expected_at(std::uint32_t taxel) const {
    const ExpectedContact* found = nullptr;
    std::int64_t least = 3;  // of the squared distance: the 8 neighbours are at 1 or 2
    for (std::size_t k = 0; k < held_.size(); ++k) {
      const auto rows =
          static_cast<std::int64_t>(held_[k] / plane_.cols) - static_cast<std::int64_t>(taxel / plane_.cols);
      const auto cols =
          static_cast<std::int64_t>(held_[k] % plane_.cols) - static_cast<std::int64_t>(taxel % plane_.cols);
      const std::int64_t distance = rows * rows + cols * cols;
      if (distance >= least) continue;
      least = distance;
      found = &expected_[k];
    }
    return found;
  }

  void keep_strongest() {
    if (found_.size() <= options.most_contacts) return;
    std::sort(found_.begin(), found_.end(), [](const FoundContact& a, const FoundContact& b) {
      return a.contact.force_n != b.contact.force_n ? a.contact.force_n > b.contact.force_n : a.peak < b.peak;
    });
    found_.resize(options.most_contacts);
  }

  static void add_up(ContactReport& report) {
    double sum = 0.0;
    double variance = 0.0;
    PlaneVector first;
    for (const Contact& contact : report.contacts) {
      if (contact.phase == ContactPhase::release) continue;
      sum += contact.force_n;
      variance += contact.sigma_force_n * contact.sigma_force_n;
      first.x += contact.force_n * contact.position.x;
      first.y += contact.force_n * contact.position.y;
    }
    report.total_force_n = sum;
    report.sigma_total_n = std::sqrt(variance);
    report.centre_of_pressure.reset();
    if (sum > 0.0) report.centre_of_pressure = PlaneVector{first.x / sum, first.y / sum};
  }

  TaxelPlane plane_;
  double pitch_m_;
  StressedAreas areas_;
  ContactGauge gauge_;
  ContactParting parting_;
  ContactTracks tracks_;
  std::vector<ExpectedContact> expected_;
  // [expected]: the taxel it is on
  std::vector<std::uint32_t> held_;
  std::vector<FoundContact> found_;
  std::vector<std::size_t> touched_;                   // taxels of all that were found
  std::vector<std::span<const std::size_t>> regions_;  // those of each, and all of them last
  std::vector<TotalForce> totals_;                     // of the regions
};

ContactTracker::ContactTracker(const ArrayDescription& array, const ContactOptions& options,
                               std::optional<StripTable> strip)
    : implementation_(std::make_unique<Implementation>(array, options, std::move(strip))) {
  assert(options.validate().has_value());
}

ContactTracker::ContactTracker(ContactTracker&&) noexcept = default;
ContactTracker& ContactTracker::operator=(ContactTracker&&) noexcept = default;
ContactTracker::~ContactTracker() = default;

void ContactTracker::process(const ForceFrame& force, ContactReport& report) noexcept {
  implementation_->process(force, report);
}

void ContactTracker::forget() noexcept {
  implementation_->forget();
}

void ContactTracker::set_options(const ContactOptions& options) noexcept {
  assert(options.validate().has_value());
  implementation_->options = options;
}

const ContactOptions& ContactTracker::options() const noexcept {
  return implementation_->options;
}

}  // namespace dermis::touch::contacts
