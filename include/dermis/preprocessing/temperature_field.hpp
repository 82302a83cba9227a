// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <vector>

#include "dermis/core/array_description.hpp"

namespace dermis::preprocessing {

/// The temperature of each taxel from a few sensors, by kriging (Krige 1951; Rasmussen and Williams 2006, 2.7). The
/// mean is not known. Gradients along rows and columns have the standard deviation array.temperature_gradient_celsius.
/// Warm spots have a tenth of that, and are a quarter of the sheet wide. A sensor has 0.2 C of noise. Where every taxel
/// has a sensor, each has its own reading. Not thread-safe.
class TemperatureField {
 public:
  /// The array must be valid. One without sensors is taken to have one in its middle.
  explicit TemperatureField(const ArrayDescription& array);

  /// `sensors` [sensors] -> `taxels` [taxels] [C]. A sensor that is NaN or infinite has the mean of the others. false:
  /// there is no other, or not the right number of sensors; `taxels` is empty then. Allocates nothing after the first.
  bool interpolate(std::span<const float> sensors, std::vector<float>& taxels) noexcept;

  /// Standard deviation by which the gradient makes taxels differ from what is interpolated [C]: root mean square over
  /// the taxels. 0 where the array says nothing of a gradient, and where every taxel has a sensor.
  [[nodiscard]] double sigma_celsius() const noexcept { return sigma_celsius_; }

 private:
  std::size_t taxels_;
  std::vector<float> weights_;   // [taxels, sensors]; empty: each taxel has its own sensor
  std::vector<float> readings_;  // [sensors]
  double sigma_celsius_ = 0.0;
};

}  // namespace dermis::preprocessing
