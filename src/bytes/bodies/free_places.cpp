// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/bodies/free_places.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "bytes/bodies/vector3.hpp"

namespace dermis {
namespace {

constexpr double kFill = 0.43;      // of the distance to the nearest taxel
constexpr double kMostUsual = 2.0;  // radii, so that a lone taxel is not large
constexpr double kEven = 0.1;       // of the step
constexpr std::size_t kFewest = 3;

using Axis = double Vector3::*;

double extent_of(const std::vector<Vector3>& positions, Axis axis) {
  const auto [least, most] = std::minmax_element(
      positions.begin(), positions.end(), [axis](const Vector3& a, const Vector3& b) { return a.*axis < b.*axis; });
  return (*most).*axis - (*least).*axis;
}

bool are_evenly_on_a_line(const std::vector<Vector3>& positions) {
  const Vector3 step = 1.0 / static_cast<double>(positions.size() - 1) * (positions.back() - positions.front());
  const double most = kEven * std::sqrt(dot(step, step));
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const Vector3 off = positions[k] - (positions.front() + static_cast<double>(k) * step);
    if (std::sqrt(dot(off, off)) > most) return false;
  }
  return true;
}

/// By the nearest taxel in another place.
void find_radii(std::vector<FreePlace>& places) {
  std::vector<double> radii;
  for (FreePlace& place : places) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const FreePlace& other : places) {
      const double distance = std::hypot(other.x - place.x, other.y - place.y);
      if (distance > 0.0) nearest = std::min(nearest, distance);
    }
    place.radius = kFill * nearest;
    radii.push_back(place.radius);
  }
  std::sort(radii.begin(), radii.end());
  const double most = kMostUsual * radii[radii.size() / 2];
  for (FreePlace& place : places) place.radius = std::min(place.radius, most);
}

}  // namespace

std::vector<FreePlace> free_places(FrameShape array, const ArrayShape& shape) {
  const auto* const free = std::get_if<FreeShape>(&shape);
  const bool is_row = array.rows == 1 || array.cols == 1;
  if (free == nullptr || !is_row || free->positions.size() < kFewest) return {};
  if (are_evenly_on_a_line(free->positions)) return {};
  const std::array<Axis, 3> axes = {&Vector3::x, &Vector3::y, &Vector3::z};
  std::array<double, 3> extents{};
  std::transform(axes.begin(), axes.end(), extents.begin(),
                 [&](Axis axis) { return extent_of(free->positions, axis); });
  // The last of equal ones: pictures are flat.
  const auto shortest = 2 - (std::min_element(extents.rbegin(), extents.rend()) - extents.rbegin());
  const Axis right = axes[shortest == 0 ? 1 : 0];
  const Axis down = axes[shortest == 2 ? 1 : 2];
  std::vector<FreePlace> places;
  places.reserve(free->positions.size());
  for (const Vector3& position : free->positions) places.push_back({position.*right, position.*down, 0.0});
  find_radii(places);
  return places;
}

}  // namespace dermis
