// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/simulation/pressure_patch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dermis::learn::simulation {
namespace {

constexpr int kNodes = 16;

/// Pressure at the relative radius rho over the mean pressure of the patch.
double relative_pressure(PatchShape shape, double rho) {
  if (shape == PatchShape::flat) return 1.0;
  return 1.5 * std::sqrt(std::max(0.0, 1.0 - rho * rho));  // Hertz: peak = 1.5 mean
}

/// Share of the force within the relative radius rho.
double share_within(PatchShape shape, double rho) {
  if (shape == PatchShape::flat) return rho * rho;
  return 1.0 - std::pow(1.0 - rho * rho, 1.5);
}

}  // namespace

// All lengths are over the patch's radius, in rings around its centre. Rings within the disc have a closed form; of the
// others the arc within the disc counts. r = middle - half cos(angle) takes the roots out of both ends of the integral.
double force_on_disc(PatchShape shape, double force_n, double patch_radius_m, double disc_radius_m, double distance_m) {
  const double disc = disc_radius_m / patch_radius_m;
  const double away = distance_m / patch_radius_m;
  if (away >= 1.0 + disc) return 0.0;
  double share = disc > away ? share_within(shape, std::min(1.0, disc - away)) : 0.0;
  const double inner = std::abs(disc - away);
  const double outer = std::min(1.0, disc + away);
  if (outer <= inner) return force_n * share;
  const double middle = 0.5 * (inner + outer);
  const double half = 0.5 * (outer - inner);
  constexpr double kStep = std::numbers::pi / kNodes;
  for (int node = 0; node < kNodes; ++node) {
    const double angle = kStep * (node + 0.5);
    const double ring = middle - half * std::cos(angle);
    const double cosine = (ring * ring + away * away - disc * disc) / (2.0 * ring * away);
    const double arc = 2.0 * std::acos(std::clamp(cosine, -1.0, 1.0));
    share += relative_pressure(shape, ring) * arc * ring * half * std::sin(angle) * kStep / std::numbers::pi;
  }
  return force_n * share;
}

}  // namespace dermis::learn::simulation
