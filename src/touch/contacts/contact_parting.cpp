// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/contacts/contact_parting.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dermis::touch::contacts {
namespace {

constexpr double kLeastPitchesApart = 1.6;  // from this contact's centre to the strongest taxel of another
constexpr float kLeastShareOfOther = 0.5F;  // of a taxel's force, that is not this contact's

}  // namespace

ContactParting::ContactParting(const TaxelPlane& plane) : plane_(plane) {
  unexplained_.reserve(PatchSearch::kMostTaxels);
  apart_.reserve(PatchSearch::kMostTaxels);
}

std::size_t ContactParting::part(const ForceFrame& force, std::span<std::uint32_t> taxels, const Measurement& measured,
                                 Evidence evidence, std::span<const std::uint32_t> held) {
  if (!measured.patch) return taxels.size();
  unexplained_.clear();
  for (const std::uint32_t taxel : taxels) {
    if (stands_out(force, taxel, measured, evidence, 0.0F)) unexplained_.push_back(taxel);
  }
  const auto seed = held.empty()
                        ? unexplained_.begin()
                        : std::find_first_of(unexplained_.begin(), unexplained_.end(), held.begin(), held.end());
  if (seed == unexplained_.end()) return taxels.size();
  std::iter_swap(unexplained_.begin(), seed);
  keep_what_hangs_together(unexplained_);
  apart_.clear();
  std::size_t explained = 0;
  for (const std::uint32_t taxel : taxels) {
    if (std::find(unexplained_.begin(), unexplained_.end(), taxel) == unexplained_.end()) {
      taxels[explained++] = taxel;
    } else {
      apart_.push_back(taxel);
    }
  }
  std::copy(apart_.begin(), apart_.end(), taxels.begin() + static_cast<std::ptrdiff_t>(explained));
  return explained;
}

/// Keeps those that hang together with the first of them.
void ContactParting::keep_what_hangs_together(std::vector<std::uint32_t>& taxels) const {
  std::size_t kept = 1;
  for (std::size_t k = 0; k < kept; ++k) {
    for (std::size_t other = kept; other < taxels.size(); ++other) {
      if (plane_.are_neighbours(taxels[k], taxels[other])) std::swap(taxels[kept++], taxels[other]);
    }
  }
  taxels.resize(kept);
}

/// The force of another contact is weak against this one's peak, or there would be a valley.
bool ContactParting::stands_out(const ForceFrame& force, std::uint32_t taxel, const Measurement& measured,
                                Evidence evidence, float scatter) const {
  const float newtons = force.newtons[taxel];
  const float sigma = std::hypot(force.sigma_newtons[taxel], scatter);
  if (!is_weak(newtons, force.newtons[measured.peak]) || !std::isfinite(sigma)) return false;
  const double dx = plane_.places[taxel].x - plane_.places[measured.peak].x - measured.patch->patch.x;
  const double dy = plane_.places[taxel].y - plane_.places[measured.peak].y - measured.patch->patch.y;
  const double distance = std::sqrt(dx * dx + dy * dy);
  if (plane_.taxel_radius_m * distance <
      evidence.share * kLeastPitchesApart * std::min(plane_.row_pitch_m, plane_.col_pitch_m))
    return false;
  const PatchResponse::Row response =
      plane_.responses->of(measured.patch->profile).row(measured.patch->patch.log_radius);
  const float expected = measured.patch->patch.newtons * response.share(static_cast<float>(distance));
  return newtons - expected >=
         evidence.share * std::max<double>(kLeastShareOfOther * newtons, evidence.onset_sigma * sigma);
}

}  // namespace dermis::touch::contacts
