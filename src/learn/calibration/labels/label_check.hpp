// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"

namespace dermis::learn::calibration {

/// Labels that people wrote, held against the readings: the sum of all taxels rises with the load, whatever the
/// circuit.
struct LabelCheck {
  std::vector<std::size_t> pressed_frames;  ///< Called unloaded, but pressed; rising.
  std::vector<std::string> remarks;         ///< Errors in the labels, a sentence each.
  std::optional<std::string> turn;          ///< The error that makes all of them useless: find_turn().

  [[nodiscard]] bool is_pressed(std::size_t frame) const {
    return std::binary_search(pressed_frames.begin(), pressed_frames.end(), frame);
  }
};

/// `loads` as check_loads() wants them.
[[nodiscard]] LabelCheck check_labels(const ArrayDescription& array, std::span<const RawFrame> frames,
                                      std::span<const Load> loads, Nanos settle_time);

}  // namespace dermis::learn::calibration
