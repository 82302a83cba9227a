// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dermis/bytes/files/numbers.hpp"
#include "dermis/learn/arrangement/arrangement.hpp"
#include "dermis/touch/frames/millimetres.hpp"
#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::arrangement {
namespace {

constexpr double kLeastPitchMetres = 0.00005;
constexpr double kMostPitchMetres = 1.0;

/// "6x9"; empty where it is no such text.
std::optional<FrameShape> grid_of(std::string_view text) {
  FrameShape grid;
  const std::size_t by = text.find('x');
  if (by == std::string_view::npos) return std::nullopt;
  const bool is_grid = bytes::files::parse_number(text.substr(0, by), grid.rows) &&
                       bytes::files::parse_number(text.substr(by + 1), grid.cols);
  return is_grid ? std::optional(grid) : std::nullopt;
}

Result<Places> grid_places(FrameShape grid, double pitch_m) {
  if (!(pitch_m >= kLeastPitchMetres && pitch_m <= kMostPitchMetres))
    return bad_input("pitch: must be 0.05 to 1000 mm");
  const bool is_possible = grid.rows >= 1 && grid.cols >= 1 && grid.rows <= kMaxLines && grid.cols <= kMaxLines &&
                           grid.taxel_count() <= kMostPlaces;
  if (!is_possible) return bad_input(fmt::format("a grid has 1 to {} places, as 6x9", kMostPlaces));
  Places places{.grid = grid, .pitch_m = pitch_m};
  for (std::size_t row = 0; row < grid.rows; ++row)
    for (std::size_t col = 0; col < grid.cols; ++col)
      places.places.push_back({{static_cast<double>(col) * pitch_m, static_cast<double>(row) * pitch_m, 0.0}, {}});
  return places;
}

double distance(const Vector3& a, const Vector3& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

/// The median distance to the nearest neighbour.
double usual_distance(const std::vector<bytes::files::NamedPlace>& places) {
  std::vector<double> nearest;
  for (std::size_t a = 0; a < places.size(); ++a) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t b = 0; b < places.size(); ++b)
      if (a != b) least = std::min(least, distance(places[a].position, places[b].position));
    if (std::isfinite(least)) nearest.push_back(least);
  }
  const double usual = nearest.empty() ? ArrayDescription{}.col_pitch_m : upper_median(nearest);
  return std::clamp(usual, kLeastPitchMetres, kMostPitchMetres);
}

}  // namespace

Result<Places> places_of(std::vector<bytes::files::NamedPlace> places) {
  if (places.empty() || places.size() > kMostPlaces)
    return bad_input(fmt::format("there must be 1 to {} places, not {}", kMostPlaces, places.size()));
  Places made{.places = std::move(places)};
  made.pitch_m = usual_distance(made.places);
  return made;
}

Result<Places> read_press_places(const std::string& text, double pitch_mm) {
  if (const std::optional<FrameShape> grid = grid_of(text)) return grid_places(*grid, pitch_mm / kMillimetresPerMetre);
  Result<std::vector<bytes::files::NamedPlace>> places = bytes::files::read_places(text);
  if (!places) return places.error();
  Result<Places> made = places_of(*std::move(places));
  return made ? std::move(made) : bad_input(text + ": " + made.error().message);
}

std::string place_words(const Places& places, std::size_t place) {
  const auto& [position, name] = places.places[place];
  std::string words = fmt::format("place {} of {} (", place + 1, places.places.size());
  if (places.grid) {
    words += fmt::format("row {}, column {} from the top left", place / places.grid->cols + 1,
                         place % places.grid->cols + 1);
  } else {
    words +=
        fmt::format("x {:.6g} mm, y {:.6g} mm", position.x * kMillimetresPerMetre, position.y * kMillimetresPerMetre);
    if (position.z != 0.0) words += fmt::format(", z {:.6g} mm", position.z * kMillimetresPerMetre);
  }
  return words + (name.empty() ? ")" : "; " + name + ")");
}

std::string channel_words(std::size_t channel, FrameShape sent) {
  const std::string words = fmt::format("channel {}", channel);
  return sent.rows > 1 ? words + " (" + taxel_name(channel / sent.cols, channel % sent.cols) + ")" : words;
}

}  // namespace dermis::learn::arrangement
