// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/faults/equal_presses.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::touch::compensation {
namespace {

constexpr int kLeastPlaces = 2;           // of a press whose other places may differ both ways
constexpr double kEqualBeforehand = 2.0;  // places that were equal before any was seen
constexpr double kLeastScattered = 2.0;
constexpr double kScatteredShare = 0.5;  // of presses; their shape alone makes a quarter of them differ both ways
constexpr double kSigmas = 3.0;          // of a number of presses

}  // namespace

void EqualPresses::add(const PressComparison& press) {
  const double chance = chance_of_place();
  places_ += press.places();
  equal_places_ += press.equal;
  if (press.places() < kLeastPlaces) return;
  presses_ += 1.0;
  all_equal_ += press.equal == press.places() ? 1.0 : 0.0;
  expected_ += std::pow(chance, press.places());
  scattered_ += press.more > 0 && press.less > 0 ? 1.0 : 0.0;
}

EqualPresses EqualPresses::without(const EqualPresses& others) const {
  EqualPresses rest;
  for (double EqualPresses::*const count :
       {&EqualPresses::presses_, &EqualPresses::all_equal_, &EqualPresses::expected_, &EqualPresses::scattered_,
        &EqualPresses::places_, &EqualPresses::equal_places_}) {
    rest.*count = std::max(this->*count - others.*count, 0.0);  // expectations are of the chances known at the time
  }
  return rest;
}

/// Places of one press are not independent where more presses are equal everywhere than chance allows.
double EqualPresses::evidence(int places) const {
  if (scattered_ < std::max(kLeastScattered, kScatteredShare * presses_)) return 0.0;
  const double of_places = -places * std::log(chance_of_place());
  if (all_equal_ <= 1.0 + expected_ + kSigmas * std::sqrt(expected_)) return of_places;
  return std::min(of_places, std::log((presses_ + 1.0) / (all_equal_ + 1.0)));
}

double EqualPresses::chance_of_place() const {
  return (equal_places_ + kEqualBeforehand) / (places_ + kEqualBeforehand);
}

}  // namespace dermis::touch::compensation
