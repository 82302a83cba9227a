// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/contacts/patch_response.hpp"

#include <numbers>
#include <numeric>

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

constexpr double kLeastSpread = 0.1;  // in radii of a taxel: less is narrower than the knots
constexpr double kReachSpreads = 4.0;
constexpr double kMiddleOfFirst = 0.25;  // of the knot at 0, which stands for half a step

/// exp(-x) I0(x) for x >= 0 (Abramowitz and Stegun 9.8.1 and 9.8.2).
double scaled_bessel_i0(double x) {
  constexpr double kBorder = 3.75;
  const auto polynomial = [](auto coefficients, double t) {
    double sum = 0.0;
    for (const double coefficient : coefficients) sum = sum * t + coefficient;
    return sum;
  };
  if (x < kBorder) {
    const double t = x * x / (kBorder * kBorder);
    return std::exp(-x) *
           polynomial(std::array{0.0045813, 0.0360768, 0.2659732, 1.2067492, 3.0899424, 3.5156229, 1.0}, t);
  }
  return polynomial(std::array{0.00392377, -0.01647633, 0.02635537, -0.02057706, 0.00916281, -0.00157565, 0.00225319,
                               0.01328592, 0.39894228},
                    kBorder / x) /
         std::sqrt(x);
}

}  // namespace

std::shared_ptr<const PatchResponses> PatchResponses::of(double spread) {
  static const auto kWithoutCover = std::make_shared<const PatchResponses>(0.0);
  return spread > 0.0 ? std::make_shared<const PatchResponses>(spread) : kWithoutCover;
}

PatchResponse::PatchResponse(PatchProfile profile, double spread) : knots_(kRadii * kDistances) {
  for (std::size_t i = 0; i < kRadii; ++i) {
    const double radius = kLeastRadius * std::exp(static_cast<double>(i) / kKnotsPerLogRadius);
    reaches_.push_back(static_cast<float>(radius) + 1.0F + 1.0F / kKnotsPerDistance);
    for (std::size_t k = 0; k < kDistances; ++k) {
      const double distance = std::max(1e-6, static_cast<double>(k) / kKnotsPerDistance);
      if (distance < radius + 1.0) knots_[i * kDistances + k][3] = static_cast<float>(share(profile, distance, radius));
    }
  }
  if (spread > kLeastSpread) spread_by(spread);
  differentiate();
}

/// The share at a distance d becomes its mean over the Gaussian about this place. That is an integral over distances r
/// with the weight r I0(r d / s^2) exp(-(r^2 + d^2) / 2 s^2).
void PatchResponse::spread_by(double spread) {
  constexpr double kStep = 1.0 / kKnotsPerDistance;
  std::vector<double> weights(kDistances * kDistances);
  for (std::size_t to = 0; to < kDistances; ++to) {
    const double d = static_cast<double>(to) * kStep;
    double sum = 0.0;
    for (int from = 0; from < 2 * static_cast<int>(kDistances); ++from) {  // also where the shares are 0
      const double r = (static_cast<double>(from) + kMiddleOfFirst * static_cast<double>(from == 0)) * kStep;
      const double off = (r - d) / spread;
      const double weight = r * std::exp(-0.5 * off * off) * scaled_bessel_i0(r * d / (spread * spread));
      sum += weight;
      if (from < static_cast<int>(kDistances)) weights[to * kDistances + static_cast<std::size_t>(from)] = weight;
    }
    for (std::size_t from = 0; from < kDistances; ++from) weights[to * kDistances + from] /= sum;
  }
  for (std::size_t i = 0; i < kRadii; ++i) {
    const auto knots = knots_.begin() + static_cast<std::ptrdiff_t>(i * kDistances);
    std::array<double, kDistances> narrow{};
    for (std::size_t k = 0; k < kDistances; ++k) narrow[k] = knots[static_cast<std::ptrdiff_t>(k)][3];
    for (std::size_t k = 0; k < kDistances; ++k) {
      const auto row = weights.begin() + static_cast<std::ptrdiff_t>(k * kDistances);
      knots[static_cast<std::ptrdiff_t>(k)][3] =
          static_cast<float>(std::inner_product(narrow.begin(), narrow.end(), row, 0.0));
    }
    constexpr double kLast = static_cast<double>(kDistances - 1) * kStep;
    reaches_[i] = static_cast<float>(std::min(reaches_[i] + kReachSpreads * spread, kLast));
  }
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
