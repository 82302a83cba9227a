// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dermis/touch/frames/axis.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::learn::health {

/// Gains that all taxels of a row, or of a column, have in common, from touches of unknown force. Four lines in a row
/// carry
///
///   t = ln F(3) - 3 ln F(2) + 3 ln F(1) - ln F(0)
///
/// along each line that crosses them. It is 0 for a bell of any place and width. Other shapes give t the sign of the
/// side of the four on which the touch lies. Gains that lines have changed by since the calibration add the same t
/// under every touch. As in AgeingMonitor the product of two means counts, one of the touches on each side. It is 20
/// times the variance of ln g. One of them is of the near half of the lines, the other of the far one. An object that
/// always comes to one place differs there.
class LineGains {
 public:
  LineGains(const touch::pipeline::Model& model, Axis axis);

  /// The next frame of the array.
  void add(const ForceFrame& force);

  /// "recalibrate: gains have changed by about 9 % from row to row (112 touches)"; empty: no sign of it. At least
  /// `least_spread` is asked for.
  [[nodiscard]] std::optional<std::string> finding(double least_spread) const;

 private:
  /// Four neighbouring lines.
  struct Window {
    std::array<double, 4> mean{};    // of t, by the quarter in which touches lie: 2 * side + half of the lines
    std::array<double, 4> weight{};  // of the touches in them
    std::uint8_t quarter = 0;        // of the present touch
    bool is_over = false;            // it lies in another one now
    std::size_t frames = 0;          // of it; 0: there is none
    double sum = 0.0;                // of t in them, by their weights
    double sum_weight = 0.0;
  };

  void compare(Window& window, std::size_t first, const ForceFrame& force);
  void end_touch(Window& window);

  const ArrayDescription& array_;
  Axis axis_;
  std::vector<Window> windows_;
  std::size_t touches_ = 0;
};

}  // namespace dermis::learn::health
