// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/files/sheet_toml.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <utility>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/millimetres.hpp"

namespace dermis::bytes::files {

void read_cover(ConfigFile& file, std::optional<Cover>& found) {
  Cover cover;
  if (file.contains("array.cover") && !file.is_text("array.cover", "fit")) {
    file.fail("array.cover", "must be \"fit\"; a cover that is known has cover_spread_mm");
  }
  std::optional<double> spread_mm;
  file.number("array.cover_spread_mm", spread_mm);
  if (spread_mm) cover.spread_m = *spread_mm / kMillimetresPerMetre;
  std::vector<std::vector<double>> shares;
  file.number_rows("array.cover_shares", 3, shares);
  for (const std::vector<double>& share : shares) {
    const auto is_count = [](double value) { return value >= 0.0 && value < kMaxLines && value == std::floor(value); };
    if (!is_count(share[0]) || !is_count(share[1])) {
      return file.fail("array.cover_shares", "must be [rows away, columns away, share]");
    }
    cover.shares.push_back({static_cast<std::size_t>(share[0]), static_cast<std::size_t>(share[1]), share[2]});
  }
  if (file.contains("array.cover") || spread_mm || !cover.shares.empty()) found = std::move(cover);
}

std::string cover_toml(const std::optional<Cover>& known) {
  if (!known) return {};
  const Cover& cover = *known;
  if (cover.is_unknown()) return "cover = \"fit\"\n";
  if (cover.shares.empty()) return fmt::format("cover_spread_mm = {:.15g}\n", cover.spread_m * kMillimetresPerMetre);
  std::vector<std::string> shares;
  for (const auto& [rows, cols, share] : cover.shares) shares.push_back(fmt::format("[{}, {}, {}]", rows, cols, share));
  return fmt::format("cover_shares = [{}]\n", fmt::join(shares, ", "));
}

void read_film(ConfigFile& file, std::optional<Film>& found) {
  std::vector<double> ohms;
  if (file.is_text("readout.film", "fit")) {
    ohms.assign(2, kFitOhm);
  } else if (file.contains("readout.film")) {
    file.fail("readout.film", "must be \"fit\"; a film that is known has film_ohm");
  }
  file.number_per_line("readout.film_ohm", 2, {"fit", kFitOhm}, ohms);
  Film film;
  file.number("readout.film_force_n", film.loaded_newtons);
  if (ohms.size() != 2) return;
  film.unloaded_ohm = ohms[0];
  film.loaded_ohm = ohms[1];
  found = film;
}

std::string film_toml(const std::optional<Film>& film) {
  if (!film) return {};
  if (film->is_unknown()) return "film = \"fit\"\n";
  return fmt::format("film_ohm = [{}, {}]\nfilm_force_n = {}\n", film->unloaded_ohm, film->loaded_ohm,
                     film->loaded_newtons);
}

}  // namespace dermis::bytes::files
