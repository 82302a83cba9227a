// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/axis.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::learn::health {

/// Lines and taxels that stand at an end of the ADC, exactly or nearly, in all frames or from one on to the last.
/// Others of the array have to show that nothing else brings readings there.
class StandingLines {
 public:
  /// `array` must outlive it.
  explicit StandingLines(const ArrayDescription& array);

  /// The readings of the next frame, all of them numbers.
  void add(std::span<const float> counts, Nanos time);

  /// A sentence for each line. `full_scale`: the highest count of the ADC; empty where none is reached.
  [[nodiscard]] std::vector<std::string> lines(std::optional<float> full_scale) const;

  /// A sentence for each taxel at full scale that is on none of those lines, and came there from one frame to the next.
  /// A press may look so.
  [[nodiscard]] std::vector<std::string> taxels_at(std::optional<float> full_scale) const;

 private:
  /// The readings of a taxel since they changed clearly the last time, and before.
  struct Taxel {
    float low = 0.0F;
    float high = 0.0F;
    std::size_t begin = 0;  ///< First frame of these.
    Nanos begin_time{};
    float least_before = 0.0F;  ///< Of all frames before them,
    float most_before = 0.0F;
    float last_before = 0.0F;
    std::size_t read_before = 0;  ///< of which so many were not 0.
    std::size_t at_top = 0;       ///< Frames near the highest reading of all taxels so far.
  };
  /// An end of the ADC.
  struct End {
    float least = 0.0F;  ///< Readings from here
    float most = 0.0F;   ///< to here are at the end.
  };
  struct Standing {
    std::size_t line = 0;
    std::size_t begin = 0;
    Nanos begin_time{};
    float low = 0.0F;
    float high = 0.0F;
  };

  [[nodiscard]] bool stands_at(const End& end, const Taxel& taxel) const;
  [[nodiscard]] std::optional<Standing> standing(const End& end, Axis axis, std::size_t line) const;
  [[nodiscard]] bool works_beside(const End& end, Axis axis, std::size_t line) const;
  [[nodiscard]] bool others_move(const End& end, Axis axis, const std::vector<std::size_t>& others) const;
  [[nodiscard]] bool was_alive(const End& end, const Standing& standing, Axis axis) const;
  [[nodiscard]] std::vector<Standing> found(const End& end, Axis axis) const;
  [[nodiscard]] std::string describe(const Standing& standing, Axis axis) const;

  const ArrayDescription& array_;
  std::size_t frames_ = 0;
  std::optional<Nanos> first_time_;
  float highest_ = 0.0F;       // reading
  std::vector<Taxel> taxels_;  // [taxels]
};

}  // namespace dermis::learn::health
