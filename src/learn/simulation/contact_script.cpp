// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/simulation/contact_script.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "learn/simulation/pressure_patch.hpp"

namespace dermis::learn::simulation {
namespace {

constexpr std::uint64_t kScriptStream = std::numeric_limits<std::uint64_t>::max() - 3;  // No frame has this index.
constexpr std::size_t kSlots = 5;            // As many contacts at once at most.
constexpr std::size_t kUnloadedFrames = 30;  // At the beginning and at the end.
constexpr std::size_t kShortestFrames = 50;
constexpr std::size_t kLongestFrames = 450;
constexpr std::size_t kLeastPauseFrames = 20;
constexpr std::size_t kMorePauseFrames = 60;  // Each slot pauses longer than the one before.
constexpr int kTries = 60;

constexpr double kSmallestM = 0.008;
constexpr double kLargestM = 0.030;
constexpr double kWeakestN = 2.0;
constexpr double kStrongestN = 50.0;
constexpr double kFlatShare = 0.3;
constexpr double kRestingShare = 0.35;
constexpr double kEdgeShare = 0.15;
constexpr double kSlowestMPerS = 0.01;
constexpr double kFastestMPerS = 0.08;  // On average over a slide.
constexpr double kPitchesApart = 2.5;

/// From 0 to 1 with a velocity of 0 at both ends.
double smooth(double u) {
  const double clamped = std::clamp(u, 0.0, 1.0);
  return clamped * clamped * (3.0 - 2.0 * clamped);
}

double distance_m(const PlaneVector& a, const PlaneVector& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

double taxel_radius_m(const ArrayDescription& array) {
  if (array.taxel_area_m2) return std::sqrt(*array.taxel_area_m2 / std::numbers::pi);
  return 0.35 * std::min(array.row_pitch_m, array.col_pitch_m);
}

}  // namespace

PlaneVector ContactScript::Touch::position(std::size_t frame) const {
  const double u = smooth(static_cast<double>(frame - first) / static_cast<double>(frames));
  const double from_begin = (1.0 - u) * (1.0 - u);
  const double from_bend = 2.0 * u * (1.0 - u);
  return {from_begin * begin.x + from_bend * bend.x + u * u * end.x,
          from_begin * begin.y + from_bend * bend.y + u * u * end.y};
}

double ContactScript::Touch::force(std::size_t frame) const {
  const double since_first_s = kFrameS * static_cast<double>(frame - first + 1);
  const double until_end_s = kFrameS * static_cast<double>(first + frames - frame);
  return force_n * smooth(since_first_s / onset_s) * smooth(until_end_s / release_s);
}

ContactScript::ContactScript(const ArrayDescription& array, std::size_t frames, std::uint64_t seed)
    : array_(array), taxel_radius_m_(taxel_radius_m(array)), pitch_m_(std::max(array.row_pitch_m, array.col_pitch_m)) {
  Random random = Random::stream(seed, kScriptStream);
  for (std::size_t slot = 0; slot < kSlots; ++slot) fill_slot(slot, random, frames);
  std::stable_sort(touches_.begin(), touches_.end(), [](const Touch& a, const Touch& b) { return a.first < b.first; });
}

void ContactScript::fill_slot(std::size_t slot, Random& random, std::size_t frames) {
  const std::size_t pause_bound = kLeastPauseFrames + kMorePauseFrames * slot;
  std::size_t first = kUnloadedFrames + (slot == 0 ? 0 : random.below(pause_bound));
  while (first + kShortestFrames + kUnloadedFrames <= frames) {
    Touch touch;
    touch.first = first;
    const std::size_t longest = std::min(kLongestFrames, frames - kUnloadedFrames - first);
    touch.frames = kShortestFrames + random.below(longest - kShortestFrames + 1);
    if (place(touch, random)) touches_.push_back(touch);
    first += touch.frames + kLeastPauseFrames + random.below(pause_bound);
  }
}

bool ContactScript::place(Touch& touch, Random& random) const {
  for (int attempt = 0; attempt < kTries; ++attempt) {
    touch.shape = random.uniform() < kFlatShare ? PatchShape::flat : PatchShape::hertz;
    touch.diameter_m = random.uniform(kSmallestM, kLargestM);
    touch.force_n = random.log_uniform(kWeakestN, kStrongestN);
    touch.onset_s = random.uniform(0.05, 0.2);
    touch.release_s = random.uniform(0.05, 0.2);
    draw_path(touch, random);
    if (keeps_apart(touch)) return true;
  }
  return false;
}

void ContactScript::draw_path(Touch& touch, Random& random) const {
  const double margin = random.uniform() < kEdgeShare ? 0.5 : 0.0;
  touch.begin = draw_point(random, margin);
  touch.bend = touch.end = touch.begin;
  const double seconds = kFrameS * static_cast<double>(touch.frames);
  const double length_m = random.uniform(kSlowestMPerS, kFastestMPerS) * seconds;
  if (random.uniform() < kRestingShare) return;
  const auto towards_new_point = [&](const PlaneVector& from) {
    const PlaneVector aim = draw_point(random, margin);
    const double share = std::min(1.0, 0.5 * length_m / std::max(distance_m(from, aim), 1e-9));
    return PlaneVector{from.x + share * (aim.x - from.x), from.y + share * (aim.y - from.y)};
  };
  touch.bend = towards_new_point(touch.begin);
  touch.end = towards_new_point(touch.bend);
}

/// Anywhere between the centres of the outermost taxels, and `margin` pitches beyond them.
PlaneVector ContactScript::draw_point(Random& random, double margin) const {
  const auto last_col = static_cast<double>(array_.cols - 1);
  const auto last_row = static_cast<double>(array_.rows - 1);
  return {array_.col_pitch_m * random.uniform(-margin, last_col + margin),
          array_.row_pitch_m * random.uniform(-margin, last_row + margin)};
}

bool ContactScript::keeps_apart(const Touch& touch) const {
  for (const Touch& other : touches_) {
    const std::size_t first = std::max(touch.first, other.first);
    const std::size_t end = std::min(touch.first + touch.frames, other.first + other.frames);
    const double least_m = std::max(kPitchesApart * pitch_m_, 0.5 * (touch.diameter_m + other.diameter_m) + pitch_m_);
    for (std::size_t frame = first; frame < end; ++frame) {
      if (distance_m(touch.position(frame), other.position(frame)) < least_m) return false;
    }
  }
  return true;
}

void ContactScript::frame(std::size_t index, std::vector<AppliedContact>& contacts,
                          std::vector<double>& force_n) const {
  contacts.clear();
  const auto is_before = [](const Touch& touch, std::size_t frame) { return touch.first < frame; };
  const std::size_t oldest = index - std::min(index, kLongestFrames);
  for (auto touch = std::lower_bound(touches_.begin(), touches_.end(), oldest, is_before);
       touch != touches_.end() && touch->first <= index; ++touch) {
    if (index >= touch->first + touch->frames) continue;
    const PlaneVector position = touch->position(index);
    AppliedContact contact;
    contact.id = static_cast<std::uint32_t>(touch - touches_.begin() + 1);
    contact.shape = touch->shape;
    contact.x_m = position.x;
    contact.y_m = position.y;
    contact.force_n = touch->force(index);
    contact.diameter_m = touch->diameter_m;
    contact.taxel_force_n = spread(contact, force_n);
    contacts.push_back(contact);
  }
}

/// Adds the contact to the taxels under it and returns how much they got.
double ContactScript::spread(const AppliedContact& contact, std::vector<double>& force_n) const {
  const double radius_m = 0.5 * contact.diameter_m;
  const double reach_m = radius_m + taxel_radius_m_;
  const auto range = [reach_m](double centre_m, double pitch_m, std::size_t lines) {
    const auto last = static_cast<double>(lines - 1);
    return std::pair{static_cast<std::size_t>(std::clamp(std::ceil((centre_m - reach_m) / pitch_m), 0.0, last)),
                     static_cast<std::size_t>(std::clamp(std::floor((centre_m + reach_m) / pitch_m), 0.0, last))};
  };
  const auto [first_row, last_row] = range(contact.y_m, array_.row_pitch_m, array_.rows);
  const auto [first_col, last_col] = range(contact.x_m, array_.col_pitch_m, array_.cols);
  double sum_n = 0.0;
  for (std::size_t row = first_row; row <= last_row; ++row) {
    for (std::size_t col = first_col; col <= last_col; ++col) {
      const double away_m = std::hypot(static_cast<double>(col) * array_.col_pitch_m - contact.x_m,
                                       static_cast<double>(row) * array_.row_pitch_m - contact.y_m);
      const double on_taxel_n = force_on_disc(contact.shape, contact.force_n, radius_m, taxel_radius_m_, away_m);
      force_n[array_.index(row, col)] += on_taxel_n;
      sum_n += on_taxel_n;
    }
  }
  return sum_n;
}

}  // namespace dermis::learn::simulation
