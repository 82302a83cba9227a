// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/contacts/contact_tracks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dermis/touch/contacts/contact_tracker.hpp"

namespace dermis::touch::contacts {
namespace {

constexpr double kLeastVariance = 1e-18;  // [m2]
constexpr double kFirstSpeed = 0.5;       // sd of the velocity of a new contact [m/s]
constexpr double kAcceleration = 0.1;     // power density of the acceleration [m2/s3]: 0.1 m/s in 0.1 s

double seconds_between(Nanos from, Nanos to) {
  return std::max(0.0, std::chrono::duration<double>(to - from).count());
}

}  // namespace

void AxisFilter::begin(double position, double sigma) noexcept {
  position_ = position;
  velocity_ = 0.0;
  variance_position_ = sigma * sigma;
  covariance_ = 0.0;
  variance_velocity_ = kFirstSpeed * kFirstSpeed;
}

void AxisFilter::update(double seconds, double position, double sigma) noexcept {
  position_ += velocity_ * seconds;
  variance_position_ += seconds * (2.0 * covariance_ + seconds * (variance_velocity_ + seconds * kAcceleration / 3.0));
  covariance_ += seconds * (variance_velocity_ + seconds * kAcceleration / 2.0);
  variance_velocity_ += seconds * kAcceleration;
  const double total = std::max(variance_position_ + sigma * sigma, kLeastVariance);
  const double gain_position = variance_position_ / total;
  const double gain_velocity = covariance_ / total;
  const double surprise = position - position_;
  position_ += gain_position * surprise;
  velocity_ += gain_velocity * surprise;
  variance_velocity_ -= gain_velocity * covariance_;
  covariance_ -= gain_position * covariance_;
  variance_position_ -= gain_position * variance_position_;
}

PlaneVector ContactTracks::Track::predicted(Nanos time) const noexcept {
  const double seconds = seconds_between(seen, time);
  return {x.predicted(seconds), y.predicted(seconds)};
}

ContactTracks::ContactTracks(double reach_m) : reach_m_(reach_m) {
  tracks_.reserve(2 * kMostContacts);
  pairs_.reserve(16 * kMostContacts);
  is_taken_.reserve(kMostContacts);
}

void ContactTracks::predict(Nanos time, std::vector<ExpectedContact>& expected) const {
  expected.clear();
  for (const Track& track : tracks_) {
    expected.push_back({track.predicted(time), std::sqrt(track.contact.area_m2 / std::numbers::pi), track.profile});
  }
}

void ContactTracks::update(const ForceFrame& force, std::span<const FoundContact> found,
                           std::vector<Contact>& contacts) {
  for (Track& track : tracks_) track.is_found = false;
  is_taken_.assign(found.size(), false);
  pair_up(force.time, found);
  for (const Pair& pair : pairs_) {
    Track& track = tracks_[pair.track];
    if (track.is_found || is_taken_[pair.found]) continue;
    is_taken_[pair.found] = true;
    go_on(track, force.time, found[pair.found]);
  }
  end_or_hold(force);
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!is_taken_[k] && found[k].can_begin) begin(force.time, found[k]);
  }
  contacts.clear();
  for (const Track& track : tracks_) contacts.push_back(track.contact);
  std::erase_if(tracks_, [](const Track& track) { return track.contact.phase == ContactPhase::release; });
}

void ContactTracks::pair_up(Nanos time, std::span<const FoundContact> found) {
  pairs_.clear();
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const PlaneVector place = tracks_[t].predicted(time);
    for (std::size_t k = 0; k < found.size(); ++k) {
      const PlaneVector position = found[k].contact.position;
      const double dx = position.x - place.x;
      const double dy = position.y - place.y;
      const double distance = std::sqrt(dx * dx + dy * dy);
      if (distance < reach_m_ && pairs_.size() < pairs_.capacity()) pairs_.push_back({distance, t, k});
    }
  }
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
}

void ContactTracks::go_on(Track& track, Nanos time, const FoundContact& found) {
  const double seconds = seconds_between(track.seen, time);
  track.x.update(seconds, found.contact.position.x, found.contact.sigma_position_m.x);
  track.y.update(seconds, found.contact.position.y, found.contact.sigma_position_m.y);
  const std::uint32_t id = track.contact.id;
  const Nanos onset = track.contact.onset;
  track.contact = found.contact;
  track.contact.id = id;
  track.contact.onset = onset;
  track.contact.phase = ContactPhase::held;
  track.contact.velocity = {track.x.velocity(), track.y.velocity()};
  track.seen = time;
  track.peak = found.peak;
  track.profile = found.profile;
  track.is_found = true;
}

void ContactTracks::begin(Nanos time, const FoundContact& found) {
  Track track;
  track.contact = found.contact;
  track.contact.id = next_id_++;
  track.contact.phase = ContactPhase::onset;
  track.contact.onset = time;
  track.contact.velocity = {};
  track.x.begin(found.contact.position.x, found.contact.sigma_position_m.x);
  track.y.begin(found.contact.position.y, found.contact.sigma_position_m.y);
  track.seen = time;
  track.peak = found.peak;
  track.profile = found.profile;
  tracks_.push_back(track);
}

void ContactTracks::end_or_hold(const ForceFrame& force) {
  for (Track& track : tracks_) {
    if (track.is_found) continue;
    const bool is_blind = std::isnan(force.newtons[track.peak]);
    track.contact.phase = ContactPhase::held;
    if (is_blind && seconds_between(track.seen, force.time) <= kBlindSeconds) continue;
    track.contact.phase = ContactPhase::release;
    track.contact.force_n = 0.0;
    track.contact.peak_pressure_pa = 0.0;
    track.contact.mean_pressure_pa = 0.0;
  }
}

}  // namespace dermis::touch::contacts
