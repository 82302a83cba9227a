// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/contacts.hpp"
#include "touch/contacts/patch_response.hpp"

namespace dermis::touch::contacts {

/// Where the taxels of an array are, how large they are, and what a patch does to them. Under a cover each collects the
/// force of its whole cell.
struct TaxelPlane {
  explicit TaxelPlane(const ArrayDescription& array);

  /// [m]
  [[nodiscard]] PlaneVector centre(std::size_t taxel) const noexcept {
    const std::size_t row = taxel / cols;
    return {static_cast<double>(taxel - row * cols) * col_pitch_m, static_cast<double>(row) * row_pitch_m};
  }

  /// One of the eight around the other, or the same.
  [[nodiscard]] bool are_neighbours(std::size_t a, std::size_t b) const noexcept;

  std::size_t rows;
  std::size_t cols;
  double row_pitch_m;
  double col_pitch_m;
  double taxel_area_m2;
  double taxel_radius_m;  ///< Radius of a disc of the same area; on a strip no larger than fits in the pitch along it.
  double cover_spread;    ///< In radii of a taxel; 0: no cover.
  std::vector<PlaneVector> places;  ///< Centres in radii of a taxel [taxels].
  std::shared_ptr<const PatchResponses> responses;
};

}  // namespace dermis::touch::contacts
