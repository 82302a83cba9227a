// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <string>

#include "dermis/bytes/files/config_table.hpp"
#include "dermis/touch/frames/cover.hpp"
#include "dermis/touch/frames/film.hpp"

namespace dermis::bytes::files {

/// The keys of a cover: a spread, shares as [[rows away, columns away, share], ...], or "fit".
void read_cover(ConfigFile& file, std::optional<Cover>& cover);

/// Their lines; empty without a cover.
[[nodiscard]] std::string cover_toml(const std::optional<Cover>& cover);

/// The keys of a film over the lines: one resistance, [unloaded, loaded], or "fit".
void read_film(ConfigFile& file, std::optional<Film>& film);

/// Their lines; empty without a film.
[[nodiscard]] std::string film_toml(const std::optional<Film>& film);

}  // namespace dermis::bytes::files
