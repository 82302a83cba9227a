// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <string>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/pipeline/standing_load.hpp"

namespace dermis::touch::pipeline {

/// The readings that a tare may take as zero.
enum class TareOver : std::uint8_t {
  drift,     ///< Drift, 0.5 times the unloaded conductance; or loads below 0.1 N.
  any_load,  ///< Whatever stands there: an array that is worn.
};

/// The last tare of a pipeline.
struct Tare {
  enum class State : std::uint8_t {
    none,
    taking,   ///< The second is not over.
    taken,    ///< Zero is what the array showed; `load`: what read as a force before, 0 N where that is below 0.1 N.
    refused,  ///< Zero is as it was; `load`: stands on the array.
  };

  State state = State::none;
  std::uint64_t number = 0;  ///< Of the tares that were begun.
  StandingLoad load;

  [[nodiscard]] bool has_ended() const noexcept { return state == State::taken || state == State::refused; }
};

/// For a refused tare: "r3c4 to r5c6 read 48 N: take it off and tare again". For one that has taken a load: "the tare
/// takes 1.2 N on r3c4 as zero"; else "".
[[nodiscard]] std::string describe(const Tare& tare, const ArrayDescription& array);

}  // namespace dermis::touch::pipeline
