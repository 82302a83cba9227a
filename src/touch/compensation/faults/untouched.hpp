// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::touch::compensation {

inline constexpr std::size_t kContactReach = 3;  // taxels beside a pressed one that may be touched too

/// The loss of an untouched taxel to the current of its lines is known.
[[nodiscard]] inline bool knows_what_currents_take(const Readout& readout) noexcept {
  return readout.circuit == Circuit::transimpedance || readout.circuit == Circuit::flexitac ||
         (readout.circuit == Circuit::divider && readout.idle_rows == IdleRows::grounded);
}

}  // namespace dermis::touch::compensation
