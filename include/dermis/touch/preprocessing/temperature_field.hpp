// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::touch::preprocessing {

/// The temperature of each taxel from a few sensors, by kriging (Krige 1951; Rasmussen and Williams 2006, 2.7). The
/// mean is not known. Gradients from end to end, along rows and along columns, have the standard deviation
/// array.temperature_gradient_celsius. Warm spots have a tenth of that, and are a quarter of the sheet wide. A sensor
/// has 0.2 C of noise. Where every taxel has a sensor, each has its own reading. Not thread-safe.
class TemperatureField {
 public:
  /// The array must be valid. One without sensors is taken to have one in its middle.
  explicit TemperatureField(const ArrayDescription& array);

  /// `sensors` [sensors] -> `taxels` [taxels] [C]. A sensor counts as absent where it is NaN, or no temperature that a
  /// sheet can have. On a map its taxel has the mean of its neighbours. false: no sensor reads, or not the right number
  /// is there; `taxels` is empty then. Allocates nothing where `taxels` has room.
  bool interpolate(std::span<const float> sensors, std::vector<float>& taxels) noexcept;

  /// Standard deviation by which the gradient makes taxels differ from what is interpolated [C]: root mean square over
  /// the taxels. 0 where the array says nothing of a gradient, and where every taxel has a sensor.
  [[nodiscard]] double sigma_celsius() const noexcept { return sigma_celsius_; }

 private:
  void weigh(const ArrayDescription& array, const std::vector<TemperatureSensor>& sensors);
  void fill_in(std::span<const float> sensors) noexcept;
  void fill_in_map(std::span<const float> sensors) noexcept;

  FrameShape shape_;
  std::vector<float> weights_;    // [taxels, sensors]; empty: each taxel has its own sensor
  std::vector<float> precision_;  // of the readings about their unknown mean [sensors, sensors] [1/C^2]
  std::vector<float> readings_;   // [sensors]
  double sigma_celsius_ = 0.0;
};

}  // namespace dermis::touch::preprocessing
