// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <span>
#include <string>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"

namespace dermis::learn::calibration {

/// A film over the lines, as presses of single taxels tell it.
struct FilmFit {
  std::optional<Film> film;
  std::optional<Cover> cover;  ///< Below which the film lies, if the array does not name one.
  std::string sentence;        ///< On the film, or what to press where presses are too few to tell; may be empty.
};

/// A film raises the taxels beside a press in its row or its column, as the circuit has it. It hardly raises those
/// across the corners, and not a whole line. With the film that is found, taxels beside presses conduct as if nothing
/// pressed, or as a cover has it that raises both lines alike. `array`: its circuit is known, but perhaps for the film.
[[nodiscard]] FilmFit fit_film(const ArrayDescription& array, std::span<const RawFrame> frames,
                               std::span<const Load> loads, Nanos settle_time);

}  // namespace dermis::learn::calibration
