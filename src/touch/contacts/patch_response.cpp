// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/contacts/patch_response.hpp"

#include <numbers>

namespace dermis::touch::contacts {
namespace {

/// Share of the force within `r` of the centre.
double share_within(PatchProfile profile, double r, double radius) {
  const double square = std::min(1.0, r * r / (radius * radius));
  return profile == PatchProfile::flat ? square : 1.0 - std::pow(1.0 - square, 1.5);
}

/// Over a unit of force.
double pressure(PatchProfile profile, double r, double radius) {
  const double mean = 1.0 / (std::numbers::pi * radius * radius);
  if (profile == PatchProfile::flat) return mean;
  return 1.5 * mean * std::sqrt(std::max(0.0, 1.0 - r * r / (radius * radius)));
}

/// Integrates over the circles around the patch's centre that lie within the taxel of radius 1, and the part of the
/// others that does. The midpoint rule in the angle t with r = middle + half sin t removes the roots at both ends of r.
double share(PatchProfile profile, double distance, double radius) {
  double sum = distance < 1.0 ? share_within(profile, 1.0 - distance, radius) : 0.0;
  const double low = std::min(std::abs(distance - 1.0), radius);
  const double high = std::min(distance + 1.0, radius);
  const double middle = 0.5 * (low + high);
  const double half = 0.5 * (high - low);
  constexpr int kSteps = 32;
  constexpr double kStep = std::numbers::pi / kSteps;
  for (int k = 0; k < kSteps && half > 0.0; ++k) {
    const double t = (k + 0.5) * kStep - 0.5 * std::numbers::pi;
    const double r = middle + half * std::sin(t);
    const double cosine = std::clamp((r * r + distance * distance - 1.0) / (2.0 * r * distance), -1.0, 1.0);
    sum += kStep * half * std::cos(t) * 2.0 * r * std::acos(cosine) * pressure(profile, r, radius);
  }
  return sum;
}

}  // namespace

const PatchResponse& PatchResponse::of(PatchProfile profile) {
  static const PatchResponse kHertz(PatchProfile::hertz);
  static const PatchResponse kFlat(PatchProfile::flat);
  return profile == PatchProfile::hertz ? kHertz : kFlat;
}

PatchResponse::PatchResponse(PatchProfile profile) : knots_(kRadii * kDistances) {
  for (std::size_t i = 0; i < kRadii; ++i) {
    const double radius = kLeastRadius * std::exp(static_cast<double>(i) / kKnotsPerLogRadius);
    reaches_.push_back(static_cast<float>(radius) + 1.0F + 1.0F / kKnotsPerDistance);
    for (std::size_t k = 0; k < kDistances; ++k) {
      const double distance = std::max(1e-6, static_cast<double>(k) / kKnotsPerDistance);
      if (distance < radius + 1.0) knots_[i * kDistances + k][3] = static_cast<float>(share(profile, distance, radius));
    }
  }
  differentiate();
}

void PatchResponse::differentiate() {
  for (std::size_t i = 0; i < kRadii; ++i) {
    const std::size_t below = std::max<std::size_t>(i, 1) - 1;
    const std::size_t above = std::min(i + 1, kRadii - 1);
    for (std::size_t k = 0; k < kDistances; ++k) {
      const std::size_t left = std::max<std::size_t>(k, 1) - 1;
      const std::size_t right = std::min(k + 1, kDistances - 1);
      std::array<float, 4>& knot = knots_[i * kDistances + k];
      knot[0] = k == 0 ? 0.0F
                       : (knots_[i * kDistances + right][3] - knots_[i * kDistances + left][3]) * kKnotsPerDistance /
                             static_cast<float>(right - left);
      knot[1] = knot[0];
      knot[2] = (knots_[above * kDistances + k][3] - knots_[below * kDistances + k][3]) * kKnotsPerLogRadius /
                static_cast<float>(above - below);
    }
  }
}

}  // namespace dermis::touch::contacts
